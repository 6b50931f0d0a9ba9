#pragma once
// Reads the objects of a scene file into C++ objects by their field tables, and reports everything
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

  /// Checks the keys of the object `node` and reads its fields: `objects` are of the types of the
  /// format's tables, `settings` of the type of `variant` (both null if there is none). Members are
  /// left to the caller. False if the node is no object.
  bool read_object(json::NodeId node, const ObjectFormat& format, std::span<void* const> objects,
                   const Variant* variant = nullptr, void* settings = nullptr);
  /// The variant that the key "type" of an object chooses; null, reported, if it chooses none.
  const Variant* read_type(json::NodeId node, const ObjectFormat& format);
  /// The elements of a list member of an object; none if it is missing, which is reported if it is
  /// required, no list or too long.
  std::span<const json::NodeId> list(json::NodeId object, const Member& member);

  /// The value of an object member of an object; no_node if it is missing, which is reported if it
  /// is required.
  json::NodeId member(json::NodeId object, const Member& member);

  /// Tells a body that references may name from now on, and what its BodyId is. `name` must outlive
  /// the reader.
  void declare_body(std::string_view name, int number);
  /// References may not name it any more.
  void forget_body(std::string_view name);
  /// Reports names that occur twice among `entities`, objects called `what`; returns the index of
  /// each name's first occurrence. Values that are no strings are reported by read_object.
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
