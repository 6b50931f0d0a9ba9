#include "scenes/control/load_wind.h"

#include <algorithm>

#include "engine/body_set.h"
#include "engine/world.h"

namespace sheave {
namespace {

class ActingWind final : public ActingLoad {
 public:
  explicit ActingWind(const WindLoad& load)
      : wind_(load.times, load.velocities, load.interpolation),
        factor_(0.5 * load.density * load.drag_area),
        body_(load.body),
        point_(load.point) {}

  /// Per moment of the last two substeps: the point's velocity and the time.
  [[nodiscard]] std::size_t memory_size() const override { return std::size_t{2} * moment_size; }

  [[nodiscard]] PointForce force(const World& world, const LoadSubstep& substep,
                                 std::span<double> memory) const override {
    const double h = substep.length;
    const double now = world.state().time;
    const Vector3 velocity = velocity_now(world);
    const std::span<double> before = memory.first(moment_size);
    const std::span<double> last = memory.last(moment_size);
    if (last[3] < now) {
      std::copy(last.begin(), last.end(), before.begin());
      for (int k = 0; k < 3; ++k) last[static_cast<std::size_t>(k)] = velocity[k];
      last[3] = now;
    }
    if (substep.jumped) before[3] = no_memory;
    Vector3 middle = velocity;
    if (before[3] >= 0.0) {
      const Vector3 then(before[0], before[1], before[2]);
      middle += 0.5 * h / (now - before[3]) * (velocity - then);
    }
    const Vector3 relative = wind_.mean(now, now + h) - middle;
    return {factor_ * relative.norm() * relative, Vector3::Zero(), point_, ForceFrame::world};
  }

  [[nodiscard]] LoadCourse course(const World& world, double h) const override {
    // The derivative of the force by the velocity is at most 2 factor |u - v|.
    const double now = world.state().time;
    const Vector3 velocity = velocity_now(world);
    double fastest = 0.0;
    for (const double time : {now, now + 0.5 * h, now + h}) {
      fastest = std::max(fastest, (wind_.at(time) - velocity).norm());
    }
    LoadCourse course{2.0 * factor_ * fastest * wind_.moment(now, now + h)};
    if (point_) {
      const Vector3 arm = *point_ - world.bodies()[body_.index].center_of_mass;
      const BodyState& state = world.state().bodies[static_cast<std::size_t>(body_.index)];
      course.torque = rotated(state.orientation, arm).cross(course.force);
    }
    course.corner = wind_.next_corner(now);
    return course;
  }

 private:
  static constexpr std::size_t moment_size = 4;

  [[nodiscard]] Vector3 velocity_now(const World& world) const {
    const BodyState& state = world.state().bodies[static_cast<std::size_t>(body_.index)];
    if (!point_) return state.velocity;
    const Vector3 arm = *point_ - world.bodies()[body_.index].center_of_mass;
    return state.velocity + state.angular_velocity.cross(rotated(state.orientation, arm));
  }

  VectorTable wind_;
  double factor_;
  BodyId body_;
  std::optional<Vector3> point_;
};

}  // namespace

std::span<const Field> WindLoad::field_table() {
  static const std::array table{
      field<&WindLoad::drag_area>("drag_area", "m2", above(0.0), required,
                                  "drag coefficient times area"),
      field<&WindLoad::density>("density", "kg/m3", above(0.0), optional, "of the air"),
      field<&WindLoad::times>("times", "s", any_number(), optional,
                              "increasing times of the velocities; none for a constant"),
      field<&WindLoad::velocities>("velocities", "m/s", any_number(), optional,
                                   "[x, y, z] of the wind, one per time; none: still air"),
      choice_field<&WindLoad::interpolation>("interpolation", interpolation_names, optional,
                                             interpolation_meaning),
      field<&WindLoad::point>("point", "m", any_number(), optional,
                              "where the drag acts, body frame; default: the centre of mass"),
  };
  return table;
}

Errors WindLoad::validate(const LoadScope& scope, const std::string& path) const {
  Errors errors = LoadDef::validate(scope, path);
  check_table(times, velocities.size(), "velocities", path, errors);
  check_times(times, path, errors);
  return errors;
}

std::shared_ptr<const ActingLoad> WindLoad::prepare(const LoadScope& /*scope*/) const {
  return std::make_shared<const ActingWind>(*this);
}

}  // namespace sheave
