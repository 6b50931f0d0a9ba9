#include "statics/configuration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/floor_friction.h"
#include "cable/rope_inertia.h"
#include "cable/rope_memories.h"
#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/stages.h"

namespace sheave {
namespace {

/// Rounding of the components of a term: a component that is not larger is none. A joint locks points
/// of a wheel on a fixed axle, for instance, in directions in which they cannot move; the rest of
/// such a row is rounding, which a solver that scales rows would make a row of.
double gradient_rounding(const RowTerm& term, double size) {
  constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
  const double linear = term.linear.norm();
  return rounding * std::max({linear, term.angular.norm(), size * linear});
}

/// Computes the damping of an unknown from the sums over its rows. `h`: length of the substep.
void tell_damping(double h, ForceUnknown& unknown) {
  if (unknown.damper) {
    unknown.damping = h / unknown.compliance;
    unknown.compliance = 0.0;
    return;
  }
  const double square = unknown.compliance * unknown.compliance;
  unknown.damping = square > 0.0 ? unknown.damping / square : 0.0;
}

}  // namespace

double ForceUnknown::largest_friction(const VectorX& forces) const {
  if (!is_pressed()) return upper;
  double pressed = 0.0;
  for (const Pressing& by : pressing) {
    if (by.unknown >= 0) pressed += by.weight * std::abs(forces[by.unknown]);
  }
  return friction * pressed;
}

State remembered_state(const Simulation& simulation) {
  State state = simulation.world.state();
  if (simulation.cables != nullptr) {
    RopeMemories::settle(*simulation.cables, simulation.world.bodies(), simulation.world.state(),
                         state.features.back());
    FloorFriction::settle(*simulation.cables, simulation.world.bodies(), simulation.world.state(),
                          state.features.back());
  }
  return state;
}

Configuration::Configuration(Simulation& simulation, const State& state, double load)
    : simulation_(simulation),
      state_(state),
      load_(load),
      freedoms_(simulation.world.bodies().coordinates().count() - 1),
      substep_(simulation.world.bodies(), state, no_time, 1) {
  find_dampers();
  begin();
}

void Configuration::begin() {
  substep_.h = no_time;
  substep_.next = state_;
  substep_.next.time = state_.time + no_time;
  substep_.restart();
  substep_.gravity *= load_;  // of bodies, and of ropes with weight
  substep_.at_rest = true;
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    features[f]->begin(substep_, state_.features[f]);
  }
  substep_.time = substep_.next.time;
}

void Configuration::find_dampers() {
  // Only a row that resists velocity has a compliance proportional to the length of the substep.
  begin();
  substep_.h = 2.0 * no_time;
  linearise();
  const auto features = simulation_.world.features();
  doubled_.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    doubled_[f].assign(features[f]->multipliers().size(), 0.0);
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      doubled_[f][at(rows_[at(i)].index)] = rows_[at(i)].compliance;
    }
  }
}

bool Configuration::is_damper(std::size_t feature, const Row& row) const {
  constexpr double nearly_twice = 1.9;
  return row.compliance > 0.0 && at(row.index) < doubled_[feature].size() &&
         doubled_[feature][at(row.index)] > nearly_twice * row.compliance;
}

void Configuration::linearise() {
  rows_.clear();
  feature_rows_.clear();
  for (const auto& feature : simulation_.world.features()) {
    feature_rows_.push_back(static_cast<int>(rows_.size()));
    feature->linearise(substep_, rows_);
  }
  feature_rows_.push_back(static_cast<int>(rows_.size()));
}

void Configuration::place(const VectorX& displacement) {
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    MovingBody& body = substep_.moving[at(freedom.body)];
    const double* motion = displacement.data() + freedom.first - 1;
    body.position = body.start_position + linear_motion(freedom, motion);
    if (body.rotates) body.rotate(angular_motion(freedom, body, motion) - body.turn);
  }
}

VectorX Configuration::loads() {
  VectorX sum = VectorX::Zero(freedoms_);
  std::vector<BodyState> poses = state_.bodies;
  for (int i = 0; i < substep_.bodies.count(); ++i) {
    poses[at(i)].position = substep_.position(i);
    poses[at(i)].orientation = substep_.orientation(i);
  }
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const int i = freedom.body;
    const BodyProperties& body = substep_.bodies[i];
    const MovingBody& moving = substep_.moving[at(i)];
    const Vector3 force = body.mass * substep_.gravity + load_ * force_on(substep_, i, poses);
    Vector3 torque = load_ * torque_on(substep_, i, poses);
    if (body.drive == DriveKind::torque) {
      torque += load_ * moving.axis * BodyDrive(body, state_.controls, i).at(state_.time);
    }
    project(freedom, moving, force, torque, &sum[freedom.first - 1]);
  }
  return sum;
}

VectorX Configuration::by_drive(int body) {
  const ConfigurationRows here = rows();
  const Vector3& axis = substep_.bodies[body].axis;
  VectorX change = VectorX::Zero(static_cast<Eigen::Index>(here.unknowns.size()));
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const Row& row = rows_[at(i)];
      for (const RowTerm& term : row.active_terms()) {
        if (term.body == body) change[unknown_at_[f][at(row.index)]] += axis.dot(term.angular);
      }
    }
  }
  return change;
}

void Configuration::set_velocities(const VectorX& rates, State& state) const {
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const double* motion = rates.data() + freedom.first - 1;
    BodyState& body = state.bodies[at(freedom.body)];
    body.velocity = linear_motion(freedom, motion);
    body.angular_velocity = angular_motion(freedom, substep_.moving[at(freedom.body)], motion);
  }
}

VectorX Configuration::along(int body, const Vector3& force, const Vector3& torque) const {
  VectorX parts = VectorX::Zero(freedoms_);
  const BodyFreedom& freedom = substep_.bodies.coordinates()[body];
  if (size_of(freedom.kind) > 0) {
    project(freedom, substep_.moving[at(body)], force, torque, &parts[freedom.first - 1]);
  }
  return parts;
}

ConfigurationRows Configuration::rows() {
  linearise();
  ConfigurationRows result;
  result.loads = loads();
  std::vector<int> unknown_of(rows_.size(), -1);
  const auto features = simulation_.world.features();
  unknown_at_.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    unknown_at_[f].assign(features[f]->multipliers().size(), -1);
  }
  const double per_force = substep_.h * substep_.h;
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const Row& row = rows_[at(i)];
      if (!row.tied) {
        ForceUnknown unknown;
        unknown.feature = f;
        unknown.lower = row.lower / per_force;
        unknown.upper = row.upper / per_force;
        unknown.friction = row.friction;
        const std::array<int, 2> places{row.pressed_by, row.pressed_also};
        for (std::size_t k = 0; k < places.size(); ++k) {
          if (!(row.friction > 0.0) || places[k] == 0) continue;
          const int pressing = i - places[k];
          unknown.pressing[k] = {unknown_of[at(pressing)], rows_[at(pressing)].weight};
        }
        unknown.shares = row.shares;
        unknown.damper = is_damper(f, row);
        result.unknowns.push_back(unknown);
      }
      unknown_of[at(i)] = static_cast<int>(result.unknowns.size()) - 1;
      ForceUnknown& unknown = result.unknowns.back();
      unknown.parts.push_back({row.index, row.weight, row.compliance, row.damping});
      unknown_at_[f][at(row.index)] = unknown_of[at(i)];
      unknown.approximate = unknown.approximate || row.approximate;
      unknown.value += row.value;
      unknown.compliance += row.weight * row.compliance;
      // Each row has its own damper, so for slow motion T (sum of k a) is the sum of the stretches
      // and of k a^2 b T'.
      unknown.damping += row.weight * row.compliance * row.compliance * row.damping;
      result.weighted = result.weighted || row.weight != 1.0;
    }
  }
  project_rows(unknown_of, result);
  for (ForceUnknown& unknown : result.unknowns) tell_damping(substep_.h, unknown);
  return result;
}

void Configuration::project_rows(const std::vector<int>& unknown_of,
                                 ConfigurationRows& result) const {
  const auto count = static_cast<Eigen::Index>(result.unknowns.size());
  result.gradients = MatrixX::Zero(count, freedoms_);
  result.actions = MatrixX::Zero(count, freedoms_);
  std::array<double, 6> parts{};
  const double size = substep_.bodies.scale();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (const RowTerm& term : rows_[i].active_terms()) {
      const BodyFreedom& freedom = substep_.bodies.coordinates()[term.body];
      project(freedom, substep_.moving[at(term.body)], term.linear, term.angular, parts.data());
      const double slop = gradient_rounding(term, size);
      for (int k = 0; k < size_of(freedom.kind); ++k) {
        if (std::abs(parts[at(k)]) <= slop) continue;
        result.gradients(unknown_of[i], freedom.first - 1 + k) += parts[at(k)];
        result.actions(unknown_of[i], freedom.first - 1 + k) += rows_[i].weight * parts[at(k)];
      }
    }
  }
}

Configuration::SingleRows Configuration::single_rows(std::size_t feature) {
  linearise();
  const std::size_t count = simulation_.world.features()[feature]->multipliers().size();
  SingleRows single;
  single.exists.assign(count, 0);
  single.values = single.drift = VectorX::Zero(static_cast<Eigen::Index>(count));
  single.gradients = MatrixX::Zero(static_cast<Eigen::Index>(count), freedoms_);
  std::array<double, 6> parts{};
  for (int i = feature_rows_[feature]; i < feature_rows_[feature + 1]; ++i) {
    const Row& row = rows_[at(i)];
    single.exists[at(row.index)] = 1;
    single.values[row.index] = row.value;
    for (const RowTerm& term : row.active_terms()) {
      const BodyFreedom& freedom = substep_.bodies.coordinates()[term.body];
      if (term.body < substep_.bodies.count() && substep_.moving[at(term.body)].prescribed) {
        const BodyState& body = state_.bodies[at(term.body)];
        single.drift[row.index] +=
            term.linear.dot(body.velocity) + term.angular.dot(body.angular_velocity);
      }
      project(freedom, substep_.moving[at(term.body)], term.linear, term.angular, parts.data());
      for (int k = 0; k < size_of(freedom.kind); ++k) {
        single.gradients(row.index, freedom.first - 1 + k) += parts[at(k)];
      }
    }
  }
  return single;
}

Configuration::Balance Configuration::balance_at(const VectorX& unknowns) {
  linearise();
  Balance balance{loads(), VectorX::Zero(unknowns.size())};
  std::array<double, 6> parts{};
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const Row& row = rows_[at(i)];
      // Rows that did not exist in the pose of rows() have no force.
      const Eigen::Index unknown = unknown_at_[f][at(row.index)];
      if (unknown < 0) continue;
      const double force = row.weight * unknowns[unknown];
      balance.residuals[unknown] += row.value + row.compliance * force;
      if (force == 0.0) continue;
      for (const RowTerm& term : row.active_terms()) {
        const BodyFreedom& freedom = substep_.bodies.coordinates()[term.body];
        project(freedom, substep_.moving[at(term.body)], term.linear, term.angular, parts.data());
        for (int k = 0; k < size_of(freedom.kind); ++k) {
          balance.forces[freedom.first - 1 + k] += force * parts[at(k)];
        }
      }
    }
  }
  return balance;
}

RowForces Configuration::no_forces() const {
  RowForces forces;
  for (const auto& feature : simulation_.world.features()) {
    forces.emplace_back(feature->multipliers().size(), 0.0);
  }
  return forces;
}

VectorX Configuration::unknowns_of(const ConfigurationRows& rows, const RowForces& forces) {
  VectorX unknowns = VectorX::Zero(static_cast<Eigen::Index>(rows.unknowns.size()));
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    double heaviest = 0.0;
    for (const ForceUnknown::Part& part : unknown.parts) {
      if (part.weight <= heaviest || at(part.index) >= forces[unknown.feature].size()) continue;
      heaviest = part.weight;
      unknowns[static_cast<Eigen::Index>(g)] =
          forces[unknown.feature][at(part.index)] / part.weight;
    }
  }
  return unknowns;
}

RowForces Configuration::forces_of(const ConfigurationRows& rows, const VectorX& unknowns) const {
  RowForces forces = no_forces();
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    for (const ForceUnknown::Part& part : unknown.parts) {
      forces[unknown.feature][at(part.index)] =
          part.weight * unknowns[static_cast<Eigen::Index>(g)];
    }
  }
  return forces;
}

void Configuration::assume(const RowForces& forces) const {
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<double> multipliers = features[f]->multipliers();
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      multipliers[i] = forces[f][i] * substep_.h * substep_.h;
    }
  }
}

bool Configuration::revise(const RowForces& forces) {
  assume(forces);
  bool changed = false;
  for (const auto& feature : simulation_.world.features()) {
    changed = feature->revise(substep_) || changed;
  }
  return changed;
}

std::vector<Vector3> Configuration::forces_on_bodies(const RowForces& forces, std::size_t except) {
  linearise();
  std::vector<Vector3> sums(at(substep_.bodies.count() + 1), Vector3::Zero());
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    if (f == except || f >= forces.size()) continue;
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const Row& row = rows_[at(i)];
      if (at(row.index) >= forces[f].size()) continue;
      for (const RowTerm& term : row.active_terms()) {
        sums[at(term.body)] += forces[f][at(row.index)] * term.linear;
      }
    }
  }
  return sums;
}

State Configuration::finish(const RowForces& forces, bool lets_go) {
  substep_.at_rest = !lets_go;
  const auto features = simulation_.world.features();
  assume(forces);
  derive_velocities(substep_);
  place_mounted_rotors(substep_);
  for (std::size_t f = 0; f < features.size(); ++f) {
    features[f]->finish(substep_, substep_.next.features[f]);
  }
  State next = substep_.next;
  next.time = state_.time;
  for (std::size_t i = 0; i < next.bodies.size(); ++i) {
    const Mobility mobility = substep_.bodies[static_cast<int>(i)].mobility;
    if (mobility == Mobility::kinematic || mobility == Mobility::fixed ||
        substep_.bodies[static_cast<int>(i)].prescribed()) {
      next.bodies[i] = state_.bodies[i];
    }
    next.bodies[i].velocity.setZero();
    next.bodies[i].angular_velocity.setZero();
  }
  return next;
}

MatrixX Configuration::mass() const {
  MatrixX mass = MatrixX::Zero(freedoms_, freedoms_);
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const BodyProperties& body = substep_.bodies[freedom.body];
    const int first = freedom.first - 1;
    switch (freedom.kind) {
      case Freedom::none:
        break;
      case Freedom::line:
        mass(first, first) = body.mass;
        break;
      case Freedom::angle:
        mass(first, first) = body.axis_inertia;
        break;
      case Freedom::plane:
        mass(first, first) = mass(first + 1, first + 1) = body.mass;
        mass(first + 2, first + 2) = body.axis_inertia;
        break;
      case Freedom::space:
        mass.block<3, 3>(first, first) = body.mass * Matrix3::Identity();
        mass.block<3, 3>(first + 3, first + 3) =
            world_inertia(body, substep_.moving[at(freedom.body)].orientation, false);
        break;
      case Freedom::turn:
        break;
    }
  }
  add_ropes(mass);
  return mass;
}

VectorX Configuration::along_freedoms(const Row& row) const {
  std::array<double, 6> parts{};
  VectorX gradient = VectorX::Zero(freedoms_);
  for (const RowTerm& term : row.active_terms()) {
    const BodyFreedom& freedom = substep_.bodies.coordinates()[term.body];
    project(freedom, substep_.moving[at(term.body)], term.linear, term.angular, parts.data());
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      gradient[freedom.first - 1 + k] += parts[at(k)];
    }
  }
  return gradient;
}

void Configuration::add_ropes(MatrixX& mass) const {
  for (const auto& feature : simulation_.world.features()) {
    const auto* ropes = dynamic_cast<const RopeInertia*>(feature.get());
    if (ropes == nullptr) continue;
    for (const RopeInertia::Element& element : ropes->elements(substep_, state_.features.back())) {
      const VectorX gradient = along_freedoms(element.row);
      mass += element.mass * gradient * gradient.transpose();
    }
  }
}

void Configuration::set_rope_forces(const VectorX& accelerations, State& state) const {
  const auto features = simulation_.world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const auto* ropes = dynamic_cast<const RopeInertia*>(features[f].get());
    if (ropes == nullptr) continue;
    const auto elements = ropes->elements(substep_, state_.features.back());
    for (std::size_t i = 0; i < elements.size(); ++i) {
      state.features[f].reals[i] =
          -elements[i].mass * along_freedoms(elements[i].row).dot(accelerations);
    }
  }
}

MatrixX Configuration::body_drag() const {
  MatrixX drag = MatrixX::Zero(freedoms_, freedoms_);
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const BodyDef& body = substep_.bodies.definition(freedom.body);
    const int first = freedom.first - 1;
    const int linear = freedom.kind == Freedom::line    ? 1
                       : freedom.kind == Freedom::plane ? 2
                       : freedom.kind == Freedom::space ? 3
                                                        : 0;
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      drag(first + k, first + k) = k < linear ? body.damping : body.angular_damping;
    }
  }
  return drag;
}

Configuration::Reach Configuration::reach(const VectorX& displacement) const {
  Reach reach;
  for (const BodyFreedom& freedom : substep_.bodies.coordinates().movable()) {
    const double* motion = displacement.data() + freedom.first - 1;
    const double turn = angular_motion(freedom, substep_.moving[at(freedom.body)], motion).norm();
    reach.translation = std::max(reach.translation, linear_motion(freedom, motion).norm());
    double& largest = freedom.kind == Freedom::angle ? reach.spin : reach.turn;
    largest = std::max(largest, turn);
  }
  return reach;
}

double Configuration::moved(int body, double arm, const VectorX& displacement) const {
  if (body >= substep_.bodies.count()) return 0.0;
  const int mount = substep_.bodies[body].mount;
  const int carrier = mount >= 0 ? mount : body;
  const BodyFreedom& freedom = substep_.bodies.coordinates()[carrier];
  if (size_of(freedom.kind) == 0 || freedom.kind == Freedom::angle) return 0.0;
  const double* motion = displacement.data() + freedom.first - 1;
  return linear_motion(freedom, motion).norm() +
         arm * angular_motion(freedom, substep_.moving[at(carrier)], motion).norm();
}

}  // namespace sheave
