#include "web/engine/pointer_spring.h"

#include <algorithm>
#include <cmath>

#include "engine/body_set.h"

namespace sheave::web {
namespace {

constexpr double angular_frequency = 16.0;  // [rad/s], about 2.5 Hz
/// Rate at which a kinematic body approaches the pointer.
constexpr double kinematic_rate = 12.0;  // [1/s]

double mass_of(const World& world, int body) {
  const double mass = world.bodies()[body].mass;
  if (mass > 0.0) return mass;
  // A rotor on a fixed axle: the effective mass at its rim is about half of its mass.
  return 0.5 * world.model().bodies[static_cast<std::size_t>(body)].mass.value_or(1.0);
}

}  // namespace

Errors PointerSpring::grab(const LiveWorld& world, int body, const Vector3& point) {
  const World& physics = world.simulation().world;
  const Model& model = physics.model();
  if (body < 0 || body >= static_cast<int>(model.bodies.size())) {
    return {{"", "there is no body " + std::to_string(body)}};
  }
  const BodyDef& definition = model.bodies[static_cast<std::size_t>(body)];
  const bool driven = definition.drive == DriveKind::speed || definition.drive == DriveKind::angle;
  if (definition.mobility == Mobility::fixed || driven) {
    return {{"", definition.name + (driven ? " is turned by its drive, which yields to nothing"
                                           : " is static: nothing moves it")}};
  }
  if (definition.mobility == Mobility::knot) {
    return {{"", definition.name + " is a knot without mass: draw a body that its cables hold"}};
  }
  double all = 0.0;
  for (int i = 0; i < physics.bodies().count(); ++i) all += physics.bodies()[i].mass;
  own_mass_ = mass_of(physics, body);
  const double mass = std::max(own_mass_, 0.1 * all);
  stiffness_ = mass * angular_frequency * angular_frequency;
  damping_ = 2.0 * mass * angular_frequency;
  const BodyState& state = world.state().bodies[static_cast<std::size_t>(body)];
  local_ = state.orientation.conjugate() * (point - state.position);
  target_ = point;
  body_ = body;
  kinematic_ = definition.mobility == Mobility::kinematic;
  force_.setZero();
  return {};
}

void PointerSpring::release(LiveWorld& world) {
  if (body_ >= 0) {
    const BodyHandle body = world.body_at(body_);
    // If the force cannot be cleared, it was never set.
    if (kinematic_) {
      const BodyState& state = world.state().bodies[static_cast<std::size_t>(body_)];
      static_cast<void>(world.set_motion(body, {.position = state.position}));
    } else {
      static_cast<void>(world.clear_force(body));
    }
  }
  body_ = -1;
  force_.setZero();
}

void PointerSpring::copy_grip(const PointerSpring& other) {
  const Vector3 force = force_;
  *this = other;
  force_ = force;
}

void PointerSpring::act(LiveWorld& world, double h) {
  if (body_ < 0) return;
  if (kinematic_) {
    drag_kinematic(world, h);
    return;
  }
  const BodyState& state = world.state().bodies[static_cast<std::size_t>(body_)];
  const Vector3 arm = state.orientation * local_;
  const Vector3 velocity = state.velocity + state.angular_velocity.cross(arm);
  const Vector3 missing = target_ - state.position - arm;
  const double give = 1.0 + (damping_ + stiffness_ * h) * h / own_mass_;
  force_ = (stiffness_ * (missing - h * velocity) - damping_ * velocity) / give;
  PointForce pull;
  pull.force = force_;
  pull.point = local_;
  static_cast<void>(world.set_force(world.body_at(body_), pull));
}

void PointerSpring::drag_kinematic(LiveWorld& world, double h) const {
  const BodyState& state = world.state().bodies[static_cast<std::size_t>(body_)];
  const Vector3 missing = target_ - state.position - state.orientation * local_;
  const double share = -std::expm1(-kinematic_rate * h);
  static_cast<void>(world.set_motion(world.body_at(body_),
                                     {.position = state.position + share * missing, .over = h}));
}

}  // namespace sheave::web
