// Ropes with weight on wheels, computed independently of the solvers. The tension at the start and
// the unstretched length of the free rope give the slopes at both ends, and so the tangent points.
// Newton's method makes the rope end at the second tangent point with the chord tension. Along the
// wheels the tension follows from the weight alone: T + T^2 / 2 EA differs by weight times height.

#include <cmath>
#include <optional>

#include <Eigen/Core>
#include <Eigen/LU>

#include "cable/certificate/hanging.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

/// The vertical plane of a span, with coordinates (x, z) against the first centre.
struct WheelPair {
  Vector3 up = Vector3::UnitY();
  Vector3 level = Vector3::UnitX();
  double w = 0.0;
  double yield = 0.0;
  std::array<Eigen::Vector2d, 2> centers;
  std::array<double, 2> radii{};  ///< > 0: the rope lies on the upper side
  double slope = 0.0;             ///< of the straight tangent [rad]
};

Vector3 direction_of(const SpanEvidence& span, End when) {
  return (span.to.point[at(when)] - span.from.point[at(when)]).normalized();
}

WheelPair pair_of(const HungRope& rope, const SpanEvidence& span, End when) {
  WheelPair pair;
  pair.w = rope.weight.norm();
  pair.yield = rope.yield;
  pair.up = -rope.weight / pair.w;
  const Vector3 way = direction_of(span, when);
  const SpanSide& wheel = span.from.radius[at(when)] > 0.0 ? span.from : span.to;
  pair.level = wheel.normal[at(when)].cross(pair.up).normalized();
  if (pair.level.dot(way) < 0.0) pair.level = -pair.level;
  pair.slope = portable::atan2(way.dot(pair.up), std::max(way.dot(pair.level), 0.0));
  const Vector3 left = way.dot(pair.level) * pair.up - way.dot(pair.up) * pair.level;
  const auto place = [&](const SpanSide& side, std::size_t end) {
    const Vector3 apart = side.center[at(when)] - span.from.center[at(when)];
    const bool round = side.radius[at(when)] > 0.0;
    const Vector3 point = side.point[at(when)] - span.from.center[at(when)];
    pair.centers[end] = round ? Eigen::Vector2d(apart.dot(pair.level), apart.dot(pair.up))
                              : Eigen::Vector2d(point.dot(pair.level), point.dot(pair.up));
    // The point of the straight tangent tells the side of the wheel.
    const double beside = left.dot(side.point[at(when)] - side.center[at(when)]);
    pair.radii[end] = !round ? 0.0 : beside > 0.0 ? side.radius[at(when)] : -side.radius[at(when)];
  };
  place(span.from, 0);
  place(span.to, 1);
  return pair;
}

Eigen::Vector2d on_wheel(const WheelPair& pair, std::size_t end, double slope) {
  return pair.centers[end] +
         pair.radii[end] * Eigen::Vector2d(-portable::sin(slope), portable::cos(slope));
}

/// A free rope by its tension at the start (h, v) and its unstretched length.
struct FreeRope {
  double h = 0.0;
  double v = 0.0;
  double length = 0.0;
};

std::array<double, 2> slopes_of(const WheelPair& pair, const FreeRope& rope) {
  return {portable::atan2(rope.v, rope.h), portable::atan2(rope.v + pair.w * rope.length, rope.h)};
}

/// asinh of the tangent of a slope.
double stretched_slope(double tangent) {
  const double size = portable::log(std::abs(tangent) + portable::hypot(1.0, tangent));
  return tangent < 0.0 ? -size : size;
}

/// Where the rope ends, from where it ought to, and its chord tension.
Eigen::Vector3d off(const WheelPair& pair, const FreeRope& rope) {
  const auto slopes = slopes_of(pair, rope);
  const Eigen::Vector2d chord = on_wheel(pair, 1, slopes[1]) - on_wheel(pair, 0, slopes[0]);
  const double top = rope.v + pair.w * rope.length;
  const double first = portable::hypot(rope.h, rope.v);
  const double last = portable::hypot(rope.h, top);
  const double x =
      rope.h / pair.w * (stretched_slope(top / rope.h) - stretched_slope(rope.v / rope.h)) +
      pair.yield * rope.h * rope.length;
  // last - first, without the difference of nearly equal numbers
  const double rise = (top * top - rope.v * rope.v) / (last + first);
  const double middle = rope.v + 0.5 * pair.w * rope.length;
  const double z = rise / pair.w + pair.yield * rope.length * middle;
  return {x - chord.x(), z - chord.y(), (rope.h * chord.x() + middle * chord.y()) / chord.norm()};
}

/// The rope with this chord tension, by Newton's method with differences.
FreeRope rope_with(const WheelPair& pair, double tension, double length) {
  const double level = portable::cos(pair.slope);
  // A span that is all but used up has no length to begin with.
  constexpr double least_share = 1e-6;
  const double chord = (on_wheel(pair, 1, pair.slope) - on_wheel(pair, 0, pair.slope)).norm();
  length = std::max(length, least_share * chord);
  FreeRope rope{std::max(tension * level, 1e-9 * tension),
                tension * portable::sin(pair.slope) - 0.5 * pair.w * length, length};
  if (!(rope.h > 0.0) || !(rope.length > 0.0)) return rope;
  for (int round = 0; round < 50; ++round) {
    Eigen::Vector3d wrong = off(pair, rope);
    wrong[2] -= tension;
    Eigen::Matrix3d slopes;
    const double h = 1e-6 * rope.h;
    const double v = 1e-6 * tension;
    const double l = 1e-6 * rope.length;
    slopes.col(0) = (off(pair, {rope.h + h, rope.v, rope.length}) -
                     off(pair, {rope.h - h, rope.v, rope.length})) /
                    (2.0 * h);
    slopes.col(1) = (off(pair, {rope.h, rope.v + v, rope.length}) -
                     off(pair, {rope.h, rope.v - v, rope.length})) /
                    (2.0 * v);
    slopes.col(2) = (off(pair, {rope.h, rope.v, rope.length + l}) -
                     off(pair, {rope.h, rope.v, rope.length - l})) /
                    (2.0 * l);
    const Eigen::Vector3d step = slopes.fullPivLu().solve(-wrong);
    if (!step.allFinite()) break;
    double share = 1.0;
    while (rope.h + share * step[0] <= 0.1 * rope.h ||
           rope.length + share * step[2] <= 0.1 * rope.length) {
      share *= 0.5;
    }
    rope.h += share * step[0];
    rope.v += share * step[1];
    rope.length += share * step[2];
    constexpr double rounding = 1e-13;
    if (step.head<2>().norm() <= rounding * tension && std::abs(step[2]) <= rounding * length)
      break;
  }
  return rope;
}

double tension_at(const WheelPair& pair, double potential) {
  return pair.yield > 0.0 ? 2.0 * potential /
                                (1.0 + std::sqrt(std::max(1.0 + 2.0 * pair.yield * potential, 0.0)))
                          : potential;
}

/// Unstretched length on a wheel between two slopes, by Simpson's rule.
double arc_between(const WheelPair& pair, std::size_t end, double from, double to,
                   double potential) {
  constexpr int parts = 32;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    const double height = on_wheel(pair, end, from + (to - from) * i / parts).y();
    const double factor = i == 0 || i == parts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += factor / (1.0 + pair.yield * tension_at(pair, potential + pair.w * height));
  }
  return pair.radii[end] * (to - from) * sum / (3.0 * parts);
}

/// The same of a rope that lies in part on its floor, whose height against the first centre is `floor`.
std::optional<HungOnWheels> laid(const HungRope& span, const WheelPair& pair, double floor,
                                 double tension) {
  const auto end_at = [&](std::size_t end) {
    return FloorEnd{pair.centers[end].x(), pair.centers[end].y() - floor, pair.radii[end]};
  };
  const auto rope = lying_rope({end_at(0), end_at(1)}, pair.level, pair.up, span, tension);
  if (!rope) return std::nullopt;
  const double start = rope->forces.at_start.norm();
  const double potential =
      start * (1.0 + 0.5 * pair.yield * start) - pair.w * (rope->heights[0] + floor);
  HungOnWheels result;
  result.forces = rope->forces;
  result.slack = rope->slack;
  result.arcs = {arc_between(pair, 0, rope->slopes[0], pair.slope, potential),
                 arc_between(pair, 1, pair.slope, rope->slopes[1], potential)};
  for (const std::size_t end : {0U, 1U}) {
    const double height = on_wheel(pair, end, pair.slope).y();
    result.tensions[end] = tension_at(pair, potential + pair.w * height);
  }
  result.length = result.arcs[0] + rope->length + result.arcs[1];
  return result;
}

HungOnWheels hung(const WheelPair& pair, double tension, double length) {
  const FreeRope rope = rope_with(pair, tension, length);
  const auto slopes = slopes_of(pair, rope);
  const double start = portable::hypot(rope.h, rope.v);
  const double potential =
      start * (1.0 + 0.5 * pair.yield * start) - pair.w * on_wheel(pair, 0, slopes[0]).y();
  HungOnWheels result;
  result.forces = {rope.h * pair.level + rope.v * pair.up,
                   -rope.h * pair.level - (rope.v + pair.w * rope.length) * pair.up};
  result.arcs = {arc_between(pair, 0, slopes[0], pair.slope, potential),
                 arc_between(pair, 1, pair.slope, slopes[1], potential)};
  for (const std::size_t end : {0U, 1U}) {
    const double height = on_wheel(pair, end, pair.slope).y();
    result.tensions[end] = tension_at(pair, potential + pair.w * height);
  }
  result.length = result.arcs[0] + rope.length + result.arcs[1];
  return result;
}

/// The weight of the rope stored on a wheel, and its moment about the centre.
struct Stored {
  Vector3 weight = Vector3::Zero();
  Vector3 moment = Vector3::Zero();
};

/// Between two spans the rope lies on the arc between their points. At an end of the rope it lies all
/// round the drum, so that only the point where it leaves has a moment.
Stored stored_on(const CableEvidence& cable, const SpanSide& wheel, const Vector3& weight,
                 End when) {
  Stored stored;
  const double radius = wheel.radius[at(when)];
  if (!(radius > 0.0)) return stored;
  stored.weight = wheel.stored[at(when)] * weight;
  const double lies = wheel.lies[at(when)];
  const double share = lies > 0.0 ? wheel.stored[at(when)] / lies : 1.0;
  Vector3 turned = Vector3::Zero();
  for (const SpanEvidence& span : cable.spans) {
    if (span.to.link == wheel.link) turned += direction_of(span, when);
    if (span.from.link == wheel.link) turned -= direction_of(span, when);
  }
  stored.moment = share * radius * radius * turned.cross(weight);
  return stored;
}

struct Load {
  Vector3 force = Vector3::Zero();
  Vector3 point = Vector3::Zero();
};

}  // namespace

bool ends_on_wheels(const SpanEvidence& span) {
  return span.from.radius[last_end] > 0.0 || span.to.radius[last_end] > 0.0;
}

HungOnWheels hung_on_wheels(const HungRope& rope, const SpanEvidence& span, End when,
                            double tension, double length) {
  const WheelPair pair = pair_of(rope, span, when);
  if (rope.floor) {
    const double floor = *rope.floor - span.from.center[at(when)].dot(pair.up);
    if (const auto lying = laid(rope, pair, floor, tension)) return *lying;
  }
  return hung(pair, tension, length);
}

void find_wheel_loads(const Evidence& evidence, const CableEvidence& cable, SpanEvidence& span) {
  const bool last = &span == &cable.spans.back() && !cable.start.closed;
  span.from.strain = span.to.strain = 0.0;
  span.from.above = span.to.above = 0.0;
  for (const End when : {first_end, last_end}) {
    const double share = share_of(evidence, when);
    const double tension = acting_tension(evidence, *cable.definition, span, when);
    const HungRope rope = rope_of(evidence, *cable.definition, span, when);
    const HungOnWheels on = hung_on_wheels(rope, span, when, tension, span.rest_length[at(when)]);
    // The rest of the balance has the reported force along the straight tangent.
    const bool floored = cable.definition->floor && share > 0.0;
    const double told_force = floored ? span.force[at(when)] / share : tension;
    const Vector3 pull = told_force * span.direction[at(when)];
    const auto load_of = [&](SpanSide& side, std::size_t end, bool carries) {
      const Stored stored = carries ? stored_on(cable, side, rope.weight, when) : Stored{};
      const Vector3& drawn = end == 0 ? on.forces.at_start : on.forces.at_end;
      const Vector3 told = end == 0 ? pull : Vector3(-pull);
      const Vector3 way = (end == 0 ? 1.0 : -1.0) * direction_of(span, when);
      side.strain += share * rope.yield * on.tensions[end];
      side.above += share * (on.tensions[end] - tension);
      // About the centre the tension at the point of the straight tangent has the moment of tension
      // and additional arc together.
      const Vector3 arm = side.point[at(when)] - side.center[at(when)];
      Load load{drawn + on.arcs[end] * rope.weight + stored.weight - told, side.point[at(when)]};
      if (side.radius[at(when)] > 0.0) {
        const Vector3 moment = arm.cross(on.tensions[end] * way - told) + stored.moment;
        const double square = load.force.squaredNorm();
        load.point = side.center[at(when)];
        if (square > 0.0) load.point += load.force.cross(moment) / square;
      }
      load.force *= share;
      return load;
    };
    const Load from = load_of(span.from, 0, true);
    const Load to = load_of(span.to, 1, last);
    span.load_from[at(when)] = from.force;
    span.loaded_from[at(when)] = from.point;
    span.load_to[at(when)] = to.force;
    span.loaded_to[at(when)] = to.point;
  }
}

}  // namespace sheave::certify
