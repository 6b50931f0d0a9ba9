#pragma once
// The hold of a joint that was released and has been locked.
//
// A locked joint constrains the degrees of freedom of its type, starting from the poses of its
// bodies at that time. Neither positions nor coordinates jump. The hold changes the
// definition of the joint as little as possible:
//
//   with a common anchor   A's anchor moves to the present place of B's anchor; along the free
//                          directions the distance of the anchors is kept. A's axes become those
//                          of B, turned back by the free angles
//   distance               the length becomes the present distance; for a string or a bumper only
//                          if the joint would pull or push
//   gear, rack             the teeth mesh at the present angles; with backlash only if the play is
//                          exceeded
//
// B's anchor is unchanged. A hold is relative to the definition, so locking twice does not
// accumulate.

#include <cmath>
#include <span>

#include "engine/joints/anchor.h"
#include "engine/joints/joint_terms.h"

namespace sheave {

/// The difference between a locked joint and its definition.
struct JointHold {
  static constexpr std::size_t size = 8;  ///< count of numbers in a state

  Vector3 shift = Vector3::Zero();           ///< displacement of A's anchor, body_a's own frame [m]
  Quaternion turn = Quaternion::Identity();  ///< rotation of A's axes, body_a's own frame
  double offset = 0.0;                       ///< change of a length or a coupling [m or rad]

  [[nodiscard]] static JointHold read(std::span<const double> reals) {
    JointHold hold;
    hold.shift = {reals[0], reals[1], reals[2]};
    hold.turn = Quaternion(reals[3], reals[4], reals[5], reals[6]);
    hold.offset = reals[7];
    return hold;
  }
  void write(std::span<double> reals) const {
    for (int i = 0; i < 3; ++i) reals[static_cast<std::size_t>(i)] = shift[i];
    reals[3] = turn.w();
    reals[4] = turn.x();
    reals[5] = turn.y();
    reals[6] = turn.z();
    reals[7] = offset;
  }
  /// Whether the numbers are valid; for states from files and programs.
  [[nodiscard]] bool is_sound() const {
    constexpr double slop = 1e-6;
    return shift.allFinite() && std::isfinite(offset) && std::abs(turn.norm() - 1.0) < slop;
  }

  /// A's anchor, displaced from `defined` by this hold.
  [[nodiscard]] Anchor applied(const Anchor& defined) const {
    return {defined.body, defined.point + shift, turn * defined.frame};
  }
  /// The hold that moves A's anchor from `defined` to the world point `point` [m] and the world
  /// frame `frame`.
  [[nodiscard]] static JointHold of(const Anchor& defined, const Substep& now, const Vector3& point,
                                    const Quaternion& frame) {
    const Quaternion to_own = now.orientation(defined.body).conjugate();
    JointHold hold;
    hold.shift = rotated(to_own, point - now.position(defined.body)) - defined.point;
    hold.turn = (to_own * frame * defined.frame.conjugate()).normalized();
    return hold;
  }
};

inline void AnchorPair::apply(const JointHold& hold) { a = hold.applied(a); }

/// The value of a coordinate; an angle modulo whole turns.
template <class Kernel>
[[nodiscard]] double coordinate_of(const Kernel& kernel, int index, const Substep& now) {
  Row row;
  JointTerms terms(now, row);
  kernel.coordinate(index, terms);
  return row.value;
}

/// A frame turned by `angle` [rad] about its own axis `axis` (0, 1, 2).
[[nodiscard]] inline Quaternion turned_about(const Quaternion& frame, int axis, double angle) {
  return frame * rotation_by(angle * Vector3::Unit(axis));
}

}  // namespace sheave
