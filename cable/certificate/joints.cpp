// Residuals of joints: locks, drives, and the laws of springs, dampers and friction along
// coordinates. Rates and forces follow the integrator's rule: `xpbd` requires its laws at the end
// of the substep, `rattle` for the mean of both ends.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/checks.h"
#include "cable/certificate/coupled_joints.h"
#include "cable/certificate/joint_frames.h"
#include "engine/joints/ball.h"
#include "engine/joints/coupling.h"
#include "engine/joints/gear.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

/// Target of a drive, from its settings or its control.
struct Demand {
  TimeSignal signal;
  const DriveControl* set;
  double most = 0.0;  ///< largest absolute target
  double limit = std::numeric_limits<double>::infinity();

  Demand(const JointCoordinate& settings, const DriveControl* control)
      : signal(settings.signal()), set(control), most(settings.drive_amplitude) {
    for (const double v : settings.drive_values) most = std::max(most, std::abs(v));
    if (settings.drive_limit) limit = *settings.drive_limit;
    if (set == nullptr) return;
    if (!std::isnan(set->limit)) limit = set->limit;
    if (!set->has_target) {
      set = nullptr;
    } else {
      most = std::max(std::abs(set->target.start), std::abs(set->target.end));
    }
  }
  [[nodiscard]] double at(double time) const {
    return set != nullptr ? set->target.at(time) : signal.at(time);
  }
  [[nodiscard]] double integral(double from, double to) const {
    return set != nullptr ? set->target.integral(from, to) : signal.integral(from, to);
  }
};

class JointCheck {
 public:
  JointCheck(const Evidence& evidence, const JointEvidence& joint, Findings& findings)
      : e_(evidence),
        joint_(joint),
        findings_(findings),
        frame_(frame_of(evidence.bodies, joint)),
        size_(size()) {
    force_ = joint.acting[0].force + joint.acting[1].force;
    torque_ = joint.acting[0].torque + joint.acting[1].torque;
    load_ = std::max(force_.norm(), torque_.norm() / size_);
  }

  void check() {
    if (frame_.kind.distance) {
      check_distance();
    } else if (frame_.kind.of_joints) {
      check_coupled_joints();
    } else if (frame_.kind.coupling) {
      check_coupling();
    } else {
      check_locks();
    }
    check_shared_friction();
    const std::vector<CoordinateSettings> settings = coordinates_of(*joint_.definition);
    for (std::size_t k = 0; k < settings.size() && k < joint_.end.coordinates.size(); ++k) {
      if (settings[k].settings == nullptr) continue;
      check_stops(k, *settings[k].settings);
      check_drive(k, *settings[k].settings);
      if (settings[k].along != 0) check_law(k, settings[k]);
    }
  }

 private:
  static constexpr double rounding = 1e-12;

  /// Scale of the gaps [m]: the joined bodies, as far as their anchors reach.
  [[nodiscard]] double size() const {
    double size = 0.0;
    for (const auto& [body, anchor] : {std::pair{frame_.body_a, &frame_.own_anchor_a},
                                       std::pair{frame_.body_b, &frame_.own_anchor_b}}) {
      if (body == e_.bodies.count()) continue;
      if (!yields(e_.bodies[body].mobility)) continue;
      size = std::max(size, anchor->norm() + e_.size_of(body));
    }
    return size > 0.0 ? std::min(size, e_.bodies.scale()) : e_.bodies.scale();
  }
  [[nodiscard]] std::string name() const {
    return std::string(joint_.definition->type()) + " \"" + joint_.definition->name + "\"";
  }
  void note(Kind kind, std::string_view unit, double value, double scale, double eps) {
    findings_.note(kind, unit, value, scale, eps, [&] { return name(); });
  }
  /// Value of a lock to which its law applies, from the values at both ends.
  template <class Value>
  [[nodiscard]] Vector3 ruled(const Value& value) const {
    const Vector3 now = value(e_.moments[last_end]);
    if (!e_.rattle) return now;
    return 0.5 * (value(e_.moments[first_end]) + now);
  }

  void check_locks() {
    const double a = frame_.compliance;
    const double b = frame_.angular_compliance;
    const auto axis_of = [&](const Moment& now) -> Vector3 {
      return frame_.turned_a(now) * frame_.axis_a;
    };
    const auto gap = [&](const Moment& now) -> Vector3 {
      const Vector3 apart = frame_.anchor_a(now) - frame_.anchor_b(now);
      const Vector3 axis = axis_of(now);
      if (frame_.kind.on_axis) return apart - axis * axis.dot(apart);
      if (frame_.kind.in_plane) return axis * axis.dot(apart);
      return apart;
    };
    // Rigid: the gap at the end. Elastic: residual of the spring's law, force = gap / compliance.
    Vector3 open = a > 0.0 ? ruled(gap) : gap(e_.moments[last_end]);
    if (a > 0.0) {
      const Vector3 axis = axis_of(e_.moments[last_end]);
      Vector3 held = force_;
      if (frame_.kind.on_axis) held -= axis * axis.dot(held);
      if (frame_.kind.in_plane) held = axis * axis.dot(held);
      open -= a * held;
    }
    note(Kind::joint, "m", open.norm(), size_, rounding * e_.bodies.scale());
    check_angles(b, axis_of);
  }

  template <class Axis>
  void check_angles(double b, const Axis& axis_of) {
    const auto other_axis = [&](const Moment& now) -> Vector3 {
      return frame_.turned_by(now, frame_.body_b) * frame_.axis_b;
    };
    if (frame_.kind.parallel) {
      const auto tilt = [&](const Moment& now) -> Vector3 {
        const Vector3 u = axis_of(now);
        const Vector3 v = other_axis(now);
        return u.cross(v) * u.dot(v);
      };
      Vector3 open = tilt(e_.moments[last_end]);
      if (b > 0.0) {
        Vector3 held = Vector3::Zero();
        for (const End when : {first_end, last_end}) {
          const Moment& moment = e_.moments[at(when)];
          held +=
              without_twist(joint_.acting[at(when)].torque, axis_of(moment), other_axis(moment));
        }
        open = ruled(tilt) + b * held;
      }
      note(Kind::joint, "rad", open.norm(), 1.0, rounding);
    }
    if (frame_.kind.no_turn) {
      const auto turn = [&](const Moment& now) -> Vector3 {
        Quaternion error = frame_.turned_a(now) * frame_.turned_by(now, frame_.body_b).conjugate();
        if (error.w() < 0.0) error.coeffs() = -error.coeffs();
        return 2.0 * error.w() * error.vec();
      };
      Vector3 open = turn(e_.moments[last_end]);
      if (b > 0.0) open = ruled(turn) - b * torque_;
      note(Kind::joint, "rad", open.norm(), 1.0, rounding);
    }
    if (frame_.kind.right_angle) {
      const auto sine = [&](const Moment& now) -> Vector3 {
        return Vector3(axis_of(now).dot(other_axis(now)), 0.0, 0.0);
      };
      double open = sine(e_.moments[last_end]).x();
      if (b > 0.0) {
        open = ruled(sine).x();
        const Vector3 across =
            axis_of(e_.moments[last_end]).cross(other_axis(e_.moments[last_end]));
        open -= b * torque_.dot(across);
      }
      note(Kind::joint, "rad", std::abs(open), 1.0, rounding);
    }
  }

  void check_distance() {
    if (frame_.lower != 0.0 && frame_.upper != 0.0) return;  // any distance is permitted
    const auto stretch = [&](const Moment& now) {
      return (frame_.anchor_a(now) - frame_.anchor_b(now)).norm() - frame_.length;
    };
    const double x0 = stretch(e_.moments[first_end]);
    const double x1 = stretch(e_.moments[last_end]);
    const Vector3 apart =
        frame_.anchor_a(e_.moments[last_end]) - frame_.anchor_b(e_.moments[last_end]);
    // Force on B towards A; > 0 pulls.
    const double pull = force_.dot(apart.normalized());
    if (frame_.compliance > 0.0) {
      // Further forces along the extension cannot be separated from that of the rod.
      if (coordinates_of(*joint_.definition).front().settings->acts()) return;
      const bool one_sided = frame_.lower != 0.0 || frame_.upper != 0.0;
      const double sign = frame_.lower != 0.0 ? 1.0 : -1.0;
      // The damper of a one-sided distance acts while the distance is closed.
      const auto acting = [&](double x) { return one_sided ? sign * std::max(sign * x, 0.0) : x; };
      const double moved = x1 - x0;
      const double change = e_.rattle ? moved : e_.h * seen_by_damper(3, moved / e_.h);
      const double closing = (e_.rattle ? acting(x1) : x1) - acting(x1 - change);
      double mean = e_.rattle ? 0.5 * (x0 + x1) : x1;
      if (e_.rattle && one_sided) mean = sign * acting_mean(sign * x0, sign * x1);
      const double asked = mean + frame_.compliance * frame_.damping * closing / e_.h;
      double off = std::abs(asked - frame_.compliance * pull);
      if (one_sided && pull == 0.0) off = std::max(frame_.lower != 0.0 ? asked : -asked, 0.0);
      note(Kind::joint, "m", off, std::max(size_, std::abs(asked)), rounding * e_.bodies.scale());
      return;
    }
    double off = std::abs(x1);
    if (frame_.lower != 0.0) off = std::max(x1, 0.0);
    if (frame_.upper != 0.0) off = std::max(-x1, 0.0);
    note(Kind::joint, "m", off, std::min(size_, std::max(frame_.length, 1e-3 * size_)),
         rounding * e_.bodies.scale());
    const double wrong = frame_.lower != 0.0 ? -pull : frame_.upper != 0.0 ? pull : 0.0;
    if (coordinates_of(*joint_.definition).front().settings->acts()) return;
    note(Kind::complementarity, "N", std::max(wrong, 0.0),
         std::max(e_.largest_force, std::abs(pull)), 0.0);
  }

  void check_coupled_joints() {
    const auto& own = static_cast<const CouplingJoint&>(*joint_.definition);
    const double start = coupling_length(e_, joint_, first_end);
    const double end = coupling_length(e_, joint_, last_end);
    // Rounding of the terms of the sum, which may cancel.
    double terms = e_.bodies.scale();
    for (const double factor : own.factors) terms += own.radius * std::abs(factor);
    for (const double factor : own.curve) terms += own.radius * std::abs(factor);
    note(Kind::joint, "m", std::abs(end - joint_.end.coordinates[0].value), size_,
         rounding * terms);
    if (!own.held) return;
    const double mean = own.compliance > 0.0 && e_.rattle ? 0.5 * (start + end) : end;
    note(Kind::joint, "m", std::abs(mean - frame_.mesh + own.compliance * along_length()), size_,
         rounding * terms);
  }

  /// Force of a coupling of joints along its length [N].
  [[nodiscard]] double along_length() const {
    return coupling_force(e_, joint_, first_end) + coupling_force(e_, joint_, last_end);
  }

  void check_coupling() {
    if (joint_.end.coordinates.size() < 2) return;
    double play = 0.0;
    double give = 0.0;
    const bool gear = joint_.definition->type() == GearJoint::type_name;
    double held = 0.0;
    const Quaternion carried = frame_.turned_by(e_.moments[last_end], frame_.carrier);
    if (gear) {
      const auto& own = static_cast<const GearJoint&>(*joint_.definition);
      play = own.backlash;
      give = own.compliance;
      held = torque_.dot(carried * frame_.axis_b);
    } else {
      const auto& own = static_cast<const RackJoint&>(*joint_.definition);
      play = own.backlash;
      give = own.compliance;
      held = force_.dot(carried * frame_.axis_b);
    }
    const auto off_at = [&](const JointReport& report) {
      return report.coordinates[1].value - frame_.ratio * report.coordinates[0].value - frame_.mesh;
    };
    const double now = off_at(joint_.end);
    double open = std::max(std::abs(now) - 0.5 * play, 0.0);
    if (give > 0.0) {
      if (play > 0.0 && e_.rattle) return;  // whether the start counts depends on the side
      const double mean = e_.rattle ? 0.5 * (now + off_at(joint_.start)) : now;
      const double side = mean > 0.0 ? 0.5 * play : -0.5 * play;
      open = held != 0.0 ? std::abs(mean - side + give * held) : open;
    }
    note(Kind::joint, gear ? "rad" : "m", open,
         gear ? std::max(1.0, std::abs(frame_.ratio)) : size_,
         rounding * (gear ? 1.0 : e_.bodies.scale()) *
             (1.0 + std::abs(joint_.end.coordinates[1].value)));
  }

  [[nodiscard]] double scale_of(std::size_t k) const {
    return joint_.end.coordinates[k].angle ? 1.0 : size_;
  }
  [[nodiscard]] std::string_view unit_of(std::size_t k) const {
    return joint_.end.coordinates[k].angle ? "rad" : "m";
  }

  void check_stops(std::size_t k, const JointCoordinate& settings) {
    if (!settings.lower && !settings.upper) return;
    const double c = joint_.end.coordinates[k].value;
    double over = 0.0;
    if (settings.lower) over = std::max(over, *settings.lower - c);
    if (settings.upper) over = std::max(over, c - *settings.upper);
    // Drives and springs of the coordinate push against its stop inside the joint, so their force
    // is not in the joint's reaction.
    const JointCoordinateReport& now = joint_.end.coordinates[k];
    const double inner = std::abs(now.drive_force) + settings.friction +
                         settings.stiffness * std::abs(now.value - settings.rest);
    const double passed = frame_.kind.of_joints ? std::abs(along_length())
                          : now.angle           ? torque_.norm()
                                                : force_.norm();
    const double give = settings.limit_compliance * (inner + passed);
    // An elastic stop yields. The balance of momentum checks its force.
    if (settings.limit_compliance > 0.0) over = std::max(over - 2.0 * give, 0.0);
    note(Kind::joint, unit_of(k), over, scale_of(k), rounding * scale_of(k));
  }

  void check_drive(std::size_t k, const JointCoordinate& settings) {
    if (settings.drive == CoordinateDrive::none) return;
    const JointCoordinateReport& now = joint_.end.coordinates[k];
    const JointCoordinateReport& before = joint_.start.coordinates[k];
    const Demand signal(settings, e_.start.controls.joint_drives.find(joint_.first_coordinate +
                                                                      static_cast<int>(k)));
    const double t0 = e_.start.time;
    const double t1 = e_.end.time;
    const double force = now.drive_force;
    const double most = signal.most;
    if (settings.drive == CoordinateDrive::force) {
      note(Kind::drive, now.angle ? "N m" : "N",
           std::abs(force - signal.integral(t0, t1) / (t1 - t0)), most, rounding * most);
      return;
    }
    const double limit = signal.limit;
    if (std::isfinite(limit)) {
      note(Kind::drive, now.angle ? "N m" : "N", std::max(std::abs(force) - limit, 0.0), limit,
           1e-9 * limit);
    }
    // A drive at its limit is stalled, not wrong.
    const double enough = (1.0 - 1e-6) * limit;
    if (std::abs(force) >= enough) return;
    // The first half of `rattle` has to do all of the motion with at most half of the limit. The
    // second half may complete it with less.
    const double early = joint_.acting[first_end].coordinates[k].drive_force;
    if (e_.rattle && std::abs(early) >= 0.5 * enough) return;
    const double slop = rounding * (scale_of(k) + std::abs(now.value)) +
                        1e-10 * (now.angle ? 1.0 : e_.bodies.scale());
    if (settings.drive == CoordinateDrive::speed) {
      const double off = now.value - before.value - signal.integral(t0, t1);
      note(Kind::drive, unit_of(k), std::abs(off), std::max(most * e_.h, 1e-6 * scale_of(k)), slop);
      return;
    }
    const double a = settings.drive_compliance;
    double off = now.value - signal.at(t1);
    if (e_.rattle && a > 0.0) off = 0.5 * (off + before.value - signal.at(t0));
    // A small motion that is missed as a whole is no small error. A drive that holds 0 has no motion.
    const double scale = most > 0.0 ? std::max(most, 1e-6 * scale_of(k)) : scale_of(k);
    note(Kind::drive, unit_of(k), std::abs(off + a * force), scale, slop);
  }

  /// Rate of a translation as seen by a damper beside a spring. With `xpbd` the rate is that of the
  /// motion along the force's direction at the end. If the joint turns about a distant point, this
  /// rate differs in second order from `moved`, the change of the coordinate.
  [[nodiscard]] double seen_by_damper(int along, double moved) const {
    if (e_.rattle || (along != 1 && along != 3)) return moved;
    const Moment& moment = e_.moments[last_end];
    const Vector3 at_b = frame_.anchor_b(moment);
    const Vector3 at_a = along == 1 ? at_b : frame_.anchor_a(moment);
    const Vector3 direction = along == 1 ? Vector3(frame_.turned_a(moment) * frame_.axis_a)
                                         : Vector3((at_b - at_a).normalized());
    return direction.dot(e_.displacement(frame_.body_b, at_b, last_end) -
                         e_.displacement(frame_.body_a, at_a, last_end)) /
           e_.h;
  }

  /// Rate below which slip may be rounding [m/s, rad/s]: a millionth of the joint's
  /// size in the time so far, and a hundred times the residual that the solver may leave per
  /// substep in a closed row.
  [[nodiscard]] double crawl_of(bool angle) const {
    const double passed = 1e-6 * (angle ? 1.0 : size_) / std::max(e_.end.time, e_.h);
    return passed + 1e-8 * e_.bodies.scale() / e_.h;
  }

  /// The effort along a coordinate is the sum of its drive, spring and damper, of friction within
  /// its bound, and of stops that push.
  void check_law(std::size_t k, const CoordinateSettings& entry) {
    const JointCoordinate& settings = *entry.settings;
    const JointCoordinateReport& now = joint_.end.coordinates[k];
    const JointCoordinateReport& before = joint_.start.coordinates[k];
    double acting = entry.along == 4 ? along_length() : 0.0;
    for (const End when : {first_end, last_end}) {
      const Moment& moment = e_.moments[at(when)];
      const JointReport& part = joint_.acting[at(when)];
      const Vector3 axis = frame_.turned_a(moment) * frame_.axis_a;
      if (entry.along == 1) acting += part.force.dot(axis);
      if (entry.along == 2) acting += part.torque.dot(axis);
      if (entry.along == 3) {
        const Vector3 out = frame_.anchor_b(moment) - frame_.anchor_a(moment);
        acting += part.force.dot(out.normalized());
      }
    }
    const double moved = (now.value - before.value) / e_.h;
    double damping = settings.damping;
    if (entry.along == 3) damping = frame_.damping;
    const double mean = e_.rattle ? 0.5 * (now.value + before.value) : now.value;
    const double spring =
        settings.stiffness > 0.0 ? -settings.stiffness * (mean - settings.rest) : 0.0;
    const double slowed =
        damping > 0.0 && settings.stiffness > 0.0 ? seen_by_damper(entry.along, moved) : moved;
    const double expected = now.drive_force + spring - damping * slowed;
    const double rest = acting - expected;
    // The tolerance of closed rows (engine/solvers/velocity_system.cpp).
    const double slop = 2e-8 * std::max(scale_of(k), e_.bodies.scale());
    // A stop pushes only while the coordinate is at it.
    const auto at_stop = [&](const std::optional<double>& stop, double sense) {
      if (!stop || sense * rest <= 0.0) return false;
      const double nearest = std::min(sense * (now.value - *stop), sense * (before.value - *stop));
      return nearest <= slop + (settings.limit_compliance > 0.0 ? scale_of(k) * 1e-6 : 0.0);
    };
    const bool stopped = at_stop(settings.lower, 1.0) || at_stop(settings.upper, -1.0);
    const double excess = std::max(std::abs(rest) - settings.friction, 0.0);
    const double largest =
        std::max({std::abs(acting), std::abs(now.drive_force), std::abs(spring),
                  std::abs(damping * moved), settings.friction, now.angle ? load_ * size_ : load_});
    // Values and forces are known only to the rounding of poses.
    constexpr double digits = 64.0 * std::numeric_limits<double>::epsilon();
    const double value_rounding =
        digits * (std::abs(now.value) + (now.angle ? 1.0 : e_.bodies.scale()));
    const double law_rounding = (settings.stiffness + damping / e_.h) * value_rounding +
                                e_.force_rounding * (now.angle ? size_ : 1.0);
    note(Kind::force_law, now.angle ? "N m" : "N", stopped ? 0.0 : excess, largest,
         rounding * 1e2 * largest + law_rounding);
    // Dry friction dissipates: while the coordinate moves it is at its bound, against the motion.
    if (settings.friction > 0.0 && !stopped) {
      const double speed = std::abs(moved);
      const double crawl = crawl_of(now.angle);
      const double weight = speed / (speed + crawl);
      const double along = moved > 0.0 ? rest : -rest;
      // At the bound rest = -friction sign(moved).
      note(Kind::friction, now.angle ? "N m" : "N", weight * std::max(along, 0.0),
           std::max(largest, settings.friction), law_rounding);
    }
  }

  /// Dry friction in several directions is a vector within a ball, against the motion.
  void check_shared_friction() {
    const auto* ball = dynamic_cast<const BallJoint*>(joint_.definition);
    const auto* plane = dynamic_cast<const PlaneJoint*>(joint_.definition);
    const double bound = ball != nullptr    ? ball->friction
                         : plane != nullptr ? plane->friction
                                            : 0.0;
    if (!(bound > 0.0)) return;
    const auto part = [&](End when) {
      const JointReport& acting = joint_.acting[at(when)];
      return ball != nullptr ? acting.friction_torque : acting.friction_force;
    };
    const Vector3 friction = part(first_end) + part(last_end);
    const std::string_view unit = ball != nullptr ? "N m" : "N";
    const double scale = std::max(bound, ball != nullptr ? torque_.norm() : force_.norm());
    const double slop =
        rounding * 1e2 * scale + e_.force_rounding * (ball != nullptr ? size_ : 1.0);
    note(Kind::friction, unit, std::max(friction.norm() - bound, 0.0), scale, slop);
    const auto moved_by = [&](int body) -> Vector3 {
      if (body == e_.bodies.count()) return Vector3::Zero();
      if (ball != nullptr) return e_.turn_of(body);
      return e_.displacement(body, frame_.anchor_b(e_.moments[last_end]), last_end);
    };
    Vector3 moved = (moved_by(frame_.body_b) - moved_by(frame_.body_a)) / e_.h;
    if (plane != nullptr) {
      const Vector3 normal = frame_.turned_a(e_.moments[last_end]) * frame_.axis_a;
      moved -= normal * normal.dot(moved);
    }
    const double speed = moved.norm();
    const double crawl = crawl_of(ball != nullptr);
    const double along = speed > 0.0 ? friction.dot(moved) / speed : 0.0;
    note(Kind::friction, unit, std::max(along, 0.0) * speed / (speed + crawl), scale, slop);
  }

  const Evidence& e_;
  const JointEvidence& joint_;
  Findings& findings_;
  JointFrame frame_;
  double size_;
  Vector3 force_;
  Vector3 torque_;
  double load_ = 0.0;
};

}  // namespace

void check_joints(const Evidence& evidence, Findings& findings) {
  for (const JointEvidence& joint : evidence.joints) {
    if (!joint.broken) JointCheck(evidence, joint, findings).check();
  }
}

}  // namespace sheave::certify
