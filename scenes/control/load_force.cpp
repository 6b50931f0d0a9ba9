#include "scenes/control/load_force.h"

#include "engine/world.h"

namespace sheave {
namespace {

constexpr std::array<std::string_view, 2> force_frame_names{"world", "body"};

class ActingForce final : public ActingLoad {
 public:
  explicit ActingForce(const ForceLoad& load)
      : forces_(load.times, load.forces, load.interpolation),
        torques_(load.times, load.torques, load.interpolation),
        point_(load.point),
        frame_(load.frame) {}

  [[nodiscard]] PointForce force(const World& world, double h,
                                 std::span<double> /*memory*/) const override {
    const double now = world.state().time;
    return {forces_.mean(now, now + h), torques_.mean(now, now + h), point_, frame_};
  }

 private:
  VectorTable forces_;
  VectorTable torques_;
  std::optional<Vector3> point_;
  ForceFrame frame_;
};

}  // namespace

std::span<const Field> ForceLoad::field_table() {
  static const std::array table{
      field<&ForceLoad::times>("times", "s", any_number(), optional,
                               "increasing times of the values; none for a constant"),
      field<&ForceLoad::forces>("forces", "N", any_number(), optional,
                                "[x, y, z] of the force, one per time"),
      field<&ForceLoad::torques>(
          "torques", "N m", any_number(), optional,
          "[x, y, z] of a torque in addition to the moment of the force, one per time"),
      choice_field<&ForceLoad::interpolation>("interpolation", interpolation_names, optional,
                                              interpolation_meaning),
      field<&ForceLoad::point>("point", "m", any_number(), optional,
                               "where the force acts, body frame; default: the centre of mass"),
      choice_field<&ForceLoad::frame>(
          "frame", force_frame_names, optional,
          "of force and torque: of the world, or of the body, with which they turn"),
  };
  return table;
}

Errors ForceLoad::validate(const LoadScope& scope, const std::string& path) const {
  Errors errors = LoadDef::validate(scope, path);
  if (forces.empty() && torques.empty()) {
    errors.push_back(fault(path, "it needs forces or torques"));
  }
  check_table(times, forces.size(), "forces", path, errors);
  check_table(times, torques.size(), "torques", path, errors);
  check_times(times, path, errors);
  return errors;
}

std::shared_ptr<const ActingLoad> ForceLoad::prepare(const LoadScope& /*scope*/) const {
  return std::make_shared<const ActingForce>(*this);
}

}  // namespace sheave
