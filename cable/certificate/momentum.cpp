// Repeats each body's substep by the integrator's own rule (engine/integrators), from the state at
// its start with the loads and the reported forces. A result that differs from the state at the end
// shows wrong or missing forces: a difference dx of the position is the force m dx / h^2, a
// difference dv of the velocity the force m dv / h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/checks.h"
#include "cable/certificate/free_rotation.h"
#include "engine/body_drive.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

struct Replay {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();
  Vector3 spin = Vector3::Zero();  ///< angular velocity
  double angle = 0.0;              ///< rotation about the axis [rad]
  bool has_angle = false;
};

class Player {
 public:
  explicit Player(const Evidence& evidence)
      : e_(evidence), bodies_(evidence.bodies), first_share_(evidence.rattle ? 0.5 : 1.0) {}

  void translate(int i, Replay& replay) const {
    const BodyProperties& body = bodies_[i];
    const Balance& balance = e_.balances[at(i)];
    const BodyState& from = e_.start.bodies[at(i)];
    const double first = first_share_ * e_.h;
    const Drag drag(bodies_.definition(i).damping / body.mass, first);
    const Vector3 load = body.mass * e_.gravity + load_force(i, first_end);
    const double yield = drag.share / body.mass;
    // The first half of `rattle` acts over the whole path; with `xpbd` all forces do.
    const Vector3& pushed = balance.force[e_.rattle ? first_end : last_end];
    const Vector3 v =
        drag.keep * from.velocity + allowed(body, yield * (first * load + e_.h * pushed));
    replay.position = from.position + e_.h * v;
    replay.velocity = v;
    if (!e_.rattle) return;
    // The second half starts from the actual motion of the body.
    const Vector3 moved = (e_.end.bodies[at(i)].position - from.position) / e_.h;
    replay.velocity =
        drag.keep * moved +
        allowed(body, yield * (first * (load + load_force(i, last_end) - load_force(i, first_end)) +
                               e_.h * balance.force[last_end]));
  }

  /// Rotation about the axis that the body keeps.
  void spin(int i, Replay& replay) const {
    const BodyProperties& body = bodies_[i];
    const Balance& balance = e_.balances[at(i)];
    const Moment& start = e_.moments[first_end];
    const Moment& end = e_.moments[last_end];
    const bool mounted = body.mount >= 0;
    const Vector3 axis0 = mounted ? Vector3(start.orientation(body.mount) * body.axis) : body.axis;
    const Vector3 axis1 = mounted ? Vector3(end.orientation(body.mount) * body.axis) : body.axis;
    const double first = first_share_ * e_.h;
    const Drag drag(bodies_.definition(i).angular_damping / body.axis_inertia, first);
    const double yield = drag.share / body.axis_inertia;
    const double t0 = e_.start.time;
    const double t1 = e_.end.time;
    const double middle = t0 + first_share_ * (t1 - t0);
    const auto driven = [&](double from, double to) {
      if (body.drive != DriveKind::torque) return 0.0;
      return BodyDrive(body, e_.start.controls, i).integral(from, to);
    };
    const double s0 = axis0.dot(e_.start.bodies[at(i)].angular_velocity);
    const double pushed = e_.rattle ? axis0.dot(balance.torque[first_end])
                                    : axis0.dot(axis1) * axis1.dot(balance.torque[last_end]);
    double s = drag.keep * s0 + yield * (first * axis0.dot(load_torque(i, first_end)) +
                                         driven(t0, middle) + e_.h * pushed);
    replay.angle = e_.h * s;
    replay.has_angle = !mounted;
    if (e_.rattle) {
      const double turned_at =
          mounted ? s : (e_.end.bodies[at(i)].angle - e_.start.bodies[at(i)].angle) / e_.h;
      s = drag.keep * turned_at +
          yield * (first * axis1.dot(load_torque(i, last_end)) + driven(middle, t1) +
                   e_.h * axis1.dot(balance.torque[last_end]));
    }
    replay.spin = s * axis1;
  }

  void rotate(int i, Replay& replay) const {
    const BodyProperties& body = bodies_[i];
    if (body.isotropic && body.mounted_rotors.empty()) {
      rotate_ball(i, replay);
    } else {
      rotate_free(i, replay);
    }
  }

  [[nodiscard]] Vector3 load_force(int i, End when) const {
    Vector3 force = e_.load_force(i, when);
    for (const int r : bodies_[i].mounted_rotors) force += e_.load_force(r, when);
    return force;
  }
  [[nodiscard]] Vector3 load_torque(int i, End when) const {
    return load_torque_with_rotors(e_, i, when);
  }

 private:
  static Vector3 allowed(const BodyProperties& body, const Vector3& v) {
    const Vector3 along = body.axis * body.axis.dot(v);
    if (body.mobility == Mobility::slider) return along;
    return body.mobility == Mobility::planar ? Vector3(v - along) : v;
  }

  void rotate_ball(int i, Replay& replay) const {
    const BodyProperties& body = bodies_[i];
    const Balance& balance = e_.balances[at(i)];
    const double inverse = body.inverse_inertia(0, 0);
    const double first = first_share_ * e_.h;
    const Drag drag(bodies_.definition(i).angular_damping * inverse, first);
    const Vector3& pushed = balance.torque[e_.rattle ? first_end : last_end];
    const FreeRotation free = free_rotation(e_, i);
    const Vector3 change = drag.share * e_.h * inverse * pushed;
    replay.orientation = turned(free.orientation, e_.h * change);
    replay.spin = free.turn / e_.h + change;
    if (!e_.rattle) return;
    replay.spin =
        drag.keep * replay.spin +
        drag.share * inverse * (first * load_torque(i, last_end) + e_.h * balance.torque[last_end]);
  }

  void rotate_free(int i, Replay& replay) const {
    const BodyProperties& body = bodies_[i];
    const Balance& balance = e_.balances[at(i)];
    const BodyState& from = e_.start.bodies[at(i)];
    const double h = e_.h;
    const Vector3 torque = load_torque(i, first_end);
    const FreeRotation start = free_rotation(e_, i);
    const Quaternion& free = start.orientation;
    const Vector3& momentum = start.momentum;
    const Matrix3 yield = in_world(body.inverse_inertia, e_.rattle ? from.orientation : free);
    const Vector3& pushed = balance.torque[e_.rattle ? first_end : last_end];
    const Vector3 change = h * (yield * pushed);
    replay.orientation = turned(free, h * change);
    if (!e_.rattle) {
      replay.spin = in_world(body.inverse_inertia, free) *
                        (momentum + h * torque - rotor_momentum(e_, i, free, first_end)) +
                    change;
      return;
    }
    // Angular momentum is conserved after the first half, and the second half acts at the end. The
    // angular momentum that rotors have gained in between is their own.
    const Quaternion& to = e_.end.bodies[at(i)].orientation;
    const Matrix3 inertia1 = in_world(body.inertia, to);
    Vector3 total = momentum + 0.5 * h * torque + h * pushed;
    Vector3 spun = Vector3::Zero();
    for (const int r : body.mounted_rotors) {
      const Vector3 axis0 = from.orientation * bodies_[r].axis;
      const double gained = h * axis0.dot(e_.balances[at(r)].torque[first_end]) +
                            0.5 * h * axis0.dot(e_.load_torque(r, first_end));
      const double own =
          bodies_[r].axis_inertia * axis0.dot(e_.start.bodies[at(r)].angular_velocity);
      const double by_loads = 0.5 * h * axis0.dot(e_.load_torque(r, first_end));
      total += (gained - by_loads) * axis0;
      spun += (own + gained - by_loads) * (to * bodies_[r].axis);
    }
    const Vector3 kept = in_world(body.inverse_inertia, to) * (total - spun);
    replay.spin = damped_spin(e_, i, inertia1, kept) +
                  in_world(body.inverse_inertia, to) *
                      (0.5 * h * load_torque(i, last_end) + h * balance.torque[last_end]);
  }

  const Evidence& e_;
  const BodySet& bodies_;
  double first_share_;
};

/// Rotation vector between two orientations, for small rotations.
Vector3 difference(const Quaternion& to, const Quaternion& from) {
  Quaternion change = to * from.conjugate();
  if (change.w() < 0.0) change.coeffs() = -change.coeffs();
  return 2.0 * change.vec();
}

constexpr double sum_rounding = 64.0 * std::numeric_limits<double>::epsilon();

class MomentumCheck {
 public:
  MomentumCheck(const Evidence& evidence, Findings& findings)
      : e_(evidence), findings_(findings), player_(evidence) {
    for (const ColliderDef& collider : evidence.model.colliders) {
      bounces_ = bounces_ || collider.restitution > 0.0;
    }
    bounces_ = bounces_ && !evidence.rattle;
  }

  /// Returns the work of the residual [J].
  double check(int i) {
    const BodyProperties& body = e_.bodies[i];
    if (e_.balances[at(i)].unknown || body.prescribed()) return 0.0;
    switch (body.mobility) {
      case Mobility::fixed:
      case Mobility::kinematic:
        return 0.0;
      case Mobility::free:
      case Mobility::planar:
      case Mobility::slider:
        break;
      case Mobility::rotor:
        if (body.axis_inertia > 0.0) return check_spin(i);
        check_massless(i);
        return 0.0;
      case Mobility::knot:
        check_knot(i);
        return 0.0;
    }
    double leak = check_way(i);
    if (body.mobility == Mobility::planar) leak += check_spin(i);
    if (body.mobility == Mobility::free) leak += check_rotation(i);
    return leak;
  }

 private:
  double check_way(int i) {
    const double h = e_.h;
    const double mass = e_.bodies[i].mass;
    const BodyState& from = e_.start.bodies[at(i)];
    const BodyState& to = e_.end.bodies[at(i)];
    Replay replay;
    player_.translate(i, replay);
    const Vector3 missing = (to.velocity - replay.velocity) * (mass / h);
    const Vector3 placed = (to.position - replay.position) * (mass / (h * h));
    // The velocity of a bounce is not that of its path.
    const double value = std::max(missing.norm(), bounces_ ? 0.0 : placed.norm());
    const Balance& balance = e_.balances[at(i)];
    const double largest = std::max({balance.largest_force, mass * e_.gravity.norm(),
                                     player_.load_force(i, last_end).norm(),
                                     mass * (to.velocity - from.velocity).norm() / h});
    const double eps = sum_rounding * mass *
                       ((to.position.norm() + e_.bodies.scale()) / (h * h) +
                        (from.velocity.norm() + to.velocity.norm()) / h);
    findings_.note(CertificateItem::Kind::momentum, "N", value, largest, eps,
                   [&] { return e_.body_name(i); });
    // Rounding does no work; for a body at rest any amount would exceed its energy.
    if (missing.norm() <= eps) return 0.0;
    return h * missing.dot(0.5 * (from.velocity + to.velocity));
  }

  /// Smallest scale of a torque [N m]: forces through the centre of mass cause torques by the
  /// rounding of their arms.
  [[nodiscard]] double lever(int i) const {
    const double size = e_.size_of(i);
    return 0.1 * size * e_.balances[at(i)].largest_force;
  }

  /// Number of the body's own sizes in the coordinates of the scene. Torques come from lengths that
  /// are rounded like these coordinates.
  [[nodiscard]] double rounded_turns(int i) const {
    const double size = e_.size_of(i);
    if (!(size > 0.0)) return 0.0;
    return (e_.end.bodies[at(i)].position.norm() + e_.bodies.scale()) / size;
  }

  double check_spin(int i) {
    const double h = e_.h;
    const BodyProperties& body = e_.bodies[i];
    const double inertia = body.axis_inertia;
    Replay replay;
    player_.spin(i, replay);
    const Vector3 axis = body.mount >= 0
                             ? Vector3(e_.moments[last_end].orientation(body.mount) * body.axis)
                             : body.axis;
    const BodyState& from = e_.start.bodies[at(i)];
    const BodyState& to = e_.end.bodies[at(i)];
    const double s1 = axis.dot(to.angular_velocity);
    const double s0 = from.angular_velocity.norm();
    const double missing = (s1 - axis.dot(replay.spin)) * inertia / h;
    const double placed = replay.has_angle && !bounces_
                              ? (to.angle - from.angle - replay.angle) * inertia / (h * h)
                              : 0.0;
    const double driven = body.drive == DriveKind::torque
                              ? std::abs(BodyDrive(body, e_.start.controls, i).at(e_.end.time))
                              : 0.0;
    const double largest =
        std::max({e_.balances[at(i)].largest_torque, lever(i), driven,
                  e_.load_torque(i, last_end).norm(), inertia * std::abs(std::abs(s1) - s0) / h});
    const double eps =
        sum_rounding * inertia *
        ((1.0 + std::abs(to.angle) + rounded_turns(i)) / (h * h) + (std::abs(s1) + s0) / h);
    findings_.note(CertificateItem::Kind::angular_momentum, "N m",
                   std::max(std::abs(missing), std::abs(placed)), largest, eps,
                   [&] { return e_.body_name(i); });
    if (std::abs(missing) <= eps) return 0.0;
    return h * missing * 0.5 * (s1 + axis.dot(from.angular_velocity));
  }

  double check_rotation(int i) {
    const double h = e_.h;
    const BodyProperties& body = e_.bodies[i];
    const BodyState& from = e_.start.bodies[at(i)];
    const BodyState& to = e_.end.bodies[at(i)];
    Replay replay;
    player_.rotate(i, replay);
    const Matrix3 rotation = to.orientation.toRotationMatrix();
    const auto torque_of = [&](const Vector3& w) -> Vector3 {
      return rotation * (body.inertia * (rotation.transpose() * w));
    };
    const Vector3 missing = torque_of(to.angular_velocity - replay.spin) / h;
    const Vector3 placed = torque_of(difference(to.orientation, replay.orientation)) / (h * h);
    const double moment = body.inertia.norm();
    const double speed = from.angular_velocity.norm() + to.angular_velocity.norm();
    const double gyroscopic = from.angular_velocity.cross(torque_of(from.angular_velocity)).norm();
    const double largest =
        std::max({e_.balances[at(i)].largest_torque, lever(i), gyroscopic,
                  e_.load_torque(i, last_end).norm(),
                  torque_of(to.angular_velocity - from.angular_velocity).norm() / h});
    const double eps = sum_rounding * moment * ((1.0 + rounded_turns(i)) / (h * h) + speed / h);
    findings_.note(CertificateItem::Kind::angular_momentum, "N m",
                   std::max(missing.norm(), bounces_ ? 0.0 : placed.norm()), largest, eps,
                   [&] { return e_.body_name(i); });
    const double beside = bounces_ ? turned_beside(i, replay) : 0.0;
    if (missing.norm() <= eps) return beside;
    return beside + h * missing.dot(0.5 * (from.angular_velocity + to.angular_velocity));
  }

  /// Change of rotational energy because a body has been turned further than its replay, as when a
  /// penetration is removed [J]. The velocity of a bounce is not that of its path, so the
  /// orientation may differ by the change of velocity times h.
  [[nodiscard]] double turned_beside(int i, const Replay& replay) const {
    const BodyState& from = e_.start.bodies[at(i)];
    const BodyState& to = e_.end.bodies[at(i)];
    const double off = difference(to.orientation, replay.orientation).norm();
    if (off <= e_.h * (to.angular_velocity - from.angular_velocity).norm()) return 0.0;
    const auto energy = [&](const Quaternion& orientation) {
      const Vector3 own = orientation.conjugate() * to.angular_velocity;
      return 0.5 * own.dot(e_.bodies[i].inertia * own);
    };
    return energy(to.orientation) - energy(replay.orientation);
  }

  /// The torques on a wheel without inertia must sum to 0 about its axle.
  void check_massless(int i) {
    if (e_.brakes(i)) return;
    const Balance& balance = e_.balances[at(i)];
    for (const End when : {first_end, last_end}) {
      const Vector3 axis =
          e_.bodies[i].mount >= 0
              ? Vector3(e_.moments[at(when)].orientation(e_.bodies[i].mount) * e_.bodies[i].axis)
              : e_.bodies[i].axis;
      findings_.note(CertificateItem::Kind::angular_momentum, "N m",
                     std::abs(axis.dot(balance.torque[at(when)])),
                     std::max(balance.largest_torque, lever(i)), 0.0,
                     [&] { return e_.body_name(i); });
    }
  }

  /// The forces on a knot without mass must sum to 0.
  void check_knot(int i) {
    const Balance& balance = e_.balances[at(i)];
    for (const End when : {first_end, last_end}) {
      findings_.note(CertificateItem::Kind::momentum, "N", balance.force[at(when)].norm(),
                     balance.largest_force, 0.0, [&] { return e_.body_name(i); });
    }
  }

  const Evidence& e_;
  Findings& findings_;
  Player player_;
  bool bounces_ = false;
};

}  // namespace

std::vector<double> check_momentum(const Evidence& evidence, Findings& findings) {
  MomentumCheck check(evidence, findings);
  std::vector<double> leaks(at(evidence.bodies.count()), 0.0);
  for (int i = 0; i < evidence.bodies.count(); ++i) leaks[at(i)] = check.check(i);
  return leaks;
}

}  // namespace sheave::certify
