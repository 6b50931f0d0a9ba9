// Ropes with weight that pass pinholes and massless wheels.
//
// Spans between which rope passes freely are a run. Rope that passes moves no body, so only the sum of
// their rest lengths counts, and the potential energy of a run is the least over all ways to share its
// rope. In the minimum the tension is the same on both sides of a pinhole. On a massless wheel the
// tensions have no moment about the axle together with the weight of the rope that lies there:
//
//   T_out - T_in = w s (z_out - z_in),
//
// with the weight w per unstretched length, the strain s of the rope on the wheel as unstretched over
// stretched length, and the heights z of the points of the straight tangents.
//
// So the chord tension U of the first span determines those of all others, T_i = T_i(U). The law of
// the run is one equation for U, the sum of the laws of its spans in unstretched lengths:
//
//   sum_i (L_i - l_i(T_i)) = 0,
//
// with the unstretched length l_i of a catenary. Its spans have tied rows of the weight 1 with the
// multiplier h^2 U. Each pulls along d(force) / dU, and the rest of its force is in its load, as in
// cable/cable_weight.cpp. With `rattle` the law is that of the mean of both ends, with the tensions that
// U gives in the pose of each end.
//
// At the end of the substep rope is moved between the spans until they have these tensions in the
// pose of the end.
//
// A rope that sags has its least end tension, 0.754 w x for a level span x, at a sag of a third of the
// span. A deeper span pulls harder, so rope that passes freely would run into it: the minimum is gone,
// and without inertia of the rope there is no law for that motion. The run of the scene ends there.

#include "cable/heavy_runs.h"

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/heavy_spans.h"
#include "engine/index.h"

namespace sheave {
namespace {

using Ends = std::array<double, 2>;

/// The least derivative of an end tension by the chord tension: 0 is where rope runs out.
constexpr double least_slope = 0.02;

/// Step for derivatives by the chord tension [N].
double step_of(const HeavyShape& shape, double tension) {
  constexpr double share = 1e-5;
  return share * std::max(tension, shape.own_weight());
}

}  // namespace

Ends HeavyShape::ends(double tension) const {
  if (wheels.has_wheels) {
    const WheelCatenary hung = wheel_catenary_of_tension(wheels.span, tension);
    return {hung.first_tension, hung.second_tension};
  }
  const Catenary hung = catenary_of_tension(rope, tension);
  return {hung.start_tension(), hung.end_tension()};
}

HeavyShape::Length HeavyShape::length(double tension) const {
  const auto of = [&](const Catenary& hung, const Excess& excess, double whole, double yield) {
    return Length{whole, (excess.slope - whole * yield) / (1.0 + yield * hung.tension),
                  std::max(hung.start_tension(), hung.end_tension())};
  };
  if (wheels.has_wheels) {
    const WheelCatenary hung = wheel_catenary_of_tension(wheels.span, tension);
    return of(hung.catenary, excess_of(wheels.span, hung, straight), hung.length(),
              wheels.span.yield);
  }
  const Catenary hung = catenary_of_tension(rope, tension);
  return of(hung, excess_of(rope, hung), hung.length, rope.yield);
}

double HeavyShape::own_weight() const {
  return wheels.has_wheels ? wheels.span.weight * wheels.size() : rope.weight * rope.chord();
}

RunTensions::Span RunTensions::next(const HeavyShape& shape, double lift, double guess) {
  Span span;
  const double wanted = arrives_ + lift;
  span.tension = !begun_ ? unknown_ : guess > 0.0 ? guess : std::max(wanted, step_of(shape, 0.0));
  Ends ends = shape.ends(span.tension);
  double step = step_of(shape, span.tension);
  Ends tighter = shape.ends(span.tension + step);
  const auto slope = [&](std::size_t end) { return (tighter[end] - ends[end]) / step; };
  constexpr int most_rounds = 60;
  constexpr double rounding = 4e-14;
  bool begins = true;  // only slopes that rope would run out of have been seen
  double last = RowSettings::unbounded;
  for (int round = 0; begun_ && round < most_rounds; ++round) {
    span.found = slope(0) > least_slope;
    if (!span.found) {
      // Newton's method on a convex function passes no solution from above.
      if (!begins) break;
      span.tension *= 2.0;
    } else {
      begins = false;
      const double change = (ends[0] - wanted) / slope(0);
      const double size = std::abs(change);
      // The last digits are those of the slopes of a rope on wheels.
      constexpr double nearly = 1e-11;
      const bool idle = size >= 0.5 * last && size <= nearly * span.tension;
      if (idle || size <= rounding * std::max(span.tension, std::abs(wanted))) break;
      last = size;
      span.tension = std::max(span.tension - change, 0.5 * span.tension);
    }
    step = step_of(shape, span.tension);
    ends = shape.ends(span.tension);
    tighter = shape.ends(span.tension + step);
  }
  if (begun_) {
    span.weight = slope_ / std::max(slope(0), least_slope);
  } else {
    span.found = slope(1) > least_slope;
  }
  arrives_ = ends[1];
  slope_ = span.weight * slope(1);
  begun_ = true;
  return span;
}

bool share_rope(std::span<SharedSpan> spans) {
  constexpr int most_rounds = 100;
  constexpr double rounding = 1e-15;
  double unknown = spans.front().tension;
  double floor = 0.0;  // a tension at which rope would run out
  bool found = true;
  for (int round = 0; round < most_rounds; ++round) {
    RunTensions tensions(unknown);
    double left = 0.0;
    double whole = 0.0;
    double slope = 0.0;
    found = true;
    for (SharedSpan& span : spans) {
      const auto next = tensions.next(span.shape, span.lift, span.tension);
      const HeavyShape::Length own = span.shape.length(next.tension);
      span.tension = next.tension;
      span.length = own.length;
      span.most = own.most;
      left += own.length - span.rest;
      whole += span.rest;
      slope += own.slope * next.weight;
      found = found && next.found;
    }
    if (!found || !(slope < 0.0)) {
      floor = unknown;
      unknown *= 2.0;
      continue;
    }
    const double change = left / slope;
    if (std::abs(left) <= rounding * whole || std::abs(change) <= rounding * unknown) break;
    unknown = std::max({unknown - change, 0.5 * (unknown + floor), 0.25 * unknown});
    // Halving towards the floor does not find a tension that does not exist.
    if (unknown <= floor * (1.0 + 1e-6)) return false;
  }
  return found;
}

double lift_over(const WheelPlane& wheels, double share, const Vector3& in, const Vector3& out) {
  return wheels.span.weight * share * wheels.radii[0] *
         dot(wheels.up, cross(out - in, wheels.normal));
}

}  // namespace sheave
