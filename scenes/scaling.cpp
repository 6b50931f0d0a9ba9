#include "scenes/scaling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "scenes/drive_unit.h"
#include "scenes/format.h"

namespace sheave {
namespace {

using SettingJson = nlohmann::ordered_json;

/// The unit of a field of an object in the text.
std::string_view unit_of(const Field& field, const std::vector<const Field*>& fields,
                         const SettingJson& object) {
  const auto units = drive_units(field.unit);
  if (!units) return field.unit;
  const std::string_view drive = drive_of(field.name);
  for (const Field* other : fields) {
    if (other->name != drive || !object.contains(drive)) continue;
    for (std::size_t i = 1; i < other->choices.size() && i <= units->size(); ++i) {
      if (object[std::string(drive)] == other->choices[i]) return (*units)[i - 1];
    }
  }
  return "";
}

class Walk {
 public:
  void object(const SettingJson& object, const ObjectFormat& format, const std::string& pointer) {
    std::vector<const Field*> fields;
    for (const TableFormat& table : format.tables) append(table, fields);
    if (object.contains("type")) {
      if (const Variant* variant = format.variant(object["type"].get<std::string>())) {
        append(variant->table, fields);
      }
    }
    for (const auto& [key, value] : object.items()) {
      const std::string place = pointer + "/" + key;
      if (const Member* member = format.member(key)) {
        follow(value, *member, place);
        continue;
      }
      for (const Field* field : fields) {
        if (field->name == key) setting(value, unit_of(*field, fields, object), place);
      }
    }
  }
  std::vector<ScalableSetting> found;

 private:
  static void append(const TableFormat& table, std::vector<const Field*>& fields) {
    for (const Field& field : table.fields) fields.push_back(&field);
  }
  void follow(const SettingJson& value, const Member& member, const std::string& place) {
    constexpr std::array<std::string_view, 6> without_effect{"camera", "camera_path", "annotations",
                                                             "paint",  "checks",      "parameters"};
    if (std::find(without_effect.begin(), without_effect.end(), member.name) !=
        without_effect.end()) {
      return;
    }
    if (!value.is_array()) return object(value, *member.format, place);
    for (std::size_t i = 0; i < value.size(); ++i) {
      object(value[i], *member.format, place + "/" + std::to_string(i));
    }
  }
  void setting(const SettingJson& value, std::string_view unit, const std::string& place) {
    const std::optional<UnitPowers> powers = unit_powers(unit);
    if (!powers || (powers->length == 0 && powers->mass == 0)) return;
    found.push_back({place, value.dump(), *powers});
  }
};

void multiply(SettingJson& value, double factor) {
  if (value.is_number()) {
    value = value.get<double>() * factor;
  } else if (value.is_array()) {
    for (SettingJson& element : value) multiply(element, factor);
  }
}

}  // namespace

std::vector<ScalableSetting> scalable_settings(std::string_view text) {
  const SettingJson scene = SettingJson::parse(text, nullptr, false, true);
  Walk walk;
  if (scene.is_object()) walk.object(scene, scene_format(), "");
  return std::move(walk.found);
}

Override scaled(const ScalableSetting& setting, double factor) {
  SettingJson value = SettingJson::parse(setting.value);
  multiply(value, factor);
  return {setting.pointer, value.dump(), "--set " + setting.pointer};
}

std::vector<Override> similar_scene(const std::vector<ScalableSetting>& settings,
                                    double length_factor, double mass_factor) {
  std::vector<Override> overrides;
  for (const ScalableSetting& setting : settings) {
    const double factor =
        std::pow(length_factor, setting.powers.length) * std::pow(mass_factor, setting.powers.mass);
    overrides.push_back(scaled(setting, factor));
  }
  return overrides;
}

}  // namespace sheave
