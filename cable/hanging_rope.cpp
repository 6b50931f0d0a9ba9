#include "cable/hanging_rope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/link_contact.h"
#include "cable/lying_rope.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// The vertical plane of a span.
struct SpanPlane {
  Vector3 up;
  Vector3 across;  ///< horizontal, from start to end; any if the ends are above each other
};

SpanPlane plane_of(const SpanGeometry& span, const Vector3& gravity) {
  const Vector3 up = -gravity / gravity.norm();
  const Vector3 apart = span.end - span.start;
  const Vector3 level = apart - dot(apart, up) * up;
  const double across = level.norm();
  if (across > 0.0) return {up, level / across};
  const Vector3 any = std::abs(up.x()) < 0.5 ? Vector3::UnitX() : Vector3::UnitZ();
  return {up, (any - dot(any, up) * up).normalized()};
}

}  // namespace

double weight_of(const CompiledCable& cable, const Vector3& gravity) {
  return cable.linear_density > 0.0 ? cable.linear_density * gravity.norm() : 0.0;
}

HangingRope hanging_rope(const CompiledCable& cable, const Vector3& gravity,
                         const SpanGeometry& span, const FloorGrip& grip) {
  HangingRope rope;
  rope.grip = grip;
  rope.weight = cable.linear_density * gravity.norm();
  rope.yield = cable.inverse_stiffness;
  const Vector3 up = -gravity / gravity.norm();
  const Vector3 apart = span.end - span.start;
  rope.rise = dot(apart, up);
  if (cable.has_floor()) rope.clearance = dot(span.start, up) - cable.floor;
  rope.across = (apart - rope.rise * up).norm();
  return rope;
}

WheelPlane wheel_plane_of(const Substep& substep, const CompiledCable& cable,
                          const SpanSetup& setup, const LinkGeometry& first,
                          const LinkGeometry& second, const SpanGeometry& span,
                          const FloorGrip& grip) {
  if (!first.wraps() && !second.wraps()) {
    WheelPlane points;
    points.span.grip = grip;
    return points;
  }
  const Vector3& normal = setup.normal;
  Vector3 gravity = substep.gravity - normal * dot(normal, substep.gravity);
  // A control can turn gravity until the rope has no weight in the plane.
  constexpr double least_share = 1e-6;
  const double least = least_share * substep.gravity.norm();
  if (gravity.norm() < least) gravity = least * any_perpendicular(normal);
  WheelPlane plane =
      wheel_plane(span, normal, {center_of(substep, first, 0), center_of(substep, second, 0)},
                  {setup.first_radius, setup.second_radius}, gravity);
  plane.span.weight = cable.linear_density * gravity.norm();
  plane.span.yield = cable.inverse_stiffness;
  plane.span.grip = grip;
  if (cable.has_floor()) plane.span.clearance = dot(plane.centers[0], plane.up) - cable.floor;
  return plane;
}

namespace {

// The tension of a rope that only just hangs turns too fast for a linear law.
constexpr double most_turn = 0.2;

/// Slopes of the forces on wheels along the chord, and turning with it. A search for equilibrium goes
/// so far in a round that the slopes of one pose would lead it astray.
std::array<EndForce, 2> chord_pull(const HangingSpan& hanging) {
  const HangingRope& rope = hanging.on_wheels.rope;
  const WheelPlane& plane = hanging.wheels;
  const double across = hanging.excess.across;
  const double turn = std::abs(across) < most_turn ? across : 0.0;
  const Vector3 pull = (rope.across * plane.level + rope.rise * plane.up +
                        turn * (rope.across * plane.up - rope.rise * plane.level)) /
                       rope.chord();
  return {EndForce{pull, hanging.span.start}, EndForce{-pull, hanging.span.end}};
}

}  // namespace

double least_tension(const HangingRope& rope, const WheelPlane& wheels) {
  if (!wheels.has_wheels) return least_tension(rope);
  const auto slack = slack_on_floor(wheels.span);
  return slack ? slack->catenary.tension : 0.0;
}

double usable_tension(const HangingRope& rope, double tension, double room) {
  // On a floor no rope is longer than a slack one.
  if (lying_of_tension(rope, tension)) return tension;
  HangingRope free = rope;
  free.clearance = std::numeric_limits<double>::infinity();
  constexpr double times = 4.0;
  constexpr double least_room = 1e-6;  // of the chord
  const double length = free.chord() * (1.0 + least_room) + times * std::max(room, 0.0);
  if (tension >= tension_bound(free, length)) return tension;
  return std::max(tension, catenary_of_length(free, length).tension);
}

namespace {

/// The excess of the span at the start of the substep under a chord tension.
Excess excess_before(const cable_parts::HangingStart& start, double tension) {
  if (!start.wheels.has_wheels) {
    return excess_of(start.rope, catenary_of_tension(start.rope, tension));
  }
  return excess_of(start.wheels.span, wheel_catenary_of_tension(start.wheels.span, tension),
                   start.rope.chord());
}

}  // namespace

double stretch_share(double compliance, double excess_slope) {
  const double share = compliance / (compliance - excess_slope);
  return share * share;
}

void find_catenary(const Vector3& gravity, bool along_chord, HangingSpan& hanging) {
  if (hanging.wheels.has_wheels) {
    constexpr double share = 1e-5;
    const double step = share * std::max(hanging.tension, hanging.rope.weight * hanging.scale);
    const WheelSpan& span = hanging.wheels.span;
    hanging.on_wheels = wheel_catenary_of_tension(span, hanging.tension);
    hanging.catenary = hanging.on_wheels.catenary;
    hanging.excess = excess_of(span, hanging.on_wheels, hanging.span.length);
    if (hanging.catenary.is_slack()) {
      hanging.slopes = {EndForce{Vector3::Zero(), hanging.span.start},
                        EndForce{Vector3::Zero(), hanging.span.end}};
      return;
    }
    hanging.slopes = along_chord
                         ? chord_pull(hanging)
                         : force_slopes(hanging.wheels, hanging.on_wheels,
                                        wheel_catenary_of_tension(span, hanging.tension + step),
                                        step, hanging.borne);
    return;
  }
  hanging.catenary = catenary_of_tension(hanging.rope, hanging.tension);
  hanging.excess = excess_of(hanging.rope, hanging.catenary);
  const SpanPlane plane = plane_of(hanging.span, gravity);
  if (hanging.catenary.lies) {
    const LyingSlopes slopes = lying_slopes(hanging.rope, hanging.catenary);
    const Vector3 level = slopes.horizontal * plane.across;
    hanging.slopes = {EndForce{level + slopes.start * plane.up, hanging.span.start},
                      EndForce{-level - slopes.end * plane.up, hanging.span.end}};
    return;
  }
  const double chord = hanging.rope.chord();
  if (!(chord > 0.0)) return;
  const Vector3 normal =
      (hanging.rope.across * plane.up - hanging.rope.rise * plane.across) / chord;
  const double turn = std::abs(hanging.excess.across) < most_turn ? hanging.excess.across : 0.0;
  hanging.pull = hanging.span.direction + turn * normal;
}

void sag_at_end(const HangingSpan& hanging, Row& row) {
  row.compliance -= hanging.excess.slope;
  row.value += hanging.excess.slope * hanging.tension - hanging.excess.length;
}

void sag_in_mean(const HangingSpan& hanging, const cable_parts::HangingStart& start, double brought,
                 double h, Row& row) {
  const Excess before = excess_before(start, hanging.tension);
  const double slope = 0.5 * (before.slope + hanging.excess.slope);
  row.compliance = 0.5 * (row.compliance + start.compliance) - slope;
  // The solver multiplies the value at the end by 1 + g, and that at the start by 1 - g.
  const double g = 2.0 * row.compliance * row.damping / h;
  const double sag = before.length + hanging.excess.length;
  row.value += (2.0 * slope * hanging.tension - sag + g * brought) / (1.0 + g);
}

void share_law(const HangingSpan& hanging, const cable_parts::HangingStart& start, double first,
               bool mean, bool rigid, Row& row) {
  const double yield = hanging.rope.yield;
  double compliance = 0.0;
  double residual = 0.0;
  // A run adds up unstretched lengths.
  const auto add = [&](double value, double own, const Excess& excess,
                       const cable_parts::HangingStart::Shared& shared) {
    const double scale = (1.0 + yield * first) / (1.0 + yield * shared.tension);
    compliance += scale * shared.weight * (own - excess.slope);
    residual += scale * (value + own * shared.tension - excess.length);
  };
  add(row.value, row.compliance, hanging.excess, start.now);
  if (mean) {
    add(start.value, start.compliance, excess_before(start, start.then.tension), start.then);
  }
  // The row at the start has counted its value.
  row.value = residual - (mean ? start.value : 0.0) - (rigid ? 0.0 : compliance * start.unknown);
  row.compliance = rigid ? 0.0 : mean ? 0.5 * compliance : compliance;
}

void turn_force(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
                const LinkGeometry& second, Row& row) {
  if (on_one_body(first, second)) return;
  if (hanging.scale > 0.0 || hanging.catenary.lies) {
    const auto& [at_start, at_end] = hanging.slopes;
    add_link_force(substep, row, first, at_start.point, at_start.force);
    add_link_force(substep, row, second, at_end.point, at_end.force);
    add_link_force(substep, row, first, hanging.span.start, -hanging.span.direction);
    add_link_force(substep, row, second, hanging.span.end, hanging.span.direction);
    return;
  }
  const Vector3 turned = hanging.pull - hanging.span.direction;
  add_link_force(substep, row, first, hanging.span.start, turned);
  add_link_force(substep, row, second, hanging.span.end, -turned);
}

void load_ends(const Substep& substep, const HangingSpan& hanging,
               const std::array<StoredLoad, 2>& stored, const LinkGeometry& first,
               const LinkGeometry& second, Row& row) {
  // One multiplier has the loads at both ends of a substep, so the scale is that of the start.
  const double half =
      0.5 * hanging.rope.weight * (hanging.scale > 0.0 ? hanging.scale : hanging.rest_length);
  row.lower = row.upper = half * substep.h * substep.h;
  if (on_one_body(first, second)) return;
  if (hanging.wheels.has_wheels) {
    const auto [at_start, at_end] =
        end_forces(hanging.wheels, hanging.on_wheels, stored, hanging.borne);
    const double told = -hanging.unknown / half;
    add_link_force(substep, row, first, at_start.point, at_start.force / half);
    add_link_force(substep, row, second, at_end.point, at_end.force / half);
    add_link_force(substep, row, first, hanging.slopes[0].point, told * hanging.slopes[0].force);
    add_link_force(substep, row, second, hanging.slopes[1].point, told * hanging.slopes[1].force);
    return;
  }
  const SpanPlane plane = plane_of(hanging.span, substep.gravity);
  const Vector3 mean =
      hanging.catenary.horizontal * plane.across + hanging.catenary.vertical * plane.up;
  if (hanging.scale > 0.0 || hanging.catenary.lies) {
    // A span that shares rope gets the length of its tension at the end of the substep only.
    const Catenary& hung = hanging.catenary;
    const double half_weight =
        hung.lies ? 0.5 * (hung.end_up - hung.start_up) : 0.5 * hanging.rope.weight * hung.length;
    const Vector3 sinks = half_weight * plane.up;
    const auto& [at_start, at_end] = hanging.slopes;
    const double told = hanging.unknown;
    add_link_force(substep, row, first, at_start.point,
                   (mean - sinks - told * at_start.force) / half);
    add_link_force(substep, row, second, at_end.point,
                   (-mean - sinks - told * at_end.force) / half);
    return;
  }
  const Vector3 pull = (mean - hanging.unknown * hanging.pull) / half;
  add_link_force(substep, row, first, hanging.span.start, pull - plane.up);
  add_link_force(substep, row, second, hanging.span.end, -pull - plane.up);
}

Catenary catenary_of(const CompiledCable& cable, const HangingRope& rope, double rest_length,
                     double tension) {
  const bool by_lengths = !(tension > 0.0) || (!cable.is_rigid() && !cable.is_damped());
  return by_lengths ? catenary_of_length(rope, rest_length) : catenary_of_tension(rope, tension);
}

WheelCatenary catenary_of(const CompiledCable& cable, const WheelPlane& wheels, double rest_length,
                          double tension) {
  const bool by_lengths = !(tension > 0.0) || (!cable.is_rigid() && !cable.is_damped());
  return by_lengths ? wheel_catenary_of_length(wheels.span, rest_length)
                    : wheel_catenary_of_tension(wheels.span, tension);
}

namespace {

/// Fills the part of a report that tells of the floor. `start`: where the free rope begins.
void report_floor(const HangingRope& rope, const Catenary& catenary, const Vector3& start,
                  const SpanPlane& plane, SpanReport& span) {
  if (!rope.has_floor()) return;
  span.floored = catenary.floored(rope.weight);
  const double h = catenary.horizontal;
  const auto width = [&](double height) {
    const HungPart part = hung_part(rope, height, h);
    return part.length * (1.0 + rope.yield * h) - part.surplus;
  };
  const Vector3 below = start - rope.clearance * plane.up;
  if (!catenary.lies) {
    // Below the lowest point, so that pictures between two moments show no jump.
    const double drawn = std::max(-catenary.up_at_start(rope.weight), 0.0);
    const double tension = portable::hypot(h, drawn);
    const double depth =
        drawn * drawn / (tension + h) / rope.weight * (1.0 + 0.5 * rope.yield * (tension + h));
    const double beside = drawn > 0.0 ? std::min(width(depth), rope.across) : 0.0;
    span.touches.fill(below + beside * plane.across);
    if (rope.grip.profile != nullptr) {
      span.laid.push_back({rope.grip.at_end ? span.rest_length : 0.0, h});
    }
    return;
  }
  span.touches = {below + width(rope.clearance) * plane.across,
                  below + (rope.across - width(rope.clearance + rope.rise)) * plane.across};
  if (rope.grip.profile == nullptr) return;
  const FloorProfile tensions = lying_tensions(rope, catenary);
  for (std::size_t i = 0; i <= tensions.piece_count(); ++i) {
    const auto [place, tension] = tensions.node(i);
    span.laid.push_back({rope.grip.at_end ? span.rest_length - place : place, tension});
  }
}

}  // namespace

void report_hanging(const CompiledCable& cable, const Vector3& gravity,
                    const SpanGeometry& geometry, const WheelPlane& wheels, SpanTensions tensions,
                    SpanReport& span) {
  span.hangs = true;
  if (wheels.has_wheels) {
    const WheelCatenary rope = catenary_of(cable, wheels, span.rest_length, span.tension);
    if (tensions == SpanTensions::material) span.tension = rope.catenary.tension;
    const auto [at_start, at_end] = end_tensions(wheels, rope);
    span.start_force = at_start;
    span.end_force = at_end;
    const WheelSpan& own = wheels.span;
    report_floor(
        rope.rope, rope.catenary,
        wheels.centers[0] + own.first_radius * (portable::cos(rope.first_slope) * wheels.up -
                                                portable::sin(rope.first_slope) * wheels.level),
        {wheels.up, wheels.level}, span);
    return;
  }
  const HangingRope rope = hanging_rope(cable, gravity, geometry, wheels.span.grip);
  const Catenary catenary = catenary_of(cable, rope, span.rest_length, span.tension);
  if (tensions == SpanTensions::material) span.tension = catenary.tension;
  const SpanPlane plane = plane_of(geometry, gravity);
  const Vector3 level = catenary.horizontal * plane.across;
  report_floor(rope, catenary, geometry.start, plane, span);
  if (catenary.lies) {
    span.start_force = level + catenary.start_up * plane.up;
    span.end_force = -level - catenary.end_up * plane.up;
    return;
  }
  const double half = 0.5 * rope.weight * span.rest_length;
  span.start_force = level + (catenary.vertical - half) * plane.up;
  span.end_force = -level - (catenary.vertical + half) * plane.up;
}

double hanging_energy(const CompiledCable& cable, const Vector3& gravity, const SpanGeometry& span,
                      const WheelPlane& wheels, double rest_length) {
  if (wheels.has_wheels) {
    return elastic_energy(wheel_catenary_of_length(wheels.span, rest_length));
  }
  const HangingRope rope = hanging_rope(cable, gravity, span, wheels.span.grip);
  return elastic_energy(rope, catenary_of_length(rope, rest_length));
}

double hanging_potential(const CompiledCable& cable, const Vector3& gravity,
                         const SpanGeometry& span, const WheelPlane& wheels, double rest_length) {
  if (wheels.has_wheels) {
    const double height = dot(wheels.up, wheels.centers[0]);
    const WheelCatenary rope = wheel_catenary_of_length(wheels.span, rest_length);
    return wheels.span.weight * (rope.length() * height + height_integral(wheels.span, rope));
  }
  const HangingRope rope = hanging_rope(cable, gravity, span, wheels.span.grip);
  const double height = -dot(gravity, span.start) / gravity.norm();
  return rope.weight *
         (rest_length * height + height_integral(rope, catenary_of_length(rope, rest_length)));
}

}  // namespace sheave
