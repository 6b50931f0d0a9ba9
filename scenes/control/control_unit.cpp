#include "scenes/control/control_unit.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/control/control_point.h"
#include "scenes/drive_unit.h"

namespace sheave {
namespace {

/// Names without the settings of triggers and controllers, whose units follow from quantities.
class NamesOfParts final : public QuantityNames {
 public:
  explicit NamesOfParts(const QuantityNames& all) : all_(all) {}
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    return all_.find(name);
  }
  [[nodiscard]] std::size_t longest() const override { return all_.longest(); }
  [[nodiscard]] Unit unit(int index) const override { return all_.unit(index); }
  [[nodiscard]] std::optional<ExpressionNumber> setting(std::string_view pointer) const override {
    if (is_of_control(pointer)) return {};
    return all_.setting(pointer);
  }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    if (!is_of_control(name)) return all_.fault(name);
    return fmt::format(
        "the unit of a setting cannot follow from \"{}\"; give the number a name in "
        "parameters",
        name);
  }

 private:
  static bool is_of_control(std::string_view pointer) {
    return pointer.starts_with("/triggers/") || pointer.starts_with("/controllers/");
  }
  const QuantityNames& all_;
};

Result<Unit> unit_of_quantity(std::string_view quantity, const QuantityNames& names) {
  const Result<Expression> made = Expression::compile(quantity, NamesOfParts(names));
  if (!made) return made.errors();
  return made->unit();
}

/// The unit of a field of a joint with the prefix of the coordinate at this index.
Unit unit_at_joint(const JointDef& joint, int coordinate, std::string_view ending) {
  for (const auto& type : joint_types()) {
    if (type.name != joint.type()) continue;
    int drives = 0;
    for (const Field& field : type.fields()) {
      if (!field.name.ends_with(ending) || drives++ < coordinate) continue;
      return Unit(setting_unit(field, type.fields(), joint.settings()));
    }
  }
  return {};
}

Unit unit_of_body_drive(const BodyDef& body) {
  const std::span<const Field> table = BodyDef::field_table();
  const auto values = std::find_if(table.begin(), table.end(),
                                   [](const Field& field) { return field.name == "drive_values"; });
  return values == table.end() ? Unit() : Unit(setting_unit(*values, table, &body));
}

Unit unit_of_point(const ControlPoint& point, const Scene& scene) {
  using Kind = ControlPoint::Kind;
  switch (point.kind) {
    case Kind::body_drive:
      return unit_of_body_drive(scene.model.bodies[at(point.entity)]);
    case Kind::joint_drive:
      return unit_at_joint(*scene.model.joints[at(point.entity)], point.item, "drive_values");
    case Kind::joint_limit:
      return unit_at_joint(*scene.model.joints[at(point.entity)], point.item, "drive_limit");
    case Kind::force:
    case Kind::breaking_tension:
      return Unit("N");
    case Kind::torque:
      return Unit("N m");
    case Kind::gravity:
      return Unit("m/s2");
    case Kind::feed_speed:
      return Unit("m/s");
    case Kind::compliance:
      return Unit("m/N");
    case Kind::link_friction:
    case Kind::excitation:
      return {};
  }
  return {};
}

/// A setting of a controller: its unit is that of the control, where `control` is set, over that of
/// the measured quantity, where `measured` is set, times seconds.
struct GainUnit {
  std::string_view setting;
  bool control = false;
  bool measured = false;
  double seconds = 0.0;
};
constexpr std::array<GainUnit, 10> gain_units{{{"proportional", true, true, 0.0},
                                               {"integral", true, true, -1.0},
                                               {"derivative", true, true, 1.0},
                                               {"feed_forward", true, false, 0.0},
                                               {"setpoint_gain", true, true, 0.0},
                                               {"rate_gain", true, true, 1.0},
                                               {"lower", true, false, 0.0},
                                               {"upper", true, false, 0.0},
                                               {"low", true, false, 0.0},
                                               {"high", true, false, 0.0}}};

}  // namespace

Result<Unit> control_unit(std::string_view control, const Scene& scene) {
  const Result<ControlPoint> point = find_control(control, scene.model, scene.cables, scene.loads);
  if (!point) return point.errors();
  return unit_of_point(*point, scene);
}

std::optional<Result<Unit>> unit_of_setting(const TriggerDef& trigger, std::string_view setting,
                                            const Scene& scene, const QuantityNames& names) {
  if (setting == "value") return control_unit(trigger.target, scene);
  if (setting == "above" || setting == "below") return unit_of_quantity(trigger.quantity, names);
  return {};
}

std::optional<Result<Unit>> unit_of_setting(const ControllerDef& controller,
                                            std::string_view setting, const Scene& scene,
                                            const QuantityNames& names) {
  if (setting == "setpoint" || setting == "setpoint_values" || setting == "hysteresis") {
    return unit_of_quantity(controller.measures, names);
  }
  const auto gain = std::find_if(gain_units.begin(), gain_units.end(),
                                 [&](const GainUnit& one) { return one.setting == setting; });
  if (gain == gain_units.end()) return {};
  Result<Unit> unit = control_unit(controller.control, scene);
  if (!unit || !gain->measured) return unit;
  const Result<Unit> measured = unit_of_quantity(controller.measures, names);
  if (!measured) return measured;
  return unit->over(*measured).times(Unit("s").to_the(gain->seconds));
}

}  // namespace sheave
