#pragma once

#include <algorithm>
#include <span>

#include "engine/substep.h"
#include "engine/wrench.h"

namespace sheave {

/// Makes those parts of the gradient 0 that are but rounding to the body's mobility: a row across
/// the axis of a slider has 1e-17 along it, which would be enough for the row to hold the body.
inline void drop_rounding(Row& row, std::span<const MovingBody> bodies) {
  const auto keep = [](const Matrix3& inverse, Vector3& gradient) {
    constexpr double rounding = 1e-12;
    const double trace = inverse(0, 0) + inverse(1, 1) + inverse(2, 2);
    const double full = trace * trace * dot(gradient, gradient);
    // What nothing can move may yet move by itself: velocities of driven bodies count in those of
    // rows.
    if (!(full > 0.0)) return;
    const Vector3 moved = times(inverse, gradient);
    if (dot(moved, moved) <= rounding * rounding * full) gradient.setZero();
  };
  for (RowTerm& term : std::span(row.terms).first(static_cast<std::size_t>(row.term_count))) {
    const MovingBody& body = bodies[static_cast<std::size_t>(term.body)];
    keep(body.inverse_mass, term.linear);
    keep(body.inverse_inertia, term.angular);
  }
}

/// Takes what a unit multiplier of a joint's row does to the bodies: as the gradient of the row,
/// and, if asked, as the wrench on one of them.
class JointTerms {
 public:
  /// `has_rotor`: whether one of the bodies is a rotor on another body.
  JointTerms(const Substep& substep, Row& row, bool has_rotor = false)
      : substep_(substep), row_(row), has_rotor_(has_rotor) {}
  /// Adds what acts on `body`, times `scale`, to `wrench` instead of the row.
  JointTerms(const Substep& substep, Row& row, int body, double scale, Wrench& wrench)
      : substep_(substep), row_(row), watched_(body), scale_(scale), wrench_(&wrench) {}

  [[nodiscard]] const Substep& substep() const { return substep_; }
  void set_value(double value) { row_.value = value; }
  void set_compliance(double compliance) { row_.compliance = compliance; }
  void set_damping(double damping) { row_.damping = damping; }
  void set_bounds(double lower, double upper) {
    row_.lower = lower;
    row_.upper = upper;
  }

  /// A force along `direction` at the world point `at`.
  void add_force(int body, const Vector3& at, const Vector3& direction) {
    if (wrench_ == nullptr) {
      // The world never moves and would only take up room in the row.
      if (body >= substep_.bodies.count()) return;
      const int terms = row_.term_count;
      substep_.add_force(row_, body, at, direction);
      row_.curved = true;
      if (has_rotor_ && shares_carrier(body, terms))
        drop_cancelled(body, reach(body, at) * direction.norm());
    } else if (body == watched_) {
      wrench_->force += scale_ * direction;
      wrench_->torque += scale_ * cross(at - wrench_->about, direction);
    }
  }
  void add_torque(int body, const Vector3& direction) {
    if (wrench_ == nullptr) {
      if (body >= substep_.bodies.count()) return;
      const int terms = row_.term_count;
      substep_.add_torque(row_, body, direction);
      if (has_rotor_ && shares_carrier(body, terms)) drop_cancelled(body, direction.norm());
    } else if (body == watched_) {
      wrench_->torque += scale_ * direction;
    }
  }

 private:
  /// Whether what was added to a row of so many terms is shared between a rotor and its carrier.
  [[nodiscard]] bool shares_carrier(int body, int terms) const {
    return substep_.bodies[body].mount >= 0 || row_.term_count == terms;
  }
  [[nodiscard]] double reach(int body, const Vector3& at) const {
    const int mount = substep_.bodies[body].mount;
    const double own = (at - substep_.position(body)).norm();
    return mount < 0 ? own : std::max(own, (at - substep_.position(mount)).norm());
  }
  /// Makes torques 0 that are but rounding of `whole`: about the axle of a rotor that is pushed
  /// across it, and on a carrier that a joint with its own rotor pushes to and fro. There 1e-17
  /// would be all that the row can move, and would hold it with a force beyond all measure.
  void drop_cancelled(int body, double whole) {
    constexpr double rounding = 1e-12;
    const int mount = substep_.bodies[body].mount;
    for (RowTerm& term : std::span(row_.terms).first(static_cast<std::size_t>(row_.term_count))) {
      if (term.body != body && term.body != mount) continue;
      if (term.angular.norm() <= rounding * whole) term.angular.setZero();
    }
  }

  const Substep& substep_;
  Row& row_;
  bool has_rotor_ = false;
  int watched_ = -1;
  double scale_ = 1.0;
  Wrench* wrench_ = nullptr;
};

}  // namespace sheave
