#pragma once
// What a joint that was released and has been locked again holds.
//
// It holds what its type holds, from where its bodies are then: nothing jumps, and its coordinates
// read what they read before. What is defined is changed by as little as that needs:
//
//   with a common anchor   A's anchor is where B's is now (in what the joint leaves free it keeps its distance), and A's axes are
//                          those of B, turned back by the angles that are left free
//   distance               the length is what the distance is now; of a string or a bumper only if it would pull or push
//   gear, rack             the teeth mesh where they are now; with backlash only if they are out of play
//
// B keeps its anchor. All of it counts from the definition, so that locking twice does not add up.

#include <cmath>
#include <span>

#include "engine/joints/anchor.h"
#include "engine/joints/joint_terms.h"

namespace sheave {

/// By how much that differs from the definition.
struct JointHold {
  static constexpr std::size_t size = 8;  ///< numbers in a state

  Vector3 shift = Vector3::Zero();           ///< of A's anchor, body_a's own frame [m]
  Quaternion turn = Quaternion::Identity();  ///< of A's axes, body_a's own frame
  double offset = 0.0;                       ///< of a length or a coupling [m or rad]

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
  /// Whether it can be one: for states from elsewhere.
  [[nodiscard]] bool is_sound() const {
    constexpr double slop = 1e-6;
    return shift.allFinite() && std::isfinite(offset) && std::abs(turn.norm() - 1.0) < slop;
  }

  /// A's anchor of `defined` with it.
  [[nodiscard]] Anchor applied(const Anchor& defined) const {
    return {defined.body, defined.point + shift, turn * defined.frame};
  }
  /// What brings A's anchor from `defined` to the world point `point` [m] and the world frame
  /// `frame`.
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

/// What a coordinate reads, an angle up to whole turns.
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
