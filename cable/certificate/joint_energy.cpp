// Work of joints that their springs, dampers and friction do not explain.
//
// A lock requires a value C of B relative to A to be 0. Its effort f on B along C is a force, or a
// torque divided by the derivative of C with respect to the angle. The work on the bodies is f .
// dC. A rigid lock should do none. An elastic lock stores C^2 / 2c; by its rule, f = -C / c with C
// at the end (`xpbd`) or the mean of both ends (`rattle`), f . dC is the energy that the spring
// gives, exactly, or less by the dissipation of implicit Euler. The unexplained work is therefore
// (f + C / c) . dC. A stiff spring with a residual gap from unfinished sweeps stores much more
// energy than its force has worked.
//
// Resistance of a ball joint to rotation in excess of its damper is friction, whose work is not
// above 0.

#include "cable/certificate/joint_energy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/certificate/joint_frames.h"
#include "engine/joints/ball.h"

namespace sheave::certify {
namespace {

class JointWorker {
 public:
  JointWorker(const Evidence& evidence, const JointEvidence& joint)
      : e_(evidence), joint_(joint), frame_(frame_of(evidence.bodies, joint)) {}

  JointWork sum() {
    if (frame_.kind.coupling) return work_;
    if (frame_.kind.distance) {
      rod();
      return work_;
    }
    add_flow();
    // Below the gap that the solver takes for closed, changes of the gap are rounding.
    const double gap = 2e-10 * e_.bodies.scale();
    const double size = std::max(e_.size_of(frame_.body_a), e_.size_of(frame_.body_b));
    const double angle = size > 0.0 ? gap / size : 0.0;
    lock(frame_.compliance, gap, [&](End when) { return point(when); });
    if (frame_.kind.parallel) {
      lock(frame_.angular_compliance, angle, [&](End when) { return tilt(when); });
    }
    if (frame_.kind.no_turn) {
      lock(frame_.angular_compliance, angle, [&](End when) { return turn(when); });
    }
    resist();
    return work_;
  }

 private:
  /// Value and effort of a lock at one end of the substep, B relative to A.
  struct Lock {
    Vector3 value = Vector3::Zero();
    Vector3 effort = Vector3::Zero();
  };

  template <class LockAt>
  void lock(double compliance, double gap, const LockAt& lock_at) {
    const Lock first = lock_at(first_end);
    const Lock last = lock_at(last_end);
    const Vector3 opened = last.value - first.value;
    const double work = (first.effort + last.effort).dot(opened);
    if (!(compliance > 0.0)) {
      const bool closed = std::max(first.value.norm(), last.value.norm()) <= gap;
      const double rounding = closed ? gap * (first.effort + last.effort).norm() : 0.0;
      work_.unexplained += std::copysign(std::max(std::abs(work) - rounding, 0.0), work);
      return;
    }
    work_.unexplained += work;
    const Vector3 ruled = e_.rattle ? Vector3(0.5 * (first.value + last.value)) : last.value;
    const double taken = ruled.dot(opened) / compliance;
    work_.unexplained += taken;
    work_.flow = std::max(work_.flow, std::abs(taken));
  }

  /// Work of a distance lock, including its damper. A string is a lock while it has a tension, a
  /// rigid one while it is stretched: a string that becomes taut has stopped its load.
  void rod() {
    const bool any = frame_.lower != 0.0 && frame_.upper != 0.0;
    // Further forces along the extension cannot be separated from that of the rod.
    if (any || coordinates_of(*joint_.definition).front().settings->acts()) return;
    add_flow();
    const bool elastic = frame_.compliance > 0.0;
    const bool one_sided = frame_.lower != 0.0 || frame_.upper != 0.0;
    std::array<double, 2> stretch{};
    std::array<double, 2> open{};  // below 0 if slack
    double push = 0.0;
    for (const End when : {first_end, last_end}) {
      const Moment& now = e_.moments[at(when)];
      const Vector3 apart = frame_.anchor_b(now) - frame_.anchor_a(now);
      double& own = stretch[at(when)];
      own = open[at(when)] = apart.norm() - frame_.length;
      push += joint_.acting[at(when)].force.dot(apart.normalized());
      if (elastic && when == last_end) continue;
      if (frame_.lower != 0.0) own = std::max(own, 0.0);
      if (frame_.upper != 0.0) own = std::min(own, 0.0);
    }
    if (one_sided && push == 0.0) return;
    const bool by_means = elastic && one_sided && e_.rattle;
    const double sign = frame_.lower != 0.0 ? 1.0 : -1.0;
    if (by_means) stretch[last_end] = sign * std::max(sign * open[last_end], 0.0);
    const double acting = stretch[last_end] - stretch[first_end];
    const double opened = by_means ? open[last_end] - open[first_end] : acting;
    work_.unexplained += push * opened;
    if (!elastic) return;
    double ruled = e_.rattle ? 0.5 * (stretch[first_end] + stretch[last_end]) : stretch[last_end];
    if (by_means) ruled = sign * acting_mean(sign * open[first_end], sign * open[last_end]);
    // A damper of `xpbd` sees the motion along the force's direction at the end.
    const bool was_free = one_sided && stretch[first_end] == 0.0;
    const double seen = e_.rattle || was_free ? acting : linear_opening();
    const double taken = (ruled / frame_.compliance + frame_.damping / e_.h * seen) * opened;
    work_.unexplained += taken;
    work_.flow = std::max(work_.flow, std::abs(taken));
  }

  [[nodiscard]] double linear_opening() const {
    const Vector3 at_a = frame_.anchor_a(e_.moments[last_end]);
    const Vector3 at_b = frame_.anchor_b(e_.moments[last_end]);
    return (at_b - at_a)
        .normalized()
        .dot(e_.displacement(frame_.body_b, at_b, last_end) -
             e_.displacement(frame_.body_a, at_a, last_end));
  }

  [[nodiscard]] Vector3 axis_at(End when) const {
    return frame_.turned_a(e_.moments[at(when)]) * frame_.axis_a;
  }

  [[nodiscard]] Lock point(End when) const {
    const Moment& now = e_.moments[at(when)];
    const Vector3 axis = axis_at(when);
    const auto locked = [&](const Vector3& all) -> Vector3 {
      if (frame_.kind.on_axis) return all - axis * axis.dot(all);
      if (frame_.kind.in_plane) return axis * axis.dot(all);
      return all;
    };
    return {locked(frame_.anchor_b(now) - frame_.anchor_a(now)),
            locked(joint_.acting[at(when)].force)};
  }
  /// Value: the sine of the angle between the axes, as a vector.
  [[nodiscard]] Lock tilt(End when) const {
    const Vector3 own = axis_at(when);
    const Vector3 other = frame_.turned_by(e_.moments[at(when)], frame_.body_b) * frame_.axis_b;
    const Vector3 held = without_twist(joint_.acting[at(when)].torque, own, other);
    return {own.cross(other), held / own.dot(other)};
  }
  /// Value: twice the sine of half the rotation angle, as a vector.
  [[nodiscard]] Lock turn(End when) const {
    const Moment& now = e_.moments[at(when)];
    Quaternion off = frame_.turned_by(now, frame_.body_b) * frame_.turned_a(now).conjugate();
    if (off.w() < 0.0) off.coeffs() = -off.coeffs();
    return {2.0 * off.vec(), joint_.acting[at(when)].torque / off.w()};
  }

  /// A joint that stops a body has passed all of its energy.
  void add_flow() {
    for (const End when : {first_end, last_end}) {
      const JointReport& acting = joint_.acting[at(when)];
      double power = 0.0;
      for (const Moment& now : e_.moments) {
        for (const auto& [body, point] : {std::pair{frame_.body_a, frame_.anchor_a(now)},
                                          std::pair{frame_.body_b, frame_.anchor_b(now)}}) {
          if (now.is_world(body)) continue;
          power = std::max(
              power, std::abs(acting.force.dot(now.velocity(body, point))) +
                         std::abs(acting.torque.dot((*now.states)[at(body)].angular_velocity)));
        }
      }
      work_.flow += e_.h * power;
    }
  }

  void resist() {
    const auto* ball = dynamic_cast<const BallJoint*>(joint_.definition);
    if (ball == nullptr || ball->swing_limit || ball->twist.acts()) return;
    const Vector3 turned = turn_of(frame_.body_b) - turn_of(frame_.body_a);
    const Vector3 torque = joint_.acting[first_end].torque + joint_.acting[last_end].torque;
    const Vector3 excess = torque + ball->damping / e_.h * turned;
    work_.unexplained += std::max(excess.dot(turned), 0.0);
  }
  [[nodiscard]] Vector3 turn_of(int body) const {
    return body == e_.bodies.count() ? Vector3(Vector3::Zero()) : e_.turn_of(body);
  }

  const Evidence& e_;
  const JointEvidence& joint_;
  JointFrame frame_;
  JointWork work_;
};

}  // namespace

JointWork work_of(const Evidence& evidence, const JointEvidence& joint) {
  return JointWorker(evidence, joint).sum();
}

}  // namespace sheave::certify
