#include "scenes/scene_values.h"

#include <array>
#include <charconv>
#include <span>
#include <type_traits>

#include <fmt/format.h>

#include "scenes/control/control_unit.h"
#include "scenes/control/load.h"
#include "scenes/drive_unit.h"
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
        Found found =
            std::visit([&](const auto& slot) { return read(field, slot, keys.subspan(1)); },
                       slot_of(field, objects[i]));
        if (found && drive_units(field.unit)) {
          found->unit = Unit(setting_unit(field, tables[i], objects[i]));
        }
        return found;
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

/// The number with the unit that follows from a control or a quantity.
Found with_unit(Found number, const std::optional<Result<Unit>>& unit) {
  if (!number || !unit) return number;
  if (!*unit) return unit->errors();
  number->unit = **unit;
  return number;
}

Found of_parameter(Lookup& lookup, const ParameterDef& parameter, Keys keys) {
  Found found = of_plain(lookup, parameter_format(), &parameter, keys);
  if (found) found->unit = Unit(parameter.unit);
  return found;
}

/// One setting of a scene. The functions take the keys behind the name of the list.
class Settings {
 public:
  Settings(const Scene& scene, const QuantityNames& names, std::string_view pointer)
      : scene_(scene), names_(names), lookup_(pointer) {}

  Found body(Keys keys) {
    const BodyDef* const body = one_of(scene_.model.bodies, keys, "body");
    return body == nullptr ? lookup_.error : of_body(lookup_, *body, keys.subspan(1));
  }
  Found joint(Keys keys) {
    const auto* const joint = pointed(scene_.model.joints, keys, "joint");
    if (joint == nullptr) return lookup_.error;
    return typed(joint_format(), **joint, keys);
  }
  Found cable(Keys keys) {
    const CableDef* const cable = one_of(scene_.cables, keys, "cable");
    return cable == nullptr ? lookup_.error : of_cable(lookup_, *cable, keys.subspan(1));
  }
  Found load(Keys keys) {
    const auto* const load = pointed(scene_.loads, keys, "load");
    if (load == nullptr) return lookup_.error;
    return typed(load_format(), **load, keys);
  }
  Found trigger(Keys keys) {
    const TriggerDef* const trigger = one_of(scene_.triggers, keys, "trigger");
    if (trigger == nullptr) return lookup_.error;
    Found found = of_plain(lookup_, trigger_format(), trigger, keys.subspan(1));
    return found ? with_unit(found, unit_of_setting(*trigger, keys[1], scene_, names_)) : found;
  }
  Found controller(Keys keys) {
    const auto* const controller = pointed(scene_.controllers, keys, "controller");
    if (controller == nullptr) return lookup_.error;
    Found found = typed(controller_format(), **controller, keys);
    return found ? with_unit(found, unit_of_setting(**controller, keys[1], scene_, names_)) : found;
  }
  Found parameter(Keys keys) {
    const ParameterDef* const own = one_of(scene_.model.parameters, keys, "parameter");
    return own == nullptr ? lookup_.error : of_parameter(lookup_, *own, keys.subspan(1));
  }
  Found collider(Keys keys) {
    const ColliderDef* const collider =
        lookup_.element(scene_.model.colliders, keys, "collider",
                        [](const ColliderDef&) { return std::string_view(); });
    if (collider == nullptr) return lookup_.error;
    return of_plain(lookup_, collider_format(), collider, keys.subspan(1));
  }
  Found other(std::string_view key, Keys keys) {
    const Model& model = scene_.model;
    if (key == "ground" && model.ground) {
      return of_plain(lookup_, ground_format(), &*model.ground, keys);
    }
    if (key == "step") return of_plain(lookup_, step_format(), &model.step, keys);
    for (const Field& field : scene_format().tables[0].fields) {
      if (field.name != key) continue;
      if (key == "gravity") return lookup_.component(field, model.gravity, 3, keys);
    }
    return lookup_.fault(
        "it begins with /bodies/NAME, /joints/NAME, /cables/NAME, /loads/NAME, /triggers/NAME, "
        "/controllers/NAME, /parameters/NAME, /colliders/N, /ground, /step or /gravity");
  }

 private:
  template <class List>
  const typename List::value_type* one_of(const List& list, Keys keys, std::string_view kind) {
    return lookup_.element(list, keys, kind,
                           [](const auto& one) -> std::string_view { return one.name; });
  }
  template <class List>
  const typename List::value_type* pointed(const List& list, Keys keys, std::string_view kind) {
    return lookup_.element(list, keys, kind,
                           [](const auto& one) -> std::string_view { return one->name; });
  }
  template <class Part>
  Found typed(const ObjectFormat& format, const Part& part, Keys keys) {
    return of_typed(lookup_, format, part.type(), &part, part.settings(), keys.subspan(1));
  }

  const Scene& scene_;
  const QuantityNames& names_;
  Lookup lookup_;
};

struct SettingsList {
  std::string_view name;
  Found (Settings::*find)(Keys keys);
};
constexpr std::array<SettingsList, 8> settings_lists{{{"bodies", &Settings::body},
                                                      {"joints", &Settings::joint},
                                                      {"cables", &Settings::cable},
                                                      {"loads", &Settings::load},
                                                      {"triggers", &Settings::trigger},
                                                      {"controllers", &Settings::controller},
                                                      {"parameters", &Settings::parameter},
                                                      {"colliders", &Settings::collider}}};

}  // namespace

Found SceneValues::find(std::string_view pointer, const QuantityNames& names) const {
  if (!pointer.starts_with('/')) {
    for (const ParameterDef& own : scene_.model.parameters) {
      if (own.name == pointer) return ExpressionNumber{own.value, Unit(own.unit)};
    }
    return Error{"", fmt::format("there is no parameter \"{}\"", pointer)};
  }
  const std::vector<std::string_view> all = keys_of(pointer);
  const std::string_view list = all.empty() ? std::string_view() : all.front();
  const Keys rest = Keys(all).subspan(all.empty() ? 0 : 1);
  Settings settings(scene_, names, pointer);
  for (const SettingsList& one : settings_lists) {
    if (one.name == list) return (settings.*one.find)(rest);
  }
  return settings.other(list, rest);
}

std::string SceneValues::suggestion(std::string_view name) const {
  Suggestion suggestion(name);
  for (const ParameterDef& own : scene_.model.parameters) suggestion.consider(own.name);
  return suggestion.question();
}

}  // namespace sheave
