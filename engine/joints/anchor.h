#pragma once

#include <array>
#include <span>

#include "engine/joint.h"
#include "engine/substep.h"

namespace sheave {

struct JointHold;

/// A point of a body and a frame fixed to it, in the body's own frame.
struct Anchor {
  int body = 0;
  Vector3 point = Vector3::Zero();            ///< [m]
  Quaternion frame = Quaternion::Identity();  ///< joint frame to own frame
  /// Whether one anchor's body carries the body of the other anchor, or both bodies are rotors on
  /// one carrier.
  bool shares_carrier = false;

  /// The anchor at the world point `world_point` [m] with the joint frame `world_frame`, both given
  /// for the poses of the bodies when `joint` is defined.
  [[nodiscard]] static Anchor at_start(const BodySet& bodies, const JointDef& joint, BodyId body,
                                       const Vector3& world_point,
                                       const Quaternion& world_frame = Quaternion::Identity()) {
    const int index = bodies.index(body);
    const BodyFrame frame = bodies.frame(index, joint.defined_in);
    const Quaternion to_own = frame.orientation.conjugate();
    return {index, to_own * (world_point - frame.position) - bodies[index].center_of_mass,
            to_own * world_frame};
  }
  [[nodiscard]] Vector3 position(const Substep& substep) const {
    return substep.point(body, point);
  }
  [[nodiscard]] Quaternion orientation(const Substep& substep) const {
    return substep.orientation(body) * frame;
  }
};

/// A frame whose z axis has the direction of `axis`.
[[nodiscard]] Quaternion frame_along(const Vector3& axis);

/// The two anchors of a joint, which coincide in point and frame when the joint is defined.
struct AnchorPair {
  Anchor a;
  Anchor b;

  [[nodiscard]] static AnchorPair at_start(const BodySet& bodies, const JointDef& joint,
                                           BodyId body_a, BodyId body_b, const Vector3& world_point,
                                           const Quaternion& frame = Quaternion::Identity()) {
    AnchorPair pair{Anchor::at_start(bodies, joint, body_a, world_point, frame),
                    Anchor::at_start(bodies, joint, body_b, world_point, frame)};
    const auto carrier = [&](int body) {
      return bodies[body].mount >= 0 ? bodies[body].mount : body;
    };
    pair.a.shares_carrier = pair.b.shares_carrier = carrier(pair.a.body) == carrier(pair.b.body);
    return pair;
  }
  /// Moves A's anchor from its definition to that of a locked joint (engine/joints/joint_hold.h).
  void apply(const JointHold& hold);
  [[nodiscard]] int anchor_body() const { return b.body; }
  [[nodiscard]] Vector3 anchor(const Substep& substep) const { return b.position(substep); }
};

/// The anchors of a joint whose first locks make them coincide.
struct MeetingAnchors : AnchorPair {
  /// Unit vectors, world frame: the directions of these locks.
  std::array<Vector3, 3> directions{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  /// Number of locks with such directions; 0: the locks have directions of a body.
  int direction_count = 0;

  [[nodiscard]] static MeetingAnchors at_start(const BodySet& bodies, const JointDef& joint,
                                               BodyId body_a, BodyId body_b,
                                               const Vector3& world_point,
                                               const Quaternion& frame = Quaternion::Identity()) {
    MeetingAnchors anchors;
    static_cast<AnchorPair&>(anchors) =
        AnchorPair::at_start(bodies, joint, body_a, body_b, world_point, frame);
    anchors.direction_count = anchors.a.shares_carrier ? 0 : 3;
    return anchors;
  }
  [[nodiscard]] std::span<const Vector3> meets_along() const {
    return {directions.data(), static_cast<std::size_t>(direction_count)};
  }
};

}  // namespace sheave
