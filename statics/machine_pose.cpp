#include "statics/machine_pose.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/joint.h"
#include "engine/joints/joint_effect.h"
#include "engine/math/portable.h"
#include "engine/stages.h"

namespace sheave {
namespace {

/// Null for other features than joints.
const JointFeature* joints_of(const ConstraintBatch& feature) {
  return dynamic_cast<const JointFeature*>(&feature);
}

/// Per multiplier of a feature of joints: whether it belongs to a drive.
std::vector<char> drive_rows(const Model& model, const std::vector<JointPlace>& joints,
                             const JointFeature& feature, std::size_t count) {
  std::vector<char> drives(count, 0);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].feature != &feature) continue;
    const auto coordinates = static_cast<int>(model.joints[j]->coordinates().size());
    for (int k = 0; k < coordinates; ++k) {
      const int row = feature.drive_row(joints[j].index, k);
      if (row >= 0) drives[at(row)] = 1;
    }
  }
  return drives;
}

bool is_rigid(const Row& row) {
  return row.compliance == 0.0 && row.lower == -Row::unbounded && row.upper == Row::unbounded;
}

}  // namespace

Vector3 rotation_vector(const Quaternion& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Vector3 part = sign * rotation.vec();
  const double sine = part.norm();
  if (!(sine > 0.0)) return Vector3::Zero();
  return part * (2.0 * portable::atan2(sine, sign * rotation.w()) / sine);
}

MachinePose::MachinePose(Simulation& simulation, const State& state)
    : simulation_(simulation),
      state_(state),
      freedoms_(simulation.world.bodies().coordinates().count() - 1),
      substep_(simulation.world.bodies(), state, no_time, 1),
      joints_(number_joints(simulation.world.model(), simulation.world.features())) {
  substep_.next = state_;
  substep_.next.time = state_.time + no_time;
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const JointFeature* joints = joints_of(*features[f]);
    drives_.emplace_back();
    if (joints == nullptr) continue;
    features[f]->begin(substep_, state_.features[f]);
    drives_.back() =
        drive_rows(simulation.world.model(), joints_, *joints, features[f]->multipliers().size());
  }
  substep_.time = substep_.next.time;
  substep_.at_rest = true;
}

void MachinePose::place(const VectorX& displacement, double seconds) {
  const BodySet& bodies = substep_.bodies;
  for (int i = 0; i < bodies.count(); ++i) {
    MovingBody& body = substep_.moving[at(i)];
    if (!body.prescribed) continue;
    const BodyState& start = state_.bodies[at(i)];
    body.position = body.start_position + seconds * start.velocity;
    body.rotate_to(seconds * start.angular_velocity);
  }
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    MovingBody& body = substep_.moving[at(freedom.body)];
    const double* motion = displacement.data() + freedom.first - 1;
    const int mount = bodies[freedom.body].mount;
    if (mount >= 0) {
      body.turn = motion[0] * (state_.bodies[at(mount)].orientation * bodies[freedom.body].axis);
      continue;
    }
    body.position = body.start_position + linear_motion(freedom, motion);
    if (body.rotates) body.rotate_to(angular_motion(freedom, body, motion));
  }
  keep_massless_rotors();
  substep_.update_inertias();
}

void MachinePose::keep_massless_rotors() {
  const BodySet& bodies = substep_.bodies;
  for (int i = 0; i < bodies.count(); ++i) {
    const int mount = bodies[i].mount;
    if (mount < 0 || size_of(bodies.coordinates()[i].kind) > 0) continue;
    // The angle relative to the carrier stays: engine/substep.cpp measures it along the present axle.
    const MovingBody& carrier = substep_.moving[at(mount)];
    const Vector3 before = state_.bodies[at(mount)].orientation * bodies[i].axis;
    const Vector3 axle = carrier.orientation * bodies[i].axis;
    substep_.moving[at(i)].turn = before * (axle.dot(carrier.turn) / axle.dot(before));
  }
}

double MachinePose::drift_of(const Row& row) const {
  double drift = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (term.body >= substep_.bodies.count()) continue;
    if (!substep_.moving[at(term.body)].prescribed) continue;
    const BodyState& body = state_.bodies[at(term.body)];
    drift += term.linear.dot(body.velocity) + term.angular.dot(body.angular_velocity);
  }
  return drift;
}

VectorX MachinePose::gradient_of(const Row& row) const {
  VectorX gradient = VectorX::Zero(freedoms_);
  std::array<double, 6> parts{};
  for (const RowTerm& term : row.active_terms()) {
    const BodyFreedom& freedom = substep_.bodies.coordinates()[term.body];
    project(freedom, substep_.moving[at(term.body)], term.linear, term.angular, parts.data());
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      gradient[freedom.first - 1 + k] += parts[at(k)];
    }
  }
  return gradient;
}

JointLocks MachinePose::locks() {
  const auto features = simulation_.world.features();
  std::vector<double> values;
  std::vector<double> drift;
  JointLocks locks;
  locks.gradients = MatrixX::Zero(0, freedoms_);
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (joints_of(*features[f]) == nullptr) continue;
    rows_.clear();
    features[f]->linearise(substep_, rows_);
    locks.gradients.conservativeResize(static_cast<Eigen::Index>(values.size() + rows_.size()),
                                       freedoms_);
    for (const Row& row : rows_) {
      if (!is_rigid(row) || is_drive(f, row.index)) continue;
      const auto place = static_cast<Eigen::Index>(values.size());
      locks.gradients.row(place) = gradient_of(row).transpose();
      values.push_back(row.value);
      drift.push_back(drift_of(row));
    }
  }
  const auto count = static_cast<Eigen::Index>(values.size());
  locks.gradients.conservativeResize(count, freedoms_);
  locks.values = Eigen::Map<const VectorX>(values.data(), count);
  locks.drift = Eigen::Map<const VectorX>(drift.data(), count);
  return locks;
}

PoseMeasure MachinePose::joint_coordinate(int joint, int coordinate) const {
  const JointPlace& place = joints_[at(joint)];
  const auto features = simulation_.world.features();
  std::size_t f = 0;
  while (features[f].get() != place.feature) ++f;
  Row row;
  PoseMeasure measure;
  measure.value =
      place.feature->measure(place.index, coordinate, substep_, state_.features[f], row);
  measure.gradient = gradient_of(row);
  measure.drift = drift_of(row);
  return measure;
}

PoseMeasure MachinePose::body_coordinate(int body, int part) const {
  const BodySet& bodies = substep_.bodies;
  const BodyProperties& own = bodies[body];
  const BodyFreedom& freedom = bodies.coordinates()[body];
  const MovingBody& moving = substep_.moving[at(body)];
  PoseMeasure measure;
  measure.gradient = VectorX::Unit(freedoms_, freedom.first - 1 + part);
  if (own.mount >= 0) {
    const MovingBody& carrier = substep_.moving[at(own.mount)];
    const Vector3 axle = carrier.orientation * own.axis;
    measure.value = state_.bodies[at(body)].angle + axle.dot(moving.turn - carrier.turn);
    std::array<double, 6> parts{};
    const BodyFreedom& under = bodies.coordinates()[own.mount];
    project(under, carrier, Vector3::Zero(), axle, parts.data());
    for (int k = 0; k < size_of(under.kind); ++k) {
      measure.gradient[under.first - 1 + k] -= parts[at(k)];
    }
    if (carrier.prescribed)
      measure.drift = -axle.dot(state_.bodies[at(own.mount)].angular_velocity);
    return measure;
  }
  if (!is_rotation(freedom.kind, part)) {
    const Vector3 along = linear_motion(freedom, VectorX::Unit(6, part).eval().data());
    measure.value = along.dot(moving.position);
  } else if (freedom.kind == Freedom::space) {
    const Quaternion start = bodies.initial_orientation(body);
    measure.value = rotation_vector(moving.orientation * start.conjugate())[part - 3];
  } else {
    measure.value = state_.bodies[at(body)].angle + own.axis.dot(moving.turn);
  }
  return measure;
}

Vector3 MachinePose::turn_to(int body, const Quaternion& orientation) const {
  return rotation_vector(orientation * substep_.moving[at(body)].orientation.conjugate());
}

bool MachinePose::is_broken(int joint) const {
  const JointPlace& place = joints_[at(joint)];
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (features[f].get() == place.feature) {
      return place.feature->is_broken(place.index, state_.features[f]);
    }
  }
  return false;
}

VectorX MachinePose::velocities_of(const State& state) const {
  VectorX velocities = VectorX::Zero(freedoms_);
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const BodyState& body = state.bodies[at(freedom.body)];
    project(freedom, substep_.moving[at(freedom.body)], body.velocity, body.angular_velocity,
            &velocities[freedom.first - 1]);
  }
  return velocities;
}

void MachinePose::set_velocities(const VectorX& velocities, State& state) const {
  const BodySet& bodies = substep_.bodies;
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    const double* motion = velocities.data() + freedom.first - 1;
    BodyState& body = state.bodies[at(freedom.body)];
    body.velocity = linear_motion(freedom, motion);
    body.angular_velocity = angular_motion(freedom, substep_.moving[at(freedom.body)], motion);
  }
  // A mounted rotor has its spin along the axle, and otherwise moves with its carrier.
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& rotor = bodies[i];
    if (rotor.mount < 0) continue;
    const BodyState& carrier = state.bodies[at(rotor.mount)];
    const Vector3 axle = carrier.orientation * rotor.axis;
    BodyState& body = state.bodies[at(i)];
    const double spin = axle.dot(body.angular_velocity);
    body.velocity = carrier.velocity +
                    carrier.angular_velocity.cross(carrier.orientation * rotor.mount_position);
    body.angular_velocity =
        carrier.angular_velocity + (spin - axle.dot(carrier.angular_velocity)) * axle;
  }
}

State MachinePose::state_here() {
  derive_velocities(substep_);
  place_mounted_rotors(substep_);
  State next = substep_.next;
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (joints_of(*features[f]) == nullptr) continue;
    const std::span<double> multipliers = features[f]->multipliers();
    std::fill(multipliers.begin(), multipliers.end(), 0.0);
    features[f]->finish(substep_, next.features[f]);
    // The first numbers are the forces of the last substep (engine/joints/joint_state.h).
    std::copy_n(state_.features[f].reals.begin(), multipliers.size(),
                next.features[f].reals.begin());
  }
  next.time = state_.time;
  for (std::size_t i = 0; i < next.bodies.size(); ++i) {
    const bool moves = size_of(substep_.bodies.coordinates()[static_cast<int>(i)].kind) > 0 ||
                       substep_.bodies[static_cast<int>(i)].mount >= 0;
    if (!moves) {
      next.bodies[i] = state_.bodies[i];
      continue;
    }
    next.bodies[i].velocity.setZero();
    next.bodies[i].angular_velocity.setZero();
  }
  return next;
}

}  // namespace sheave
