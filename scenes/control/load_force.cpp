#include "scenes/control/load_force.h"

#include <algorithm>

#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/world.h"

namespace sheave {
namespace {

constexpr std::array<std::string_view, 2> force_frame_names{"world", "body"};

class ActingForce final : public ActingLoad {
 public:
  explicit ActingForce(const ForceLoad& load)
      : forces_(load.times, load.forces, load.interpolation),
        torques_(load.times, load.torques, load.interpolation),
        body_(load.body),
        point_(load.point),
        frame_(load.frame) {}

  [[nodiscard]] PointForce force(const World& world, const LoadSubstep& substep,
                                 std::span<double> /*memory*/) const override {
    const double now = world.state().time;
    const double end = now + substep.length;
    return {forces_.mean(now, end), torques_.mean(now, end), point_, frame_};
  }

  [[nodiscard]] LoadCourse course(const World& world, double h) const override {
    const double now = world.state().time;
    const BodyProperties& body = world.bodies()[body_.index];
    const Quaternion& orientation = world.state().bodies[at(body_.index)].orientation;
    LoadCourse course{forces_.moment(now, now + h), torques_.moment(now, now + h)};
    if (frame_ == ForceFrame::body) {
      course.force = rotated(orientation, course.force);
      course.torque = rotated(orientation, course.torque);
    }
    if (point_) {
      course.torque += rotated(orientation, *point_ - body.center_of_mass).cross(course.force);
    }
    course.corner = std::min(forces_.next_corner(now), torques_.next_corner(now));
    return course;
  }

 private:
  VectorTable forces_;
  VectorTable torques_;
  BodyId body_;
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
