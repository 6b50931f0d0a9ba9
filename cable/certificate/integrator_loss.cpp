#include "cable/certificate/integrator_loss.h"

#include <algorithm>
#include <cmath>

#include "engine/body_set.h"
#include "engine/index.h"

namespace sheave::certify {
namespace {

bool moves_freely(const BodyProperties& body) {
  return yields(body.mobility) && !body.prescribed();
}

bool turns_about_axis(const BodyProperties& body) {
  return body.mobility == Mobility::rotor || body.mobility == Mobility::planar;
}

/// Adds the terms of the change of a body's momentum, and keeps the present momentum.
template <typename Step>
void add_linear(const Vector3& now, double mass, Vector3& last, Step& step) {
  const Vector3 change = now - last;
  step.square += change.squaredNorm() / mass;
  step.first_power += change.dot(last) / mass;
  step.power += change.dot(now) / mass;
  last = now;
}

}  // namespace

void IntegratorLoss::begin(const World& world) {
  const BodySet& bodies = world.bodies();
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& body = bodies[i];
    if (!moves_freely(body)) continue;
    if (!turns_about_axis(body)) {
      spatial_.push_back({i, Vector3::Zero(), Vector3::Zero()});
      continue;
    }
    const double mass = body.mobility == Mobility::rotor ? 0.0 : body.mass;
    axial_.push_back({i, body.mount, body.axis, body.axis_inertia, mass, Vector3::Zero(), 0.0});
  }
  begun_ = true;
}

IntegratorLoss::Step IntegratorLoss::follow(const World& world) {
  Step step;
  const std::vector<BodyState>& states = world.state().bodies;
  for (Axial& body : axial_) {
    const BodyState& state = states[at(body.body)];
    if (body.mass > 0.0) add_linear(body.mass * state.velocity, body.mass, body.linear, step);
    if (!(body.inertia > 0.0)) continue;
    const Vector3 axis =
        body.mount < 0 ? body.axis : states[at(body.mount)].orientation * body.axis;
    const double before = body.angular;
    const double now = body.inertia * state.angular_velocity.dot(axis);
    const double rate = (now - before) / body.inertia;
    step.square += (now - before) * rate;
    step.first_power += before * rate;
    step.power += now * rate;
    body.angular = now;
  }
  for (Spatial& own : spatial_) {
    const BodyProperties& body = world.bodies()[own.body];
    const BodyState& state = states[at(own.body)];
    if (body.mass > 0.0) add_linear(body.mass * state.velocity, body.mass, own.linear, step);
    const Quaternion& turn = state.orientation;
    const auto in_body = [&](const Vector3& vector) { return rotated(turn.conjugate(), vector); };
    const Vector3 now = rotated(turn, times(body.inertia, in_body(state.angular_velocity)));
    const Vector3 change = now - own.angular;
    const Vector3 before = rotated(turn, times(body.inverse_inertia, in_body(own.angular)));
    step.square += change.dot(state.angular_velocity - before);
    step.first_power += change.dot(before);
    step.power += change.dot(state.angular_velocity);
    own.angular = now;
  }
  return step;
}

void IntegratorLoss::observe(const World& world, double energy, std::int64_t fallbacks) {
  const bool begins = !begun_;
  if (begins) begin(world);
  Step step = follow(world);
  if (begins) {
    sums_.energy = energy;
  } else {
    const StepSettings& settings = world.model().step;
    const double substeps = settings.substeps;
    double by_xpbd = settings.integrator == IntegratorKind::xpbd
                         ? substeps
                         : static_cast<double>(fallbacks - fallbacks_);
    // With a tolerance `xpbd` does parts that are too short to take energy.
    if (settings.tolerance > 0.0) by_xpbd = 0.0;
    step.share = by_xpbd / (substeps * substeps);
    step.energy = energy;
    recent_.push_back(step);
    // A step has both neighbours on each side after two further steps.
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
  // The law holds between impacts. At an impact one smooth motion ends and another begins, each
  // with its own v . a.
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

}  // namespace sheave::certify
