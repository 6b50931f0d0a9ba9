// A rotor of mass m and angular momentum L moves under the forces F and torques T of cables,
// joints, contacts and loads and under the reactions of its bearings and its drive. The differences
// m (v1 - v0) / h - F and (L1 - L0) / h - T are therefore these reactions: the force and the torque
// perpendicular to the axle belong to the bearings, the torque about the axle to the drive. With
// `rattle` the parts of F and T act at the poses of the start and of the end
// (cable/certificate/evidence.h), so the balance is exact for the two states.

#include "cable/reactions.h"

#include <cmath>
#include <limits>

#include "cable/certificate/evidence.h"
#include "engine/body_drive.h"
#include "engine/body_set.h"

namespace sheave {
namespace {

using certify::End;
using certify::Evidence;
using certify::first_end;
using certify::last_end;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Angular momentum of a rotor about its centre. Its inertia about the axle may differ from that of
/// its shape.
Vector3 spin_momentum(const BodySet& bodies, int rotor, const BodyState& state,
                      const Vector3& axle) {
  const BodyProperties& body = bodies[rotor];
  const Vector3 own = state.orientation.conjugate() * state.angular_velocity;
  const Vector3 all = state.orientation * Vector3(body.inertia * own);
  return all + axle * (body.axis_inertia * axle.dot(state.angular_velocity) - axle.dot(all));
}

}  // namespace

struct Reactions::Content {
  explicit Content(const Simulation& simulation, const LastSubstep& last)
      : evidence(simulation, last) {}

  Evidence evidence;

  [[nodiscard]] Vector3 axle(int rotor, End when) const {
    const BodyProperties& body = evidence.bodies[rotor];
    return body.mount >= 0 ? Vector3(evidence.moments[at(when)].orientation(body.mount) * body.axis)
                           : body.axis;
  }
  /// Force and torque on a rotor about its centre, without those of its bearings and its drive.
  struct Applied {
    Vector3 force = Vector3::Zero();
    Vector3 torque = Vector3::Zero();
    bool known = true;
  };
  [[nodiscard]] Applied applied(int rotor) const {
    const certify::Balance& balance = evidence.balances[at(rotor)];
    const BodyDef& definition = evidence.bodies.definition(rotor);
    Applied all{definition.force, definition.torque, !balance.unknown};
    const ForceControl* set = evidence.start.controls.forces.find(rotor);
    for (const End when : {first_end, last_end}) {
      if (set != nullptr) {
        // Like loads: `rattle` applies half of them at the poses of the end.
        const Quaternion q =
            evidence.moments[at(evidence.rattle ? when : first_end)].orientation(rotor);
        all.force += 0.5 * set->force_in_world(q);
        all.torque += 0.5 * set->torque_in_world(q);
      }
      all.force += balance.own_force[at(when)];
      all.torque += balance.own_torque[at(when)];
    }
    return all;
  }
  /// (L1 - L0) / h.
  [[nodiscard]] Vector3 momentum_rate(int rotor) const {
    const BodyState& from = evidence.start.bodies[at(rotor)];
    const BodyState& to = evidence.end.bodies[at(rotor)];
    return (spin_momentum(evidence.bodies, rotor, to, axle(rotor, last_end)) -
            spin_momentum(evidence.bodies, rotor, from, axle(rotor, first_end))) /
           evidence.h;
  }
  /// Mean rate of rotation relative to its mount [rad/s].
  [[nodiscard]] double turning(int rotor) const {
    return (evidence.end.bodies[at(rotor)].angle - evidence.start.bodies[at(rotor)].angle) /
           evidence.h;
  }
  [[nodiscard]] double mounted_torque(int rotor) const {
    for (const certify::MountedDriveEvidence& drive : evidence.mounted_drives) {
      if (drive.rotor == rotor) return drive.torque[first_end] + drive.torque[last_end];
    }
    return 0.0;
  }
  /// Torque of a drive that prescribes the rotor's motion [N m].
  [[nodiscard]] double holding_torque(int rotor) const {
    const BodyProperties& body = evidence.bodies[rotor];
    const Applied others = applied(rotor);
    if (!others.known) return unknown;
    const double change = evidence.end.bodies[at(rotor)].angular_velocity.dot(body.axis) -
                          evidence.start.bodies[at(rotor)].angular_velocity.dot(body.axis);
    return body.axis_inertia * change / evidence.h +
           evidence.bodies.definition(rotor).angular_damping * turning(rotor) -
           body.axis.dot(others.torque);
  }
};

Reactions::Reactions(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Reactions::~Reactions() = default;
Reactions::Reactions(Reactions&&) noexcept = default;
Reactions& Reactions::operator=(Reactions&&) noexcept = default;

std::optional<Reactions> Reactions::of(const Simulation& simulation) {
  const std::optional<LastSubstep> last = simulation.world.last_substep();
  if (!last) return std::nullopt;
  return Reactions(std::make_unique<Content>(simulation, *last));
}

BearingReaction Reactions::bearing(int body) const {
  const Evidence& e = content_->evidence;
  const BodyProperties& rotor = e.bodies[body];
  const Content::Applied others = content_->applied(body);
  if (!others.known) return {Vector3::Constant(unknown), Vector3::Constant(unknown)};
  const Vector3 change = e.end.bodies[at(body)].velocity - e.start.bodies[at(body)].velocity;
  BearingReaction reaction;
  reaction.force = rotor.mass * (change / e.h - e.gravity) - others.force;
  const Vector3 torque = content_->momentum_rate(body) - others.torque;
  // The component about the axle belongs to the drive and to drag.
  const Vector3 axle =
      (content_->axle(body, first_end) + content_->axle(body, last_end)).normalized();
  reaction.torque = torque - axle * axle.dot(torque);
  return reaction;
}

DriveReaction Reactions::drive(int body) const {
  const Evidence& e = content_->evidence;
  const BodyProperties& rotor = e.bodies[body];
  const bool mounted = rotor.mount >= 0;
  const DriveKind kind = rotor.driven_by();
  const BodyDrive drive(rotor, e.start.controls, body);
  const BodyState& state = e.end.bodies[at(body)];
  const double now = e.end.time;
  DriveReaction reaction;
  if (mounted) {
    reaction.torque = content_->mounted_torque(body);
  } else if (kind == DriveKind::torque) {
    reaction.torque = drive.integral(e.start.time, now) / (now - e.start.time);
  } else {
    reaction.torque = content_->holding_torque(body);
  }
  reaction.power = reaction.torque * content_->turning(body);
  if (kind == DriveKind::angle) {
    // A control sets the body's angle; a table sets only the change of the angle since time 0.
    const bool set = e.start.controls.body_drives.find(body) != nullptr;
    const double start = set || mounted ? 0.0 : rotor.drive_table.at(0.0);
    reaction.error = state.angle - (drive.at(now) - start);
  } else if (kind == DriveKind::speed) {
    const Vector3 spin =
        mounted ? Vector3(state.angular_velocity - e.end.bodies[at(rotor.mount)].angular_velocity)
                : state.angular_velocity;
    reaction.error = content_->axle(body, last_end).dot(spin) - drive.at(now);
  }
  return reaction;
}

double Reactions::drive_power(int joint, int coordinate) const {
  const Evidence& e = content_->evidence;
  const certify::JointEvidence& found = e.joints[at(joint)];
  if (found.broken) return 0.0;
  const JointCoordinateReport& now = found.end.coordinates[at(coordinate)];
  return now.drive_force * (now.value - found.start.coordinates[at(coordinate)].value) / e.h;
}

double Reactions::drive_power() const {
  const Evidence& e = content_->evidence;
  double sum = 0.0;
  for (int i = 0; i < e.bodies.count(); ++i) {
    if (e.bodies.definition(i).drive != DriveKind::none) sum += drive(i).power;
  }
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    for (std::size_t k = 0; k < e.joints[j].end.coordinates.size(); ++k) {
      sum += drive_power(static_cast<int>(j), static_cast<int>(k));
    }
  }
  return sum;
}

double Reactions::joint_friction(int joint) const {
  const Evidence& e = content_->evidence;
  const certify::JointEvidence& found = e.joints[at(joint)];
  if (found.broken) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < found.end.coordinates.size(); ++k) {
    const JointCoordinateReport& now = found.end.coordinates[k];
    sum -= now.friction_force * (now.value - found.start.coordinates[k].value) / e.h;
  }
  return sum;
}

namespace {

/// Power that a bearing dissipates [W].
double loss_of(const Evidence& e, const certify::BearingEvidence& bearing) {
  return -(bearing.torque[0] + bearing.torque[1]) * bearing.turn / e.h;
}

}  // namespace

double Reactions::link_friction(int cable, int link) const {
  const Evidence& e = content_->evidence;
  const certify::CableEvidence& found = e.cables[at(cable)];
  double sum = 0.0;
  for (const certify::BearingEvidence& bearing : e.bearings) {
    if (bearing.cable == found.name && bearing.link == link) sum += loss_of(e, bearing);
  }
  for (const certify::PassEvidence& pass : found.passes) {
    if (pass.link != link) continue;
    // Friction opposes the sliding, so the incoming tension is the smaller one.
    sum += pass.travel / e.h *
           (found.spans[at(pass.after)].tension() - found.spans[at(pass.before)].tension());
  }
  return sum;
}

double Reactions::friction() const {
  const Evidence& e = content_->evidence;
  double sum = 0.0;
  for (std::size_t j = 0; j < e.joints.size(); ++j) sum += joint_friction(static_cast<int>(j));
  for (const certify::CableEvidence& cable : e.cables) {
    for (const certify::PassEvidence& pass : cable.passes) {
      sum += pass.travel / e.h *
             (cable.spans[at(pass.after)].tension() - cable.spans[at(pass.before)].tension());
    }
  }
  for (const certify::BearingEvidence& bearing : e.bearings) sum += loss_of(e, bearing);
  for (const certify::ContactEvidence& contact : e.contacts) {
    for (const End when : {first_end, last_end}) {
      const Vector3 way = e.displacement(contact.body_a, contact.point_a[at(when)], when) -
                          e.displacement(contact.body_b, contact.point_b[at(when)], when);
      sum -= contact.drag[at(when)].dot(way) / e.h;
    }
  }
  return sum;
}

Momentum momentum(const World& world, int body) {
  const BodySet& bodies = world.bodies();
  const BodyProperties& properties = bodies[body];
  const BodyState& state = world.state().bodies[at(body)];
  Momentum result;
  switch (properties.mobility) {
    case Mobility::fixed:
    case Mobility::kinematic:
    case Mobility::knot:
      return result;
    case Mobility::rotor: {
      const Vector3 axle =
          properties.mount >= 0
              ? Vector3(world.state().bodies[at(properties.mount)].orientation * properties.axis)
              : properties.axis;
      result.angular = properties.axis_inertia * axle.dot(state.angular_velocity) * axle;
      return result;
    }
    case Mobility::free:
    case Mobility::planar:
    case Mobility::slider:
      break;
  }
  result.linear = properties.mass * state.velocity;
  const Vector3 own = state.orientation.conjugate() * state.angular_velocity;
  result.angular = state.orientation * Vector3(properties.inertia * own);
  return result;
}

Momentum momentum(const World& world) {
  Momentum sum;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const Momentum one = momentum(world, i);
    sum.linear += one.linear;
    sum.angular += one.angular + world.state().bodies[at(i)].position.cross(one.linear);
  }
  return sum;
}

}  // namespace sheave
