#include "scenes/quantity_unit.h"

#include <algorithm>
#include <array>
#include <vector>

#include "scenes/expression.h"
#include "scenes/format.h"
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

std::optional<std::string> unit_of_name(std::string_view name) {
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

/// Every name whose last part has a unit, "<object>.<part>.<part>", is a quantity.
class AnyNames final : public QuantityNames {
 public:
  /// Appends the units of the names that it finds.
  explicit AnyNames(std::vector<Unit>& units) : units_(units) {}

  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    const std::size_t object = std::min(name.find('.'), name.size());
    constexpr std::string_view parts =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
    if (!is_name(name.substr(0, object)) || reads_as_minus(name.substr(0, object))) return {};
    if (name.find_first_not_of(parts, object) != std::string_view::npos) return {};
    const std::optional<std::string> unit = unit_of_name(name);
    if (!unit) return {};
    units_.emplace_back(*unit);
    return static_cast<int>(units_.size()) - 1;
  }
  [[nodiscard]] std::size_t longest() const override { return 200; }
  [[nodiscard]] Unit unit(int index) const override {
    return units_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] std::string fault(std::string_view /*name*/) const override { return {}; }

 private:
  /// A hyphen at the beginning or beside a space is a minus to readers.
  static bool reads_as_minus(std::string_view object) {
    return object.starts_with('-') || object.find("- ") != std::string_view::npos ||
           object.find(" -") != std::string_view::npos;
  }

  std::vector<Unit>& units_;
};

}  // namespace

std::optional<std::string> quantity_unit(std::string_view name) {
  const bool computes = name.find_first_of("+*/^()<>=!,'") != std::string_view::npos ||
                        name.find(" - ") != std::string_view::npos;
  if (!computes) return unit_of_name(name);
  std::vector<Unit> units;
  const Result<Expression> expression = Expression::compile(name, AnyNames(units));
  if (!expression) return {};
  return expression->unit().text();
}

}  // namespace sheave
