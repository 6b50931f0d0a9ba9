#include "measure/integrator_loss.h"

#include <algorithm>
#include <cmath>

#include "engine/body_set.h"

namespace sheave::measure {
namespace {

bool moves_freely(const BodyProperties& body) {
  return body.mobility != Mobility::fixed && body.mobility != Mobility::kinematic &&
         !body.prescribed();
}

bool turns_about_axis(const BodyProperties& body) {
  return body.mobility == Mobility::rotor || body.mobility == Mobility::planar;
}

/// In the world frame; of mounted rotors the carrier turns it.
Vector3 axis_of(const World& world, const BodyProperties& body) {
  if (body.mount < 0) return body.axis;
  return world.state().bodies[static_cast<std::size_t>(body.mount)].orientation * body.axis;
}

}  // namespace

IntegratorLoss::Step IntegratorLoss::step_to(const World& world,
                                             const std::vector<Momentum>& now) const {
  Step step;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyProperties& body = world.bodies()[i];
    if (!moves_freely(body)) continue;
    const auto at = static_cast<std::size_t>(i);
    if (body.mobility != Mobility::rotor && body.mass > 0.0) {
      const Vector3 change = now[at].linear - last_[at].linear;
      step.square += change.squaredNorm() / body.mass;
      step.first_power += change.dot(last_[at].linear) / body.mass;
      step.power += change.dot(now[at].linear) / body.mass;
    }
    Vector3 change = now[at].angular - last_[at].angular;
    Vector3 before = last_[at].angular;
    Vector3 after = now[at].angular;
    if (turns_about_axis(body)) {
      if (!(body.axis_inertia > 0.0)) continue;
      for (Vector3* momentum : {&before, &after}) *momentum /= body.axis_inertia;
    } else {
      const Quaternion& turn = world.state().bodies[at].orientation;
      const auto spin = [&](const Vector3& momentum) -> Vector3 {
        return turn * (body.inverse_inertia * (turn.conjugate() * momentum));
      };
      before = spin(before);
      after = spin(after);
    }
    step.square += change.dot(after - before);
    step.first_power += change.dot(before);
    step.power += change.dot(after);
  }
  return step;
}

void IntegratorLoss::observe(const World& world, double energy, std::int64_t fallbacks) {
  std::vector<Momentum> now(static_cast<std::size_t>(world.bodies().count()));
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyProperties& body = world.bodies()[i];
    const auto at = static_cast<std::size_t>(i);
    const BodyState& state = world.state().bodies[at];
    now[at].linear = body.mass * state.velocity;
    if (turns_about_axis(body)) {
      now[at].angular.x() = body.axis_inertia * state.angular_velocity.dot(axis_of(world, body));
    } else {
      const Quaternion& turn = state.orientation;
      now[at].angular = turn * (body.inertia * (turn.conjugate() * state.angular_velocity));
    }
  }
  if (last_.empty()) {
    sums_.energy = energy;
  } else {
    Step step = step_to(world, now);
    const StepSettings& settings = world.model().step;
    const double substeps = settings.substeps;
    const double by_xpbd = settings.integrator == IntegratorKind::xpbd
                               ? substeps
                               : static_cast<double>(fallbacks - fallbacks_);
    step.share = by_xpbd / (substeps * substeps);
    step.energy = energy;
    recent_.push_back(step);
    // A step has all its neighbours when two more are done.
    if (recent_.size() - counted_ > 2) {
      sums_.add(recent_[counted_], smooth_part(counted_));
      ++counted_;
    }
    if (recent_.size() > 4) {
      recent_.pop_front();
      --counted_;
    }
  }
  fallbacks_ = fallbacks;
  last_ = std::move(now);
}

double IntegratorLoss::smooth_part(std::size_t step) const {
  double smooth = 0.0;
  for (std::size_t first = step < 2 ? 0 : step - 2; first <= step; ++first) {
    if (first + 3 > recent_.size()) break;
    const double least =
        std::min({recent_[first].square, recent_[first + 1].square, recent_[first + 2].square});
    smooth = std::max(smooth, least);
  }
  return smooth;
}

void IntegratorLoss::Sums::add(const Step& step, double smooth) {
  const double limit = step.square > smooth ? smooth / step.square : 1.0;
  // The law holds between impacts: where one changes the velocity, a smooth motion ends and another
  // begins, each with v . a of its own.
  const bool smooth_motion = limit > 0.5;
  const double first = begun && smooth_motion ? power : std::sqrt(limit) * step.first_power;
  power = std::sqrt(limit) * step.power;
  const double rest = smooth_motion ? power - first : limit * step.square;
  const double loss = step.share * (limit * step.square - 0.5 * rest);
  taken += loss;
  exchanged += std::abs(step.energy - energy + loss);
  energy = step.energy;
  begun = smooth_motion;
}

IntegratorLoss::Sums IntegratorLoss::sums() const {
  Sums all = sums_;
  for (std::size_t i = counted_; i < recent_.size(); ++i) all.add(recent_[i], smooth_part(i));
  return all;
}

double IntegratorLoss::taken() const { return sums().taken; }

double IntegratorLoss::exchanged() const { return sums().exchanged; }

}  // namespace sheave::measure
