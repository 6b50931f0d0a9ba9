#pragma once
// Reads the objects of a scene file into C++ objects by their field tables, and reports every value
// that does not fit.

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "scenes/format.h"
#include "scenes/json/document.h"
#include "scenes/value_reader.h"

namespace sheave {

class FieldReader {
 public:
  /// Both must outlive the reader.
  FieldReader(const json::Document& document, json::Faults& faults)
      : document_(document), faults_(faults) {}

  /// Checks the keys of the object `node` and reads its fields. `objects` have the types of the
  /// format's tables, `settings` has the type of `variant` (both null if there is none). Members
  /// are left to the caller. False if the node is not an object.
  bool read_object(json::NodeId node, const ObjectFormat& format, std::span<void* const> objects,
                   const Variant* variant = nullptr, void* settings = nullptr);
  /// The variant that the object's key "type" chooses. Null, with a report, if it chooses none.
  const Variant* read_type(json::NodeId node, const ObjectFormat& format);
  /// The elements of a list member of an object. Empty if the member is missing (reported if it is
  /// required), not a list, or too long (reported).
  std::span<const json::NodeId> list(json::NodeId object, const Member& member);

  /// The value of an object member of an object. no_node if it is missing (reported if it is
  /// required).
  json::NodeId member(json::NodeId object, const Member& member);

  /// Allows references to a body from now on. `number` is its BodyId. `name` must outlive the
  /// reader.
  void declare_body(std::string_view name, int number);
  /// Forbids references to the body from now on.
  void forget_body(std::string_view name);
  /// Reports names that occur twice among `entities`; messages call the objects `what`. Returns the
  /// index of each name's first occurrence. read_object() reports values that are not strings.
  std::unordered_map<std::string_view, int> unique_names(std::span<const json::NodeId> entities,
                                                         std::string_view what);

  /// Reports a fault of a value.
  void fail(json::NodeId node, FaultCode code, std::string message, std::string allowed = {});

 private:
  void check_keys(json::NodeId node, const ObjectFormat& format, const Variant* variant);
  void read_table(json::NodeId node, std::span<const Field> fields, void* object, bool partial);
  void check_name(json::NodeId node);
  void report_missing(json::NodeId node, std::string_view key, std::string allowed);

  const json::Document& document_;
  json::Faults& faults_;
  BodyNames bodies_;
};

}  // namespace sheave
