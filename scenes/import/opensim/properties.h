#pragma once
// The properties of an OpenSim object are its child elements, whose text is the value. An object of
// the same type in <defaults> has the values of properties that an object does not have.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "engine/vector.h"
#include "scenes/import/log.h"

namespace sheave::import::opensim {

/// Reads properties and remembers which were read. A value that is not allowed is an error, and
/// then the answer is that of a property that is not given.
class Properties {
 public:
  explicit Properties(Log& log) : log_(log) {}

  /// Takes the objects of <defaults>.
  void set_defaults(const xml::Element& defaults);

  /// The first child with this tag, else that of the default object; null: none.
  [[nodiscard]] const xml::Element* child(const xml::Element& of, std::string_view tag);
  /// The first of these tags that is a child.
  [[nodiscard]] const xml::Element* child(const xml::Element& of,
                                          std::initializer_list<std::string_view> tags);
  /// The text of a property; empty: none.
  [[nodiscard]] std::string text(const xml::Element& of, std::string_view tag);
  [[nodiscard]] std::optional<double> number(const xml::Element& of, std::string_view tag);
  /// A number above 0.
  [[nodiscard]] std::optional<double> positive(const xml::Element& of, std::string_view tag);
  /// `least` to `most` finite numbers; empty: none.
  [[nodiscard]] std::vector<double> numbers(const xml::Element& of, std::string_view tag,
                                            std::size_t least, std::size_t most);
  [[nodiscard]] std::optional<Vector3> vector(const xml::Element& of, std::string_view tag);
  [[nodiscard]] bool flag(const xml::Element& of, std::string_view tag, bool otherwise);
  /// The objects of a set, which stand in <tag><objects> or in <tag>.
  [[nodiscard]] std::vector<const xml::Element*> objects(const xml::Element& of,
                                                         std::string_view tag);

  /// Marks an element as read.
  void mark(const xml::Element& element) { read_.insert(&element); }
  /// Notes in the log all elements below the root that were not read.
  void note_unread(const xml::Element& root);

 private:
  void error(const xml::Element& property, const std::string& rule, FaultCode code);
  void note_property(const xml::Element& property, std::string& unread);

  Log& log_;
  std::map<std::string, const xml::Element*, std::less<>> defaults_;
  std::unordered_set<const xml::Element*> read_;
};

}  // namespace sheave::import::opensim
