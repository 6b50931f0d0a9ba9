// A force F along the length s of a coupling acts on each coupled coordinate q with F ds/dq: an
// angle gets a torque about its axis, a travel a force along its direction, the opposite of which
// acts on the other body of the joint. F follows from the part that reports tell, that on body_b.

#include "cable/certificate/coupled_joints.h"

#include <cmath>

#include "cable/certificate/joint_frames.h"
#include "engine/joints/coupling.h"
#include "engine/joints/universal.h"

namespace sheave::certify {
namespace {

const CouplingJoint& coupling_of(const JointEvidence& joint) {
  return static_cast<const CouplingJoint&>(*joint.definition);
}

const JointEvidence* evidence_of(const Evidence& evidence, const std::string& name) {
  for (const JointEvidence& other : evidence.joints) {
    if (other.definition->name == name) return &other;
  }
  return nullptr;
}

/// One coupled coordinate, with its argument y in the sum: the angle, or travel / radius.
struct Coupled {
  const JointEvidence* joint = nullptr;
  std::size_t coordinate = 0;
  bool angle = false;
  double argument = 0.0;
  double slope = 0.0;  ///< ds/dq [m/rad or 1]
};

std::vector<Coupled> coupled(const Evidence& evidence, const JointEvidence& joint, End when) {
  const CouplingJoint& own = coupling_of(joint);
  std::vector<Coupled> list;
  for (std::size_t i = 0; i < own.joints.size(); ++i) {
    Coupled one;
    one.joint = evidence_of(evidence, own.joints[i]);
    if (one.joint == nullptr) continue;
    const JointReport& report = when == first_end ? one.joint->start : one.joint->end;
    const std::string wanted = own.joint_coordinates.empty() ? "" : own.joint_coordinates[i];
    while (!wanted.empty() && report.coordinates[one.coordinate].name != wanted) ++one.coordinate;
    const JointCoordinateReport& at = report.coordinates[one.coordinate];
    one.angle = at.angle;
    one.argument = at.angle ? at.value : at.value / own.radius;
    double derivative = own.factors[i];
    if (i + 1 == own.joints.size()) {
      for (std::size_t k = 0; k < own.curve.size(); ++k) {
        const auto power = static_cast<double>(k + 2);
        derivative += own.curve[k] * power * std::pow(one.argument, power - 1.0);
      }
    }
    one.slope = at.angle ? own.radius * derivative : derivative;
    list.push_back(one);
  }
  return list;
}

/// The wrenches of F = 1.
JointPushes unit_pushes(const Evidence& evidence, const JointEvidence& joint, End when) {
  const Moment& now = evidence.moments[at(when)];
  JointPushes result;
  for (const Coupled& one : coupled(evidence, joint, when)) {
    const JointFrame frame = frame_of(evidence.bodies, *one.joint);
    const bool second =
        one.joint->definition->type() == UniversalJoint::type_name && one.coordinate == 1;
    const Vector3 axis = second ? frame.turned_by(now, frame.body_b) * frame.axis_b
                                : frame.turned_a(now) * frame.axis_a;
    const Vector3 effort = one.slope * axis;
    const Vector3 none = Vector3::Zero();
    if (one.angle) {
      result.push_back({frame.body_b, now.center(frame.body_b), none, effort});
      result.push_back({frame.body_a, now.center(frame.body_a), none, -effort});
    } else {
      const Vector3 at_b = frame.anchor_b(now);
      result.push_back({frame.body_b, at_b, effort, none});
      result.push_back({frame.body_a, at_b, -effort, none});
    }
  }
  return result;
}

/// F of the reported wrench, for the wrenches of F = 1.
double force_in(const Evidence& evidence, const JointEvidence& joint, End when,
                const JointPushes& units) {
  const JointReport& report = joint.acting[at(when)];
  const int body = evidence.bodies.index(joint.definition->body_b);
  const Vector3 centre = evidence.moments[at(when)].center(body);
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  for (const JointPush& one : units) {
    if (one.body != body) continue;
    force += one.force;
    torque += one.torque + (one.point - centre).cross(one.force);
  }
  // Lengths and angles weigh alike: both parts have the same factor.
  const double square = force.squaredNorm() + torque.squaredNorm();
  return square > 0.0 ? (force.dot(report.force) + torque.dot(report.torque)) / square : 0.0;
}

}  // namespace

double coupling_force(const Evidence& evidence, const JointEvidence& joint, End when) {
  return force_in(evidence, joint, when, unit_pushes(evidence, joint, when));
}

double coupling_length(const Evidence& evidence, const JointEvidence& joint, End when) {
  const CouplingJoint& own = coupling_of(joint);
  const std::vector<Coupled> list = coupled(evidence, joint, when);
  double sum = 0.0;
  for (std::size_t i = 0; i < list.size(); ++i) sum += own.factors[i] * list[i].argument;
  for (std::size_t k = 0; k < own.curve.size() && !list.empty(); ++k) {
    sum += own.curve[k] * std::pow(list.back().argument, static_cast<double>(k + 2));
  }
  return own.radius * sum;
}

JointPushes coupled_pushes(const Evidence& evidence, const JointEvidence& joint, End when) {
  JointPushes pushes = unit_pushes(evidence, joint, when);
  const double force = force_in(evidence, joint, when, pushes);
  for (JointPush& one : pushes) {
    one.force *= force;
    one.torque *= force;
  }
  return pushes;
}

}  // namespace sheave::certify
