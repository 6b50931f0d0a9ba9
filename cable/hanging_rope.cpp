#include "cable/hanging_rope.h"

#include <algorithm>
#include <cmath>

#include "cable/link_contact.h"

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
                         const SpanGeometry& span) {
  return hanging_rope(cable.linear_density, cable.inverse_stiffness, gravity, span);
}

HangingRope hanging_rope(double density, double yield, const Vector3& gravity,
                         const SpanGeometry& span) {
  HangingRope rope;
  rope.weight = density * gravity.norm();
  rope.yield = yield;
  const Vector3 up = -gravity / gravity.norm();
  const Vector3 apart = span.end - span.start;
  rope.rise = dot(apart, up);
  rope.across = (apart - rope.rise * up).norm();
  return rope;
}

double usable_tension(const HangingRope& rope, double tension, double room) {
  constexpr double times = 4.0;
  constexpr double least_room = 1e-6;  // of the chord
  const double length = rope.chord() * (1.0 + least_room) + times * std::max(room, 0.0);
  return std::max(tension, catenary_of_length(rope, length).tension);
}

void find_catenary(const Vector3& gravity, HangingSpan& hanging) {
  hanging.catenary = catenary_of_tension(hanging.rope, hanging.tension);
  hanging.excess = excess_of(hanging.rope, hanging.catenary);
  const SpanPlane plane = plane_of(hanging.span, gravity);
  const double chord = hanging.rope.chord();
  if (!(chord > 0.0)) return;
  const Vector3 normal =
      (hanging.rope.across * plane.up - hanging.rope.rise * plane.across) / chord;
  // The tension of a rope that only just hangs turns too fast for a linear law.
  constexpr double most_turn = 0.2;
  const double turn = std::abs(hanging.excess.across) < most_turn ? hanging.excess.across : 0.0;
  hanging.pull = hanging.span.direction + turn * normal;
}

void sag_at_end(const HangingSpan& hanging, Row& row) {
  row.compliance -= hanging.excess.slope;
  row.value += hanging.excess.slope * hanging.tension - hanging.excess.length;
}

void sag_in_mean(const HangingSpan& hanging, const cable_parts::HangingStart& start, double h,
                 Row& row) {
  const Excess before = excess_of(start.rope, catenary_of_tension(start.rope, hanging.tension));
  const double slope = 0.5 * (before.slope + hanging.excess.slope);
  row.compliance = 0.5 * (row.compliance + start.compliance) - slope;
  // The solver multiplies the value at the end by 1 + g, and that at the start by 1 - g.
  const double g = 2.0 * row.compliance * row.damping / h;
  row.value += (2.0 * slope * hanging.tension - before.length - hanging.excess.length) / (1.0 + g);
}

void turn_force(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
                const LinkGeometry& second, Row& row) {
  if (on_one_body(first, second)) return;
  const Vector3 turned = hanging.pull - hanging.span.direction;
  add_link_force(substep, row, first, hanging.span.start, turned);
  add_link_force(substep, row, second, hanging.span.end, -turned);
}

void load_ends(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
               const LinkGeometry& second, Row& row) {
  const double half = 0.5 * hanging.rope.weight * hanging.rest_length;
  row.lower = row.upper = half * substep.h * substep.h;
  if (on_one_body(first, second)) return;
  const SpanPlane plane = plane_of(hanging.span, substep.gravity);
  const Vector3 mean =
      hanging.catenary.horizontal * plane.across + hanging.catenary.vertical * plane.up;
  const Vector3 pull = (mean - hanging.tension * hanging.pull) / half;
  add_link_force(substep, row, first, hanging.span.start, pull - plane.up);
  add_link_force(substep, row, second, hanging.span.end, -pull - plane.up);
}

Catenary catenary_of(const CompiledCable& cable, const HangingRope& rope, double rest_length,
                     double tension) {
  const bool by_lengths = !(tension > 0.0) || (!cable.is_rigid() && cable.damping == 0.0);
  return by_lengths ? catenary_of_length(rope, rest_length) : catenary_of_tension(rope, tension);
}

void report_hanging(const CompiledCable& cable, const Vector3& gravity,
                    const SpanGeometry& geometry, SpanTensions tensions, SpanReport& span) {
  const HangingRope rope = hanging_rope(cable, gravity, geometry);
  const Catenary catenary = catenary_of(cable, rope, span.rest_length, span.tension);
  if (tensions == SpanTensions::material) span.tension = catenary.tension;
  const SpanPlane plane = plane_of(geometry, gravity);
  const double half = 0.5 * rope.weight * span.rest_length;
  const Vector3 level = catenary.horizontal * plane.across;
  span.start_force = level + (catenary.vertical - half) * plane.up;
  span.end_force = -level - (catenary.vertical + half) * plane.up;
  span.hangs = true;
}

}  // namespace sheave
