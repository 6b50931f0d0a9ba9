#include "scenes/scene_values.h"

#include <charconv>
#include <span>
#include <type_traits>

#include <fmt/format.h>

#include "scenes/control/load.h"
#include "scenes/format.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

using Found = Result<ExpressionNumber>;
using Keys = std::span<const std::string_view>;

std::vector<std::string_view> keys_of(std::string_view pointer) {
  std::vector<std::string_view> keys;
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    keys.push_back(pointer.substr(0, end));
    pointer.remove_prefix(end);
  }
  return keys;
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return number;
}

/// One look-up. The member functions take the keys that are left.
class Lookup {
 public:
  explicit Lookup(std::string_view pointer) : pointer_(pointer) {}

  [[nodiscard]] Error fault(const std::string& what) const {
    return {"", fmt::format("\"{}\" is no number of the scene: {}", pointer_, what)};
  }

  /// The element of a list that has the name or the index. Null with a fault if there is none.
  template <class List, class Name>
  const typename List::value_type* element(const List& list, Keys keys, std::string_view kind,
                                           const Name& name_of) {
    if (keys.empty()) return none(fmt::format("the name of the {} is missing", kind)), nullptr;
    Suggestion suggestion(keys.front());
    for (const auto& one : list) {
      const std::string_view name = name_of(one);
      if (!name.empty() && name == keys.front()) return &one;
      suggestion.consider(name);
    }
    const std::optional<std::size_t> index = whole_number(keys.front());
    if (index && *index < list.size()) return &list[*index];
    none(fmt::format("there is no {} \"{}\"{}", kind, keys.front(), suggestion.question()));
    return nullptr;
  }

  /// The number of a field in one of the tables. `objects` are those of the tables.
  Found setting(std::span<const std::span<const Field>> tables,
                std::span<const void* const> objects, Keys keys, std::string_view kind) {
    if (keys.empty()) return fault(fmt::format("the setting of the {} is missing", kind));
    Suggestion suggestion(keys.front());
    for (std::size_t i = 0; i < tables.size(); ++i) {
      for (const Field& field : tables[i]) {
        suggestion.consider(field.name);
        if (field.name != keys.front()) continue;
        return std::visit([&](const auto& slot) { return read(field, slot, keys.subspan(1)); },
                          slot_of(field, objects[i]));
      }
    }
    return fault(
        fmt::format("a {} has no setting \"{}\"{}", kind, keys.front(), suggestion.question()));
  }

  /// Number `keys` of a vector.
  template <class Vector>
  Found component(const Field& field, const Vector& vector, std::size_t size, Keys keys) {
    const std::optional<std::size_t> index =
        keys.size() == 1 ? whole_number(keys.front()) : std::nullopt;
    if (!index || *index >= size) {
      return fault(fmt::format("{} has {} numbers, from {}/0 on", field.name, size, field.name));
    }
    return ExpressionNumber{vector[static_cast<typename Index<Vector>::type>(*index)],
                            Unit(field.unit)};
  }

  Error error{"", ""};

 private:
  template <class Vector>
  struct Index {
    using type = Eigen::Index;
  };
  template <class Value>
  struct Index<std::vector<Value>> {
    using type = std::size_t;
  };

  void none(const std::string& what) { error = fault(what); }

  /// Slots give write access; this class only reads.
  template <class Slot>
  Found read(const Field& field, const Slot& slot, Keys keys) {
    if constexpr (std::is_pointer_v<Slot>) {
      const auto* const value = slot;
      return of(field, value, keys);
    } else {
      return of(field, slot, keys);
    }
  }
  [[nodiscard]] Found scalar(const Field& field, double value, Keys keys) const {
    if (!keys.empty()) return fault(fmt::format("{} is one number", field.name));
    return ExpressionNumber{value, Unit(field.unit)};
  }
  Found of(const Field& field, const double* slot, Keys keys) { return scalar(field, *slot, keys); }
  Found of(const Field& field, const int* slot, Keys keys) { return scalar(field, *slot, keys); }
  Found of(const Field& field, const Vector3* slot, Keys keys) {
    return component(field, *slot, 3, keys);
  }
  Found of(const Field& field, const Quaternion* slot, Keys keys) {
    return component(field, Eigen::Vector4d(slot->w(), slot->x(), slot->y(), slot->z()), 4, keys);
  }
  Found of(const Field& field, const std::vector<double>* slot, Keys keys) {
    return component(field, *slot, slot->size(), keys);
  }
  Found of(const Field& field, const std::vector<Vector3>* slot, Keys keys) {
    const std::optional<std::size_t> index =
        keys.size() == 2 ? whole_number(keys.front()) : std::nullopt;
    if (!index || *index >= slot->size()) {
      return fault(
          fmt::format("{} has {} vectors, from {}/0/0 on", field.name, slot->size(), field.name));
    }
    return component(field, (*slot)[*index], 3, keys.subspan(1));
  }
  template <class Value>
  Found of(const Field& field, const std::optional<Value>* slot, Keys keys) {
    if (!slot->has_value()) return fault(fmt::format("{} is not set", field.name));
    return of(field, &**slot, keys);
  }
  template <class Other>
  Found of(const Field& field, const Other& /*slot*/, Keys /*keys*/) {
    return fault(fmt::format("{} is no number", field.name));
  }

  std::string_view pointer_;
};

std::span<const Field> variant_fields(const ObjectFormat& format, std::string_view type) {
  const Variant* const variant = format.variant(type);
  return variant == nullptr ? std::span<const Field>() : variant->table.fields;
}

/// A setting of a part of one of several types.
Found of_typed(Lookup& lookup, const ObjectFormat& format, std::string_view type,
               const void* common, const void* settings, Keys keys) {
  const std::array<std::span<const Field>, 2> tables{format.tables[0].fields,
                                                     variant_fields(format, type)};
  return lookup.setting(tables, std::array{common, settings}, keys, format.name);
}

Found of_plain(Lookup& lookup, const ObjectFormat& format, const void* object, Keys keys) {
  const std::array tables{format.tables.back().fields};
  return lookup.setting(tables, std::array{object}, keys, format.name);
}

Found of_body(Lookup& lookup, const BodyDef& body, Keys keys) {
  const bool one = !keys.empty() && keys.front() == "shape" && body.shapes.size() == 1;
  if (one || (!keys.empty() && keys.front() == "shapes")) {
    const std::array<std::string_view, 1> first{"0"};
    const PlacedShape* const placed =
        lookup.element(body.shapes, one ? Keys(first) : keys.subspan(1), "shape",
                       [](const PlacedShape&) { return std::string_view(); });
    if (placed == nullptr) return lookup.error;
    return of_typed(lookup, shape_format(), placed->shape->type(), placed,
                    placed->shape->settings(), keys.subspan(one ? 1 : 2));
  }
  const std::array<std::span<const Field>, 1> tables{body_format().tables[0].fields};
  return lookup.setting(tables, std::array<const void*, 1>{&body}, keys, "body");
}

Found of_cable(Lookup& lookup, const CableDef& cable, Keys keys) {
  if (!keys.empty() && keys.front() == "links") {
    const auto* const link =
        lookup.element(cable.links, keys.subspan(1), "link",
                       [](const auto& /*link*/) { return std::string_view(); });
    if (link == nullptr) return lookup.error;
    return of_typed(lookup, link_format(), (*link)->type(), link->get(), (*link)->settings(),
                    keys.subspan(2));
  }
  return of_plain(lookup, cable_format(), &cable, keys);
}

}  // namespace

Found SceneValues::find(std::string_view pointer) const {
  Lookup lookup(pointer);
  const std::vector<std::string_view> all = keys_of(pointer);
  const Keys keys(all);
  const std::string_view list = keys.empty() ? std::string_view() : keys.front();
  const Keys rest = keys.subspan(keys.empty() ? 0 : 1);
  const auto inner = [&] { return rest.subspan(1); };
  if (list == "bodies") {
    const BodyDef* const body =
        lookup.element(model_.bodies, rest, "body",
                       [](const BodyDef& one) -> std::string_view { return one.name; });
    return body == nullptr ? Found(lookup.error) : of_body(lookup, *body, inner());
  }
  if (list == "joints") {
    const auto* const joint =
        lookup.element(model_.joints, rest, "joint",
                       [](const auto& one) -> std::string_view { return one->name; });
    if (joint == nullptr) return lookup.error;
    return of_typed(lookup, joint_format(), (*joint)->type(), joint->get(), (*joint)->settings(),
                    inner());
  }
  if (list == "cables") {
    const CableDef* const cable = lookup.element(
        cables_, rest, "cable", [](const CableDef& one) -> std::string_view { return one.name; });
    return cable == nullptr ? Found(lookup.error) : of_cable(lookup, *cable, inner());
  }
  if (list == "loads") {
    const auto* const load = lookup.element(
        loads_, rest, "load", [](const auto& one) -> std::string_view { return one->name; });
    if (load == nullptr) return lookup.error;
    return of_typed(lookup, load_format(), (*load)->type(), load->get(), (*load)->settings(),
                    inner());
  }
  if (list == "colliders") {
    const ColliderDef* const collider = lookup.element(
        model_.colliders, rest, "collider", [](const ColliderDef&) { return std::string_view(); });
    if (collider == nullptr) return lookup.error;
    return of_plain(lookup, collider_format(), collider, inner());
  }
  if (list == "ground" && model_.ground) {
    return of_plain(lookup, ground_format(), &*model_.ground, rest);
  }
  if (list == "step") return of_plain(lookup, step_format(), &model_.step, rest);
  if (list == "gravity") {
    for (const Field& field : scene_format().tables[0].fields) {
      if (field.name == list) return lookup.component(field, model_.gravity, 3, rest);
    }
  }
  return lookup.fault(
      "it begins with /bodies/NAME, /joints/NAME, /cables/NAME, /loads/NAME, "
      "/colliders/N, /ground, /step or /gravity");
}

}  // namespace sheave
