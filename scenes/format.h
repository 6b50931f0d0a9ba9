#pragma once
// The tree of objects in a scene file. The loader, the writer, the JSON Schema and the reference
// documentation all walk this tree. Its content comes from the field tables and the registries of
// types, so a new field or type needs no line here.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/field.h"

namespace sheave {

/// A field table with a default-constructed object of its type.
struct TableFormat {
  std::span<const Field> fields;
  std::shared_ptr<const void> defaults;
};

struct ObjectFormat;

/// A key whose value is an object or a list of objects.
struct Member {
  std::string_view name;
  std::string_view meaning;
  bool list = false;
  const ObjectFormat* format = nullptr;
  bool required = false;
};

/// One of several types of an object, chosen by its key "type".
struct Variant {
  std::string_view name;
  std::string_view meaning;
  TableFormat table;
  std::vector<Member> members{};
};

/// The keys that an object of a scene file may have.
struct ObjectFormat {
  std::string_view name;  ///< "body", "shape", ...
  std::string_view meaning;
  bool named = false;  ///< its "name" is used in references, or in column names
  std::vector<TableFormat> tables;
  std::vector<Variant> variants;  ///< not empty: the key "type" is required and chooses one
  std::vector<Member> members;
  std::vector<std::pair<std::string_view, std::string_view>>
      exclusive;  ///< pairs of keys that exclude each other
  /// The object changes an existing one: missing keys leave their values, and null restores the
  /// default.
  bool partial = false;

  [[nodiscard]] const Variant* variant(std::string_view type) const;
  [[nodiscard]] const Member* member(std::string_view key) const;
};

/// The format of a whole scene; it contains all other formats.
[[nodiscard]] const ObjectFormat& scene_format();
[[nodiscard]] const ObjectFormat& step_format();
[[nodiscard]] const ObjectFormat& parameter_format();
[[nodiscard]] const ObjectFormat& body_format();
[[nodiscard]] const ObjectFormat& shape_format();
[[nodiscard]] const ObjectFormat& joint_format();
[[nodiscard]] const ObjectFormat& collider_format();
[[nodiscard]] const ObjectFormat& ground_format();
[[nodiscard]] const ObjectFormat& cable_format();
[[nodiscard]] const ObjectFormat& link_format();
[[nodiscard]] const ObjectFormat& controller_format();
[[nodiscard]] const ObjectFormat& load_format();
[[nodiscard]] const ObjectFormat& trigger_format();
[[nodiscard]] const ObjectFormat& camera_format();
[[nodiscard]] const ObjectFormat& camera_key_format();
[[nodiscard]] const ObjectFormat& annotation_format();
[[nodiscard]] const ObjectFormat& paint_format();
[[nodiscard]] const ObjectFormat& check_format();

/// Largest number of elements in a list of objects.
inline constexpr std::size_t max_list_length = 1'000'000;
/// Rule for names of bodies, joints and cables, as a regular expression and in words. A dot would
/// make column names ambiguous; a comma or quote would break CSV files.
inline constexpr std::string_view name_pattern =
    "^[A-Za-z0-9_-]([A-Za-z0-9_ -]{0,126}[A-Za-z0-9_-])?$";
inline constexpr std::string_view name_rule =
    "1 to 128 letters, digits, \"_\", \"-\" and inner spaces";
[[nodiscard]] bool is_name(std::string_view text);

/// Longer words for choices, which every field with this choice accepts: a side as people say it.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 2> longer_choices{
    {{"left of the way", "left"}, {"right of the way", "right"}}};

/// Largest deviation of a quaternion's length from 1.
inline constexpr double quaternion_tolerance = 1e-6;

/// The field's slot in `object`, which has the type of the table.
[[nodiscard]] FieldSlot slot_of(const Field& field, const void* object);
/// Whether two objects of a table's type have bit for bit the same value in a field.
[[nodiscard]] bool same_value(const Field& field, const void* a, const void* b);
/// Copies the value of a field from `from` to `to`; both have the type of the table.
void copy_value(const Field& field, const void* from, void* to);
/// Whether an optional slot has no value; false for slots that always have one. A quaternion of
/// zeros counts as no value.
[[nodiscard]] bool is_absent(const FieldSlot& slot);

/// The values that a field accepts, for messages and documentation: "a number > 0 [kg]".
[[nodiscard]] std::string describe(const Field& field, const FieldSlot& slot);
/// "> 0", "1 ... 1000", or an empty text without bounds.
[[nodiscard]] std::string range_text(const Range& range);

}  // namespace sheave
