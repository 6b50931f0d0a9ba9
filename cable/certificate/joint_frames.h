#pragma once
// Anchors and axes of a joint, from its definition and the poses alone.

#include "cable/certificate/evidence.h"
#include "engine/joints/coordinate.h"

namespace sheave::certify {

/// The relative motions that a joint locks.
struct JointKind {
  bool meets = false;        ///< the anchors coincide
  bool on_axis = false;      ///< B's anchor stays on A's axis
  bool in_plane = false;     ///< B's anchor stays in A's plane, whose normal is the axis
  bool parallel = false;     ///< the axes stay parallel
  bool no_turn = false;      ///< no relative rotation
  bool right_angle = false;  ///< axis of A and second axis of B stay perpendicular
  bool distance = false;
  bool coupling = false;   ///< gear, rack or coupling of joints
  bool of_joints = false;  ///< coupling of joints
};

struct JointFrame {
  JointKind kind;
  int body_a = 0;
  int body_b = 0;
  int carrier = -1;
  Vector3 own_anchor_a = Vector3::Zero();  ///< own frames
  Vector3 own_anchor_b = Vector3::Zero();
  /// world frame at definition; for a gear the axis of body_a's rotation
  Vector3 axis_a = Vector3::UnitZ();
  Vector3 axis_b = Vector3::UnitZ();
  double compliance = 0.0;
  double angular_compliance = 0.0;
  double ratio = 0.0;  ///< of couplings
  double length = 0.0;
  double mesh = 0.0;   ///< for couplings: offset of the meshing teeth [m or rad]
  double lower = 0.0;  ///< bounds of distance minus length [m], 0 or -infinity
  double upper = 0.0;
  double damping = 0.0;

  BodyFrames defined_in;  ///< of the joint
  /// For a joint that was locked again: rotation of its axes on body_a relative to those of its
  /// definition, own frame.
  Quaternion relocked = Quaternion::Identity();

  /// Rotation of a body since the joint was defined.
  [[nodiscard]] Quaternion turned_by(const Moment& now, int body) const {
    return now.orientation(body) * now.bodies->frame(body, defined_in).orientation.conjugate();
  }
  /// Rotation of the joint's frame on body_a since then.
  [[nodiscard]] Quaternion turned_a(const Moment& now) const {
    return now.orientation(body_a) * relocked *
           now.bodies->frame(body_a, defined_in).orientation.conjugate();
  }
  [[nodiscard]] Vector3 anchor_a(const Moment& now) const {
    return now.point(body_a, own_anchor_a);
  }
  [[nodiscard]] Vector3 anchor_b(const Moment& now) const {
    return now.point(body_b, own_anchor_b);
  }
};

[[nodiscard]] JointFrame frame_of(const BodySet& bodies, const JointEvidence& joint);

/// A coordinate of a joint, in the order of the reports.
struct CoordinateSettings {
  const JointCoordinate* settings = nullptr;
  /// The component of the reported wrench that acts along the coordinate: 0 none, 1 the force along
  /// the axis, 2 the torque about the axis, 3 the force along the line between the anchors, 4 the
  /// force of a coupling of joints.
  int along = 0;
};
[[nodiscard]] std::vector<CoordinateSettings> coordinates_of(const JointDef& joint);

/// The part of a torque that holds the axis u of A and the axis w of B together; it is
/// perpendicular to u. The remaining part acts along the angle about the axes, the twist of B
/// against A in excess of the smallest rotation from u to w: a torque along (u + w) / (1 + u . w),
/// the gradient of that angle.
[[nodiscard]] inline Vector3 without_twist(const Vector3& torque, const Vector3& u,
                                           const Vector3& w) {
  const double mean = 1.0 + u.dot(w);
  return torque - u.dot(torque) * (mean > 1e-6 ? Vector3((u + w) / mean) : u);
}

}  // namespace sheave::certify
