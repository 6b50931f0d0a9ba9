#include "cable/certificate/hanging.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>
#include <Eigen/LU>

#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

double asinh_of(double x) {
  const double size = portable::log(std::abs(x) + portable::hypot(1.0, x));
  return x < 0.0 ? -size : size;
}

/// The span in the vertical plane through its ends.
struct Plane {
  double x = 0.0;
  double z = 0.0;
  double w = 0.0;
  double yield = 0.0;
  Vector3 up = Vector3::UnitY();
  Vector3 across = Vector3::UnitX();
};

Plane plane_of(const HungRope& span, double length) {
  Plane plane;
  plane.w = span.weight.norm();
  plane.yield = span.yield;
  plane.up = -span.weight / plane.w;
  const Vector3 apart = span.end - span.start;
  plane.z = apart.dot(plane.up);
  const Vector3 level = apart - plane.z * plane.up;
  // A rope between points above each other hangs in any vertical plane.
  plane.x = std::max(level.norm(), 1e-9 * std::max(length, std::abs(plane.z)));
  const Vector3 any = std::abs(plane.up.x()) < 0.7 ? Vector3::UnitX() : Vector3::UnitY();
  plane.across = level.norm() > 0.0 ? Vector3(level.normalized())
                                    : Vector3((any - any.dot(plane.up) * plane.up).normalized());
  return plane;
}

/// Where the end of a rope of this length is for a tension (h, v) at its start, and the derivatives by
/// h, v and the length.
struct Reached {
  double x = 0.0;
  double z = 0.0;
  Eigen::Matrix<double, 2, 3> slopes;
};

Reached reached(const Plane& plane, double length, double h, double v) {
  const double top = v + plane.w * length;
  const double first = portable::hypot(h, v);
  const double last = portable::hypot(h, top);
  const double span = asinh_of(top / h) - asinh_of(v / h);
  const double stretch = plane.yield * length;
  const double mixed = (h / last - h / first) / plane.w;
  Reached there;
  there.x = h / plane.w * span + h * stretch;
  there.z = (last - first) / plane.w + stretch * (v + 0.5 * plane.w * length);
  there.slopes << (span - top / last + v / first) / plane.w + stretch, mixed,
      h / last + h * plane.yield, mixed, (top / last - v / first) / plane.w + stretch,
      top / last + top * plane.yield;
  return there;
}

/// The tension at the start of a rope of this length: the least of a convex function, the
/// complementary energy.
Eigen::Vector2d by_length(const Plane& plane, double length) {
  const double chord = portable::hypot(plane.x, plane.z);
  const double spare = std::max(length - chord, 1e-14 * chord);
  double tension = plane.w * plane.x * std::sqrt(chord / (24.0 * spare));
  if (plane.yield > 0.0) {
    const double spring = length * plane.yield;
    const double soft = std::cbrt(plane.w * plane.w * plane.x * plane.x * chord / (24.0 * spring));
    tension = std::min(tension, soft + std::max(chord - length, 0.0) / spring);
  }
  double h = std::max(tension * plane.x / chord, 1e-12 * plane.w * length);
  double v = tension * plane.z / chord - 0.5 * plane.w * length;
  for (int round = 0; round < 200; ++round) {
    const Reached there = reached(plane, length, h, v);
    const Eigen::Matrix2d slopes = there.slopes.leftCols<2>();
    if (!(slopes.determinant() > 0.0)) break;
    const Eigen::Vector2d step =
        slopes.inverse() * Eigen::Vector2d(plane.x - there.x, plane.z - there.z);
    double share = 1.0;
    while (h + share * step[0] <= 0.1 * h) share *= 0.5;
    h += share * step[0];
    v += share * step[1];
    constexpr double rounding = 1e-15;
    if (share == 1.0 && step.cwiseAbs().sum() <= rounding * (h + std::abs(v))) break;
  }
  return {h, v};
}

double chord_tension(const Plane& plane, double length, const Eigen::Vector2d& start) {
  return (start[0] * plane.x + (start[1] + 0.5 * plane.w * length) * plane.z) /
         portable::hypot(plane.x, plane.z);
}

/// The tension at the start of a rope with this chord tension, from a length near its own; none if
/// Newton's method does not find it, as for a rope that only just hangs.
std::optional<Eigen::Vector2d> by_tension(const Plane& plane, double length, double tension) {
  const double chord = portable::hypot(plane.x, plane.z);
  const Eigen::Vector2d n(plane.x / chord, plane.z / chord);
  Eigen::Vector3d rope(tension * n[0], tension * n[1] - 0.5 * plane.w * length, length);
  for (int round = 0; round < 50; ++round) {
    const Reached there = reached(plane, rope[2], rope[0], rope[1]);
    Eigen::Matrix3d slopes;
    slopes << there.slopes, n[0], n[1], 0.5 * plane.w * n[1];
    const Eigen::Vector3d off(plane.x - there.x, plane.z - there.z,
                              tension - chord_tension(plane, rope[2], rope.head<2>()));
    const Eigen::Vector3d step = slopes.fullPivLu().solve(off);
    if (!step.allFinite() || rope[0] + step[0] <= 0.0) return std::nullopt;
    rope += step;
    constexpr double rounding = 1e-12;
    if (step.head<2>().norm() <= rounding * tension && std::abs(step[2]) <= rounding * chord) {
      return rope.head<2>();
    }
  }
  return std::nullopt;
}

}  // namespace

namespace {

/// Ends that are above each other but for this share: the mean tension is along the chord.
bool is_vertical(const HungRope& span) {
  constexpr double nearly_vertical = 1e-6;
  const Vector3 apart = span.end - span.start;
  return apart.cross(span.weight).norm() <= nearly_vertical * apart.norm() * span.weight.norm();
}

}  // namespace

bool hangs_in_a_fold(const HungRope& span, double tension, double length) {
  // A taut rope pulls its lower end, so its mean tension is above half of its weight.
  constexpr double rounding_of_weight = 1e-9;
  return is_vertical(span) &&
         tension <= 0.5 * span.weight.norm() * length * (1.0 + rounding_of_weight);
}

double hanging_length(const HungRope& span, double tension) {
  if (const auto lying = lying_between_points(span, tension)) return lying->length;
  // The tension falls with the length, at least that of the stretched chord. The unknown is the
  // logarithm of the excess, with which that of the tension falls about in proportion.
  const double least = (span.end - span.start).norm() / (1.0 + span.yield * tension);
  if (is_vertical(span)) return least;
  const auto length_at = [&](double x) { return least * (1.0 + portable::exp(x)); };
  const auto surplus = [&](double x) {
    const double length = length_at(x);
    const Plane plane = plane_of(span, length);
    const double found = chord_tension(plane, length, by_length(plane, length));
    return (found - tension) / (std::abs(found) + tension);
  };
  double low = portable::log(1e-13);
  double high = portable::log(1e5);
  double above = surplus(low);
  if (above <= 0.0) return least;
  double below = surplus(high);
  // False position by the rule of Illinois; every third round halves, where a secant does not help.
  constexpr double rounding = 1e-13;
  constexpr int most_rounds = 150;
  double x = low;
  int last_side = 0;
  for (int round = 0; round < most_rounds && high - low > rounding; ++round) {
    x = round % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * above / (above - below);
    const double now = surplus(x);
    if (std::abs(now) <= rounding) break;
    const int side = now > 0.0 ? 1 : -1;
    if (side > 0) {
      low = x, above = now;
      if (last_side == side) below *= 0.5;
    } else {
      high = x, below = now;
      if (last_side == side) above *= 0.5;
    }
    last_side = side;
  }
  return length_at(x);
}

HangingForces hanging_forces(const HungRope& span, double tension, double length) {
  if (const auto lying = lying_between_points(span, tension)) return lying->forces;
  if (is_vertical(span)) {
    const Vector3 pull = tension * (span.end - span.start).normalized();
    return {pull + 0.5 * length * span.weight, 0.5 * length * span.weight - pull};
  }
  const Plane plane = plane_of(span, length);
  const Eigen::Vector2d start =
      by_tension(plane, length, tension).value_or(by_length(plane, length));
  HangingForces forces;
  forces.at_start = start[0] * plane.across + start[1] * plane.up;
  forces.at_end = -start[0] * plane.across - (start[1] + plane.w * length) * plane.up;
  return forces;
}

double acting_tension(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span,
                      End when) {
  const double tension = tension_at(evidence, cable, span, when);
  if (!cable.floor || when == last_end) return tension;
  const HungLength slack = hung_length(rope_of(evidence, cable, span, when), span, when, -1.0);
  return slack.slack && span.rest_length[at(when)] >= slack.length ? -1.0 : tension;
}

namespace {

void find_span_loads(const Evidence& evidence, const CableEvidence& evident, SpanEvidence& span) {
  const CableDef& cable = *evident.definition;
  if (!(spring_tension(evidence, cable, span) > 0.0) && !cable.floor) return;
  if (ends_on_wheels(span)) return find_wheel_loads(evidence, evident, span);
  span.loaded_from = span.from.point;
  span.loaded_to = span.to.point;
  for (const End when : {first_end, last_end}) {
    // `rattle` applies half of the load at each end of the substep.
    const double share = share_of(evidence, when);
    const double tension = acting_tension(evidence, cable, span, when);
    const HungRope rope = rope_of(evidence, cable, span, when);
    const double length = span.shares ? hanging_length(rope, tension) : span.rest_length[at(when)];
    const HangingForces forces = hanging_forces(rope, tension, length);
    const Vector3& chord = span.direction[at(when)];
    if (lying_between_points(rope, tension)) {
      span.load_from[at(when)] = share * forces.at_start - span.force[at(when)] * chord;
      span.load_to[at(when)] = share * forces.at_end + span.force[at(when)] * chord;
      continue;
    }
    const Vector3 mean = 0.5 * (forces.at_start - forces.at_end);
    const Vector3 across = mean - chord * chord.dot(mean);
    const Vector3 weight = 0.5 * length * cable.linear_density * evidence.gravity;
    span.load_from[at(when)] = share * (weight + across);
    span.load_to[at(when)] = share * (weight - across);
  }
}

}  // namespace

void find_loads(const Evidence& evidence, CableEvidence& cable) {
  for (SpanEvidence& span : cable.spans) span.told = span.tension();
  if (!(cable.definition->linear_density > 0.0) || is_zero(evidence.gravity)) return;
  share_tensions(evidence, cable);
  for (SpanEvidence& span : cable.spans) find_span_loads(evidence, cable, span);
}

HungRope rope_of(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span,
                 End when) {
  return {span.from.point[at(when)],
          span.to.point[at(when)],
          cable.linear_density * evidence.gravity,
          cable.axial_stiffness ? 1.0 / *cable.axial_stiffness : 0.0,
          cable.floor,
          span.laid};
}

namespace {

/// Square of the stretch of the rope per displacement of its chord: the damper sees the stretch. By
/// differences of the length that a tension needs in this pose.
double stretch_share(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span,
                     End when) {
  const double tension = span.tension();
  const HungRope rope = rope_of(evidence, cable, span, when);
  if (!(tension > 0.0) || !(rope.yield > 0.0) || !(rope.weight.norm() > 0.0)) return 1.0;
  constexpr double part = 1e-3;
  const double fall =
      hanging_length(rope, (1.0 - part) * tension) - hanging_length(rope, (1.0 + part) * tension);
  const double chord = (rope.end - rope.start).norm();
  // A rope without sag has the length c / (1 + T / EA). On a floor the stretch is that of all rope.
  if (lying_between_points(rope, tension)) {
    const double stretch = 2.0 * part * tension * rope.yield * span.rest_length[at(when)] /
                           (1.0 + rope.yield * tension);
    return fall > 0.0 ? std::pow(std::min(stretch / fall, 1.0), 2) : 1.0;
  }
  const double straight = chord / (1.0 + rope.yield * (1.0 - part) * tension) -
                          chord / (1.0 + rope.yield * (1.0 + part) * tension);
  return fall > 0.0 ? std::pow(std::min(straight / fall, 1.0), 2) : 1.0;
}

/// Strain of the rope under the chord tension of its length, at the start of the substep.
double start_strain(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span) {
  const HungRope rope = rope_of(evidence, cable, span, first_end);
  const double length = span.rest_length[first_end];
  if (!(rope.weight.norm() > 0.0) || is_vertical(rope)) {
    return std::max(span.length[first_end] / length - 1.0, 0.0);
  }
  const Plane plane = plane_of(rope, length);
  return rope.yield * chord_tension(plane, length, by_length(plane, length));
}

}  // namespace

double spring_tension(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span) {
  const double spare0 = span.rest_length[first_end] - span.length[first_end];
  const double spare1 = span.rest_length[last_end] - span.length[last_end];
  const double rest_length = span.rest_length[last_end];
  const bool of_material = cable.axial_damping > 0.0 && rest_length > 0.0;
  const double damper = of_material ? cable.axial_damping / rest_length : cable.damping;
  if (damper == 0.0) return span.tension();
  double share = stretch_share(evidence, cable, span, last_end);
  if (evidence.rattle) share = 0.5 * (share + stretch_share(evidence, cable, span, first_end));
  // Rope that comes onto the span brings its strain.
  const double came = rest_length - span.rest_length[first_end];
  const double brought = came != 0.0 ? came * start_strain(evidence, cable, span) : 0.0;
  return span.tension() + share * damper * (spare1 - spare0 + brought) / evidence.h;
}

}  // namespace sheave::certify
