// Mass, forces and motions in the coordinates of joints.

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/joint_feature.h"
#include "engine/number_text.h"
#include "statics/decompositions.h"
#include "statics/difference.h"
#include "statics/joint_space_content.h"

namespace sheave {

JointSpace::Content::Content(Simulation& own)
    : simulation(own),
      state(own.world.state()),
      pose(own, state),
      mass(Configuration(own, state, 1.0).mass()),
      coordinates(independent_coordinates(pose, all_coordinates(own.world, pose), 0)),
      basis(basis_of(pose, coordinates)) {
  rates = basis.gradients * pose.velocities_of(state) + basis.turning;
  velocities = basis.motions * rates + basis.drift;
}

VectorX JointSpace::Content::acceleration_by_turning() {
  const int freedoms = pose.freedoms();
  double fastest = 0.0;
  for (int i = 0; i < pose.substep().bodies.count(); ++i) {
    const BodyState& body = state.bodies[at(i)];
    const bool moves = pose.substep().moving[at(i)].prescribed;
    if (moves) fastest = std::max(fastest, body.angular_velocity.norm());
  }
  const auto levers = pose.substep().bodies.coordinates().levers();
  for (Eigen::Index k = 0; k < freedoms; ++k) {
    const double lever = levers[static_cast<std::size_t>(k + 1)];
    fastest = std::max(fastest, std::abs(velocities[k]) / lever);
  }
  if (!(fastest > 0.0)) return VectorX::Zero(freedoms);
  // No rotation is longer than this [rad]; the error of the difference is of its fourth power.
  constexpr double longest = 1e-3;
  const double time = longest / fastest;
  const auto moved = [&](double seconds) {
    pose.place(seconds * velocities, seconds);
    const CoordinateBasis there = basis_of(pose, coordinates);
    return VectorX(there.motions * rates + there.drift);
  };
  const VectorX near = change_across(moved, time);
  const VectorX far = change_across(moved, 2.0 * time);
  pose.place(VectorX::Zero(freedoms), 0.0);
  return (8.0 * near - far) / (12.0 * time);
}

VectorX JointSpace::Content::gyroscopic_torques() const {
  VectorX torques = VectorX::Zero(pose.freedoms());
  const Substep& substep = pose.substep();
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    if (freedom.kind != Freedom::space) continue;
    const BodyProperties& body = substep.bodies[freedom.body];
    const Quaternion& orientation = substep.moving[at(freedom.body)].orientation;
    const Vector3 turning = velocities.segment<3>(freedom.first - 1 + 3);
    Vector3 momentum = times_inertia(body, orientation, false, turning);
    for (const int i : body.mounted_rotors) {
      const BodyProperties& rotor = substep.bodies[i];
      const Vector3 axle = orientation * rotor.axis;
      const BodyFreedom& own = substep.bodies.coordinates()[i];
      if (size_of(own.kind) == 0) continue;
      momentum += rotor.axis_inertia * velocities[own.first - 1] * axle;
    }
    torques.segment<3>(freedom.first - 1 + 3) = turning.cross(momentum);
  }
  return torques;
}

VectorX JointSpace::Content::set_forces() const {
  const Substep& substep = pose.substep();
  VectorX forces = VectorX::Zero(pose.freedoms());
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    project(freedom, substep.moving[at(freedom.body)],
            force_on(substep, freedom.body, state.bodies),
            torque_on(substep, freedom.body, state.bodies), &forces[freedom.first - 1]);
  }
  return forces;
}

VectorX JointSpace::Content::joint_forces(Configuration& configuration) const {
  const ConfigurationRows rows = configuration.rows();
  std::vector<VectorX> drifts(simulation.world.features().size());
  const auto features = simulation.world.features();
  VectorX forces = VectorX::Zero(pose.freedoms());
  for (std::size_t g = 0; g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    const std::size_t f = unknown.feature;
    const int multiplier = unknown.parts.front().index;
    if (dynamic_cast<const JointFeature*>(features[f].get()) == nullptr) continue;
    if (pose.is_drive(f, multiplier)) continue;
    if (drifts[f].size() == 0) drifts[f] = configuration.single_rows(f).drift;
    const auto i = static_cast<Eigen::Index>(g);
    const double rate = rows.gradients.row(i).dot(velocities) + drifts[f][multiplier];
    double force = 0.0;
    if (unknown.damper) {
      force = -unknown.damping * rate;
    } else if (unknown.compliance > 0.0 && !unknown.given()) {
      force = std::clamp(-unknown.value / unknown.compliance, unknown.lower, unknown.upper);
      if (unknown.lower < force && force < unknown.upper) force -= unknown.damping * rate;
    }
    forces += force * rows.actions.row(i).transpose();
  }
  return forces;
}

VectorX JointSpace::Content::gravity() const {
  const Substep& substep = pose.substep();
  VectorX forces = VectorX::Zero(pose.freedoms());
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    project(freedom, substep.moving[at(freedom.body)],
            substep.bodies[freedom.body].mass * substep.gravity, Vector3::Zero(),
            &forces[freedom.first - 1]);
  }
  return forces;
}

std::string JointSpace::Content::fault_of(const ModalVector& values,
                                          const std::string& name) const {
  if (values.size() != count()) {
    return name + ": must be " + std::to_string(count()) + " numbers, one per coordinate, not " +
           std::to_string(values.size());
  }
  return values.allFinite() ? "" : name + ": must be finite numbers";
}

JointSpace::JointSpace(std::unique_ptr<Content> content) : content_(std::move(content)) {}
JointSpace::~JointSpace() = default;
JointSpace::JointSpace(JointSpace&&) noexcept = default;
JointSpace& JointSpace::operator=(JointSpace&&) noexcept = default;

Result<JointSpace> JointSpace::create(Simulation& simulation) {
  const int freedoms = simulation.world.bodies().coordinates().count() - 1;
  if (freedoms > most_freedoms) {
    return Error{"", "the bodies have " + std::to_string(freedoms) +
                         " degrees of freedom; coordinates of joints are for at most " +
                         std::to_string(most_freedoms)};
  }
  if (simulation.cable_definitions) {
    for (const CableDef& cable : *simulation.cable_definitions) {
      if (!cable.axial_inertia) continue;
      return Error{"", "the rope \"" + cable.name +
                           "\" has inertia, which coordinates of joints leave out; leave its "
                           "\"axial_inertia\" out"};
    }
  }
  const BodySet& bodies = simulation.world.bodies();
  for (int i = 0; i < bodies.count(); ++i) {
    if (bodies[i].mobility != Mobility::knot) continue;
    return Error{"", "the place of the knot \"" + bodies.name(i) +
                         "\" follows from forces, which coordinates of joints leave out; give the "
                         "knot mobility \"free\" and a mass of some grams"};
  }
  return JointSpace(std::make_unique<Content>(simulation));
}

const std::vector<MachineCoordinate>& JointSpace::coordinates() const {
  return content_->coordinates;
}

ModalVector JointSpace::positions() const {
  ModalVector values(content_->count());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = measure(content_->pose, content_->coordinates[static_cast<std::size_t>(i)]).value;
  }
  return values;
}

ModalVector JointSpace::rates() const { return content_->rates; }

ModalMatrix JointSpace::mass_matrix() const {
  const MatrixX& motions = content_->basis.motions;
  const MatrixX mass = motions.transpose() * content_->mass * motions;
  return 0.5 * (mass + mass.transpose());
}

ModalVector JointSpace::bias_forces() {
  const VectorX turning = content_->acceleration_by_turning();
  return content_->basis.motions.transpose() *
         (content_->mass * turning + content_->gyroscopic_torques() - content_->gravity());
}

ModalVector JointSpace::passive_forces() {
  Configuration configuration(content_->simulation, content_->state, 1.0);
  const VectorX drag = configuration.body_drag() * content_->velocities;
  return content_->basis.motions.transpose() *
         (content_->set_forces() - drag + content_->joint_forces(configuration));
}

Result<ModalVector> JointSpace::inverse_dynamics(const ModalVector& accelerations) {
  std::string fault = content_->fault_of(accelerations, "accelerations");
  if (!fault.empty()) return Error{"", std::move(fault)};
  return ModalVector(mass_matrix() * accelerations + bias_forces() - passive_forces());
}

Result<ModalVector> JointSpace::forward_dynamics(const ModalVector& forces) {
  std::string fault = content_->fault_of(forces, "forces");
  if (!fault.empty()) return Error{"", std::move(fault)};
  if (forces.size() == 0) return forces;
  const std::optional<VectorX> accelerations =
      positive_solution(mass_matrix(), forces - bias_forces() + passive_forces());
  if (!accelerations) {
    return Error{"",
                 "a coordinate moves without inertia, so forces along it have no acceleration; "
                 "give the bodies that it moves a mass and moments of inertia"};
  }
  return ModalVector(*accelerations);
}

ModalMatrix JointSpace::along_coordinates(const ModalMatrix& displacements) const {
  return content_->basis.gradients * displacements;
}

PointJacobian JointSpace::jacobian(BodyId body, const Vector3& local) const {
  const Eigen::Index n = content_->count();
  PointJacobian jacobian{ModalMatrix::Zero(3, n), ModalMatrix::Zero(3, n)};
  if (body.is_world()) return jacobian;
  const Substep& substep = content_->pose.substep();
  const int mount = substep.bodies[body.index].mount;
  const int carrier = mount >= 0 ? mount : body.index;
  const Vector3 arm =
      content_->simulation.world.point(body, local) - substep.moving[at(carrier)].position;
  const Vector3 in_rotor =
      content_->simulation.world.point(body, local) - substep.position(body.index);
  const auto& coordinates = substep.bodies.coordinates();
  for (Eigen::Index i = 0; i < n; ++i) {
    const VectorX motion = content_->basis.motions.col(i);
    const auto part = [&](int one) {
      const BodyFreedom& freedom = coordinates[one];
      return size_of(freedom.kind) > 0 ? motion.data() + freedom.first - 1 : nullptr;
    };
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
    if (const double* own = part(carrier)) {
      linear = linear_motion(coordinates[carrier], own);
      angular = angular_motion(coordinates[carrier], substep.moving[at(carrier)], own);
      linear += angular.cross(arm);
    }
    if (mount >= 0) {
      // The rotor turns about its axle relative to its carrier.
      const Vector3 axle = substep.moving[at(mount)].orientation * substep.bodies[body.index].axis;
      const double* own = part(body.index);
      const double spin = (own != nullptr ? own[0] : 0.0) - axle.dot(angular);
      linear += spin * axle.cross(in_rotor);
      angular += spin * axle;
    }
    jacobian.linear.col(i) = linear;
    jacobian.angular.col(i) = angular;
  }
  return jacobian;
}

}  // namespace sheave
