#include "scenes/quantity_unit.h"

#include <algorithm>
#include <array>
#include <vector>

#include "scenes/quantities.h"

namespace sheave {
namespace {

/// Names of joint coordinates, and whether they are angles (JointDef::coordinates()).
struct CoordinateName {
  std::string_view name;
  bool angle;
};
constexpr std::array<CoordinateName, 7> coordinate_units{{
    {"extension", false},
    {"travel", false},
    {"angle", true},
    {"angle_a", true},
    {"angle_b", true},
    {"twist", true},
    {"swing", true},
}};

/// Adds the units of the quantities of that name, which bodies and joints may both have.
void add_units(std::span<const QuantityGroup> groups, std::string_view last,
               std::vector<std::string_view>& units) {
  constexpr std::string_view between = ", ";
  for (const QuantityGroup& group : groups) {
    for (const Quantity& quantity : group.quantities) {
      if (quantity.name != last) continue;
      std::string_view rest = quantity.unit;
      while (true) {
        const std::string_view unit = rest.substr(0, rest.find(between));
        if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
        if (unit.size() == rest.size()) break;
        rest.remove_prefix(unit.size() + between.size());
      }
    }
  }
}

/// Units of "<coordinate>", "<coordinate>_rate", "<coordinate>_drive_force" and similar names.
std::optional<std::string> of_coordinate(std::string_view last) {
  for (const auto& [name, angle] : coordinate_units) {
    if (!last.starts_with(name)) continue;
    const std::string_view rest = last.substr(name.size());
    if (rest.empty()) return angle ? "rad" : "m";
    if (rest == "_rate") return angle ? "rad/s" : "m/s";
    if (rest == "_drive_force") return angle ? "N m" : "N";
    if (rest == "_drive_power") return "W";
    if (rest == "_drive_error") return angle ? "rad, rad/s" : "m, m/s";
  }
  return {};
}

}  // namespace

std::optional<std::string> quantity_unit(std::string_view name) {
  if (name == "t") return "s";
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return {};
  const std::string_view last = name.substr(dot + 1);
  std::vector<std::string_view> units;
  add_units(quantity_groups(), last, units);
  add_units(requested_quantity_groups(), last, units);
  if (units.empty()) return of_coordinate(last);
  std::string all(units.front());
  for (std::size_t i = 1; i < units.size(); ++i) all.append(", ").append(units[i]);
  return all;
}

}  // namespace sheave
