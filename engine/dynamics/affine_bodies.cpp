#include "engine/dynamics/affine_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/divergence.h"
#include "engine/index.h"
#include "engine/integrators/loads.h"

namespace sheave {

std::optional<AffineBodies> AffineBodies::of(const BodySet& bodies) {
  AffineBodies affine(bodies);
  affine.numbers_.assign(at(bodies.count()) + 1, 0);
  affine.movers_.emplace_back();
  for (int i = 0; i < bodies.count(); ++i) {
    if (!affine.add(i)) return std::nullopt;
  }
  const std::size_t count = affine.movers_.size();
  for (std::vector<double>* values :
       {&affine.yields_, &affine.keep_, &affine.gains_, &affine.push_, &affine.set_loads_,
        &affine.farthest_, &affine.fastest_, &affine.loaded_, &affine.places_, &affine.speeds_,
        &affine.motion_, &affine.end_places_, &affine.end_speeds_}) {
    values->assign(count, 0.0);
  }
  affine.prescribed_speeds_.assign(affine.prescribed_.size(), 0.0);
  affine.scratch_.assign(3 * affine.turning_.size(), 0.0);
  return affine;
}

bool AffineBodies::add(int body) {
  const BodyProperties& properties = (*bodies_)[body];
  const BodyDef& definition = bodies_->definition(body);
  if (properties.mobility == Mobility::fixed) return properties.mounted_rotors.empty();
  const auto number = static_cast<int>(movers_.size());
  Mover mover;
  mover.body = body;
  mover.axis = properties.axis;
  if (properties.mobility == Mobility::slider) {
    mover.slides = true;
    mover.mass = properties.mass;
    mover.drag = definition.damping;
    Vector3 force = properties.mass * bodies_->gravity() + definition.force;
    for (const int rotor : properties.mounted_rotors) force += bodies_->definition(rotor).force;
    mover.load = dot(mover.axis, force);
  } else if (properties.mobility == Mobility::rotor) {
    if (properties.massless()) return false;
    Quaternion carrier = Quaternion::Identity();
    if (properties.mount >= 0) {
      if ((*bodies_)[properties.mount].mobility != Mobility::slider) return false;
      carrier = bodies_->initial_orientation(properties.mount);
      mover.axis = carrier * properties.axis;
      mover.carrier = properties.mount;
      mover.offset = carrier * properties.mount_position;
    }
    mover.mass = properties.prescribed() ? 0.0 : properties.axis_inertia;
    mover.drag = definition.angular_damping;
    mover.load = dot(mover.axis, definition.torque);
    const Vector3& own = properties.axis;
    const Quaternion upright = carrier * properties.start_orientation;
    const Quaternion turned =
        carrier * Quaternion(0.0, own.x(), own.y(), own.z()) * properties.start_orientation;
    TurningBody turning{{}, {}, {mover.axis.x(), mover.axis.y(), mover.axis.z()}, body, number};
    std::copy_n(upright.coeffs().data(), 4, turning.upright.begin());
    std::copy_n(turned.coeffs().data(), 4, turning.turned.begin());
    turning_.push_back(turning);
  } else {
    return false;
  }
  numbers_[at(body)] = number;
  if (properties.prescribed()) prescribed_.push_back(number);
  if (properties.drive == DriveKind::torque) driven_.push_back(number);
  if (mover.carrier >= 0) mounted_.push_back(number);
  // A velocity along a coordinate axis holds the speed without rounding.
  int component = 0;
  const bool straight =
      mover.axis.cwiseAbs().maxCoeff(&component) == 1.0 && mover.axis.cwiseAbs().sum() == 1.0;
  if (mover.slides && straight) straight_.push_back({number, component, mover.axis[component]});
  if (mover.slides || !straight) rounded_.push_back(number);
  movers_.push_back(mover);
  return true;
}

void AffineBodies::prepare(double h, double time) {
  if (h == h_ && time == drag_time_) return;
  h_ = h;
  drag_time_ = time;
  const Runaway runaway = runaway_limits(bodies_->scale(), h);
  for (std::size_t d = 1; d < movers_.size(); ++d) {
    const Mover& mover = movers_[d];
    farthest_[d] = mover.slides ? runaway.distance : std::numeric_limits<double>::max();
    fastest_[d] = mover.slides ? runaway.speed : runaway.spin;
    keep_[d] = 1.0;
    if (mover.mass == 0.0) continue;
    const auto [keep, gain] = decay(mover.drag / mover.mass, time);
    keep_[d] = keep;
    gains_[d] = gain / mover.mass;
    push_[d] = gains_[d] * mover.load;
    yields_[d] = gains_[d] / time;
    if (mover.drag == 0.0) yields_[d] = 1.0 / mover.mass;
  }
}

BodyDrive AffineBodies::drive_of(std::size_t number) const {
  const int body = movers_[number].body;
  return {(*bodies_)[body], *controls_, body};
}

bool AffineBodies::set_load_on(const Mover& mover, const State& state, double& load) const {
  const ControlTable<ForceControl>& forces = state.controls.forces;
  load = 0.0;
  const ForceControl* set = forces.find(mover.body);
  if (!mover.slides) {
    if (set == nullptr) return true;
    // A force that is fixed in the body's frame has the same torque about the axle at every angle.
    const bool turns =
        set->frame == ForceFrame::world && !set->force.isZero(0.0) && !set->arm.isZero(0.0);
    load = dot(mover.axis, set->torque_in_world(state.bodies[at(mover.body)].orientation));
    return !turns;
  }
  const BodyProperties& body = (*bodies_)[mover.body];
  if (set != nullptr) {
    load += dot(mover.axis, set->force_in_world(state.bodies[at(mover.body)].orientation));
  }
  for (const int rotor : body.mounted_rotors) {
    const ForceControl* on_rotor = forces.find(rotor);
    if (on_rotor == nullptr) continue;
    // A force that turns with the rotor has a component along the slider that changes with the
    // angle.
    if (on_rotor->frame == ForceFrame::body && !on_rotor->force.isZero(0.0)) return false;
    load += dot(mover.axis, on_rotor->force);
  }
  return true;
}

bool AffineBodies::take_set_loads(const State& state) {
  for (std::size_t d = 1; d < movers_.size(); ++d) {
    if (!set_load_on(movers_[d], state, set_loads_[d])) return false;
    double load = movers_[d].load + set_loads_[d];
    if (state.controls.has_gravity && movers_[d].slides) {
      const Vector3 change = state.controls.gravity - bodies_->gravity();
      load += movers_[d].mass * dot(movers_[d].axis, change);
    }
    push_[d] = gains_[d] * load;
  }
  return true;
}

double AffineBodies::work_of_set_loads() const {
  if (!has_set_loads_) return 0.0;
  double work = 0.0;
  for (std::size_t d = 1; d < movers_.size(); ++d) {
    // The same rule for torques as in work_of_set_forces().
    const double way = movers_[d].slides ? motion_[d] : 0.5 * h_ * (speeds_[d] + end_speeds_[d]);
    work += set_loads_[d] * way;
  }
  return work;
}

bool AffineBodies::load(const State& state, bool known) {
  controls_ = &state.controls;
  const bool any = state.controls.has_gravity || state.controls.forces.any();
  if (any || has_set_loads_) {
    // The flag is set first: loads that were taken before a refusal must be removed later.
    has_set_loads_ = true;
    if (!take_set_loads(state)) return false;
    has_set_loads_ = any;
  }
  if (known) return true;
  const BodyState* const bodies = state.bodies.data();
  const Mover* const movers = movers_.data();
  double* const places = places_.data();
  double* const speeds = speeds_.data();
  const std::size_t count = movers_.size();
  for (std::size_t d = 1; d < count; ++d) {
    const Mover& mover = movers[d];
    const BodyState& body = bodies[mover.body];
    places[d] = mover.slides ? dot(mover.axis, body.position) : body.angle;
    speeds[d] = dot(mover.axis, mover.slides ? body.velocity : body.angular_velocity);
  }
  std::copy(places_.begin(), places_.end(), loaded_.begin());
  begin_passing(state);
  return true;
}

void AffineBodies::predict(double from, double loaded, double to) {
  const std::size_t count = movers_.size();
  load_speeds(count, keep_.data(), push_.data(), speeds_.data(), end_speeds_.data());
  move_at(count, h_, end_speeds_.data(), motion_.data());
  for (const int number : driven_) {
    const std::size_t d = at(number);
    end_speeds_[d] += yields_[d] * drive_of(d).integral(from, loaded);
    motion_[d] = h_ * end_speeds_[d];
  }
  std::size_t i = 0;
  for (const int number : prescribed_) {
    const std::size_t d = at(number);
    const BodyDrive drive = drive_of(d);
    motion_[d] = drive.turn(from, to);
    end_speeds_[d] = drive.speed(from, to, h_, loaded < to);
    prescribed_speeds_[i++] = end_speeds_[d];
  }
}

void AffineBodies::go_straight(std::span<double> way) const {
  for (std::size_t d = 1; d < movers_.size(); ++d) {
    way[d] = yields_[d] > 0.0 ? h_ * speeds_[d] : motion_[d];
  }
}

void AffineBodies::derive() {
  move_at(movers_.size(), 1.0 / h_, motion_.data(), end_speeds_.data());
  for (std::size_t i = 0; i < prescribed_.size(); ++i) {
    end_speeds_[at(prescribed_[i])] = prescribed_speeds_[i];
  }
}

void AffineBodies::add_loads(double from, double to) {
  load_speeds(movers_.size(), keep_.data(), push_.data(), end_speeds_.data(), end_speeds_.data());
  for (const int number : driven_) {
    const std::size_t d = at(number);
    end_speeds_[d] += yields_[d] * drive_of(d).integral(from, to);
  }
}

bool AffineBodies::arrive() {
  return move_places(movers_.size(), places_.data(), motion_.data(), farthest_.data(),
                     end_speeds_.data(), fastest_.data(), end_places_.data());
}

void AffineBodies::go_on() {
  places_.swap(end_places_);
  speeds_.swap(end_speeds_);
}

void AffineBodies::carry_mounted(State& state) const {
  for (const int number : mounted_) {
    const Mover& mover = movers_[at(number)];
    const BodyState& carrier = state.bodies[at(mover.carrier)];
    BodyState& body = state.bodies[at(mover.body)];
    body.position = carrier.position + mover.offset;
    body.velocity = carrier.velocity;
  }
}

void AffineBodies::begin_passing(const State& loaded) {
  passed_positions_.resize(movers_.size());
  passed_speeds_.resize(movers_.size());
  by_component_.clear();
  by_vector_.clear();
  // A sum of vectors can change the sign of a zero. Positions with a negative zero therefore take
  // the path of vectors, as in a state.
  const auto has_negative_zero = [](const Vector3& place) {
    return std::any_of(place.data(), place.data() + 3,
                       [](double x) { return x == 0.0 && std::signbit(x); });
  };
  auto straight = straight_.begin();
  for (const int number : rounded_) {
    const std::size_t d = at(number);
    passed_positions_[d] = loaded.bodies[at(movers_[d].body)].position;
    const bool is_straight = straight != straight_.end() && straight->number == number;
    if (is_straight && !has_negative_zero(passed_positions_[d])) {
      by_component_.push_back(*straight);
    } else {
      by_vector_.push_back(number);
    }
    if (is_straight) ++straight;
  }
}

void AffineBodies::pass() {
  for (const Straight& mover : by_component_) {
    const std::size_t d = at(mover.number);
    double& along = passed_positions_[d].data()[mover.component];
    along += (places_[d] - loaded_[d]) * mover.sense;
    loaded_[d] = places_[d] = mover.sense * along;
  }
  for (const int number : by_vector_) {
    const std::size_t d = at(number);
    const Mover& mover = movers_[d];
    passed_speeds_[d] = speeds_[d];
    if (mover.slides) {
      passed_positions_[d] = sum(passed_positions_[d], places_[d] - loaded_[d], mover.axis);
      loaded_[d] = places_[d] = dot(mover.axis, passed_positions_[d]);
    }
    const Vector3 velocity = speeds_[d] * mover.axis;
    speeds_[d] = dot(mover.axis, velocity);
  }
}

void AffineBodies::store_slider(std::size_t number, double speed, State& state) const {
  const Mover& mover = movers_[number];
  BodyState& body = state.bodies[at(mover.body)];
  body.position = passed_positions_[number];
  body.velocity = speed * mover.axis;
}

void AffineBodies::store_passed(State& state) {
  turn_bodies(turning_, places_.data(), speeds_.data(), scratch_.data(), state.bodies.data());
  for (const int number : rounded_) {
    const std::size_t d = at(number);
    if (movers_[d].slides) store_slider(d, speeds_[d], state);
  }
  // These bodies get the speeds from before the rounding by pass().
  for (const int number : by_vector_) {
    const std::size_t d = at(number);
    const Mover& mover = movers_[d];
    if (mover.slides) {
      store_slider(d, passed_speeds_[d], state);
    } else {
      state.bodies[at(mover.body)].angular_velocity = passed_speeds_[d] * mover.axis;
    }
  }
  carry_mounted(state);
}

}  // namespace sheave
