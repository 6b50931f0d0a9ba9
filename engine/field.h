#pragma once
// Field tables: each type declares its settings once, and the scene loader, its error messages,
// the writer, the JSON Schema and the reference documentation are all made from that table.
//
//   std::span<const Field> DistanceJoint::field_table() {
//     static const std::array table{
//         field<&DistanceJoint::length>("length", "m", at_least(0), optional, "distance to keep"),
//     };
//     return table;
//   }

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/body_id.h"
#include "engine/vector.h"

namespace sheave {

/// Allowed values of a number, or of every component of a vector or list.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: values must exceed `minimum`
  bool maximum_allowed = true;  ///< false: values must stay below `maximum`
  /// Whether `value` is finite and inside.
  [[nodiscard]] bool contains(double value) const;
};
[[nodiscard]] constexpr Range any_number() { return {}; }
[[nodiscard]] constexpr Range at_least(double minimum) { return {.minimum = minimum}; }
[[nodiscard]] constexpr Range above(double minimum) {
  return {.minimum = minimum, .minimum_allowed = false};
}
[[nodiscard]] constexpr Range between(double minimum, double maximum) {
  return {.minimum = minimum, .maximum = maximum};
}

/// Whether a scene must give a field.
enum class Presence { required, optional };
inline constexpr Presence required = Presence::required;
inline constexpr Presence optional = Presence::optional;

/// Access to an enumeration through its index into Field::choices. If the enumeration is optional,
/// the index of no value is `absent`.
struct ChoiceSlot {
  static constexpr int absent = -1;
  void* object = nullptr;
  int (*get)(const void* object) = nullptr;
  void (*set)(void* object, int index) = nullptr;
  bool may_be_absent = false;  ///< the enumeration is optional
};

/// The location of a field in an object; the alternative tells its type.
using FieldSlot = std::variant<double*, int*, bool*, std::string*, Vector3*, Quaternion*, BodyId*,
                               std::optional<double>*, std::optional<Vector3>*,
                               std::optional<BodyId>*, std::vector<double>*, std::vector<Vector3>*,
                               std::vector<std::string>*, ChoiceSlot>;

/// One setting of one type. The default is its value in a default-constructed object.
struct Field {
  std::string_view name;  ///< key in a scene, and the name of the member
  std::string_view unit;  ///< "" for none
  Range range;            ///< ignored for text, booleans, references and choices
  Presence presence = Presence::optional;
  std::string_view meaning;                   ///< one line for the reference documentation
  std::span<const std::string_view> choices;  ///< names of an enumeration's values, in order
  FieldSlot (*slot)(void* object) = nullptr;  ///< `object` points to the type the table belongs to
};

namespace detail {
template <class Class, class Member>
Class class_of(Member Class::*);
template <class Class, class Member>
Member member_of(Member Class::*);

template <class Type>
inline constexpr bool is_optional = false;
template <class Value>
inline constexpr bool is_optional<std::optional<Value>> = true;
}  // namespace detail

/// A table row for the member `Member` (not an enumeration) of `Class`. A base of `Class` may
/// declare the member.
template <auto Member, class Class = decltype(detail::class_of(Member))>
[[nodiscard]] constexpr Field field(std::string_view name, std::string_view unit, Range range,
                                    Presence presence, std::string_view meaning) {
  return {name, unit, range, presence, meaning, {}, [](void* object) -> FieldSlot {
            return &(static_cast<Class*>(object)->*Member);
          }};
}

/// A table row for the enumeration member `Member` of `Class`, which may be a std::optional. Its
/// values are 0, 1, ... in the order of `choices`.
template <auto Member, class Class = decltype(detail::class_of(Member))>
[[nodiscard]] constexpr Field choice_field(std::string_view name,
                                           std::span<const std::string_view> choices,
                                           Presence presence, std::string_view meaning) {
  using Enumeration = decltype(detail::member_of(Member));
  return {name, "", {}, presence, meaning, choices, [](void* object) -> FieldSlot {
            if constexpr (detail::is_optional<Enumeration>) {
              return ChoiceSlot{object,
                                [](const void* o) {
                                  const Enumeration& own = static_cast<const Class*>(o)->*Member;
                                  return own ? static_cast<int>(*own) : ChoiceSlot::absent;
                                },
                                [](void* o, int index) {
                                  Enumeration& own = static_cast<Class*>(o)->*Member;
                                  own.reset();
                                  if (index == ChoiceSlot::absent) return;
                                  own = static_cast<typename Enumeration::value_type>(index);
                                },
                                true};
            } else {
              return ChoiceSlot{object,
                                [](const void* o) {
                                  return static_cast<int>(static_cast<const Class*>(o)->*Member);
                                },
                                [](void* o, int index) {
                                  static_cast<Class*>(o)->*Member = static_cast<Enumeration>(index);
                                }};
            }
          }};
}

/// The rows of `first`, then those of `second`.
template <std::size_t First, std::size_t Second>
[[nodiscard]] constexpr std::array<Field, First + Second> joined(
    const std::array<Field, First>& first, const std::array<Field, Second>& second) {
  std::array<Field, First + Second> table;
  std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), table.begin()));
  return table;
}

/// The registry's entry for one type that derives from `Base` (a shape, a joint, a cable link).
template <class Base>
struct TypeEntry {
  std::string_view name;     ///< value of "type" in a scene
  std::string_view meaning;  ///< one line for the reference documentation
  std::span<const Field> (*fields)() = nullptr;
  std::unique_ptr<Base> (*make)() = nullptr;  ///< a new object with default settings
};

/// The registry line of `Type`, which declares static type_name, type_meaning and field_table().
template <class Base, class Type>
[[nodiscard]] constexpr TypeEntry<Base> type_entry() {
  return {Type::type_name, Type::type_meaning, &Type::field_table,
          [] { return std::unique_ptr<Base>(std::make_unique<Type>()); }};
}

}  // namespace sheave
