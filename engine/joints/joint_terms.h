#pragma once

#include <algorithm>
#include <span>

#include "engine/substep.h"
#include "engine/wrench.h"

namespace sheave {

/// Sets the parts of the gradient to 0 that are rounding errors along a direction in which the body
/// can move. For example, a row across the axis of a slider has 1e-17 along the axis. The row would
/// act along the axis with that lever, and a large force would hold the slider.
inline void drop_rounding(Row& row, std::span<const MovingBody> bodies) {
  const auto keep = [](const Matrix3& inverse, Vector3& gradient) {
    constexpr double rounding = 1e-12;
    const double trace = inverse(0, 0) + inverse(1, 1) + inverse(2, 2);
    const double full = trace * trace * dot(gradient, gradient);
    // Prescribed bodies have no inverse mass, but their velocities enter the rates of the rows.
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

/// Collects the action of a unit multiplier of a joint's row: into the gradient of the row, or into
/// the wrench on one body.
class JointTerms {
 public:
  /// `has_rotor`: whether one of the joint's bodies is a rotor mounted on another body.
  JointTerms(const Substep& substep, Row& row, bool has_rotor = false)
      : substep_(substep), row_(row), has_rotor_(has_rotor) {}
  /// Adds the action on `body`, times `scale`, to `wrench`; the row's gradient is not changed.
  JointTerms(const Substep& substep, Row& row, int body, double scale, Wrench& wrench)
      : substep_(substep), row_(row), watched_(body), scale_(scale), wrench_(&wrench) {}

  [[nodiscard]] const Substep& substep() const { return substep_; }
  void set_value(double value) { row_.value = value; }
  /// To be called if the row's directions are constant (Row::told).
  void tell() { row_.told = true; }
  void set_compliance(double compliance) { row_.compliance = compliance; }
  void set_damping(double damping) { row_.damping = damping; }
  void set_bounds(double lower, double upper) {
    row_.lower = lower;
    row_.upper = upper;
  }

  /// Adds a force along `direction` at the world point `at`.
  void add_force(int body, const Vector3& at, const Vector3& direction) {
    if (wrench_ == nullptr) {
      // The world never moves, and a row has room for few bodies.
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
  /// Adds the gradient of another row, times `factor`. No body of the row may be a mounted rotor.
  void add_row(const Row& other, double factor) {
    for (const RowTerm& term : other.active_terms()) {
      if (wrench_ == nullptr) {
        row_.add(term.body, factor * term.linear, factor * term.angular);
      } else if (term.body == watched_) {
        const Vector3 arm =
            substep_.moving[static_cast<std::size_t>(term.body)].position - wrench_->about;
        const double scale = scale_ * factor;
        wrench_->force += scale * term.linear;
        wrench_->torque += scale * (term.angular + cross(arm, term.linear));
      }
    }
  }

 private:
  /// Whether the gradient just added to a row with `terms` bodies is split between a rotor and its
  /// carrier.
  [[nodiscard]] bool shares_carrier(int body, int terms) const {
    return substep_.bodies[body].mount >= 0 || row_.term_count == terms;
  }
  [[nodiscard]] double reach(int body, const Vector3& at) const {
    const int mount = substep_.bodies[body].mount;
    const double own = (at - substep_.position(body)).norm();
    return mount < 0 ? own : std::max(own, (at - substep_.position(mount)).norm());
  }
  /// Sets torques to 0 that are rounding errors relative to `whole`. Such torques arise about the
  /// axle of a rotor that is pushed across it, and on a carrier on which a joint with its own rotor
  /// pushes to and fro. If 1e-17 were the only lever of the row, an enormous force would result.
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
