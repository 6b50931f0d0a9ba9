// Ropes with weight on a level floor, computed independently of the solvers: by the vertical loads at
// both ends. With the horizontal component H and the load v of an end, the rope from the floor to the end
// rises by (sqrt(H^2 + v^2) - H) / w + v^2 / 2 EA w, and is H / w asinh(v / H) + H v / EA w wide (J. M.
// Jonkman, NREL/TP-500-41958, section 2.7.2). Bisection finds v for the height of the end, and H for the
// chord tension.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cable/certificate/hanging.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

/// One end of a rope on its floor.
struct LaidEnd {
  double load = 0.0;    ///< [N]
  double slope = 0.0;   ///< below the horizontal, from the end to the floor [rad], >= 0
  double x = 0.0;       ///< of the end [m]
  double height = 0.0;  ///< of the end above the floor [m]
  double width = 0.0;   ///< of the rope from the floor to the end [m]
};

/// `outwards`: -1 at the start, 1 at the end of the span.
LaidEnd laid_end(const FloorEnd& end, double outwards, double w, double yield, double h) {
  const auto at_load = [&](double load) {
    LaidEnd laid;
    laid.load = load;
    laid.slope = h > 0.0 ? portable::atan2(load, h) : load > 0.0 ? 0.5 * std::numbers::pi : 0.0;
    const double slope = outwards * laid.slope;
    laid.x = end.x - end.radius * portable::sin(slope);
    laid.height = std::max(end.height + end.radius * portable::cos(slope), 0.0);
    return laid;
  };
  // A surplus of the height that this load lifts the end to; it rises with the load.
  const auto surplus = [&](const LaidEnd& laid) {
    const double v = laid.load;
    const double lift = v > 0.0 ? v * v / (portable::hypot(h, v) + h) : 0.0;
    return (lift + 0.5 * yield * v * v) / w - laid.height;
  };
  const double most = w * std::max(end.height + std::abs(end.radius), 0.0);
  double low = 0.0;
  double high = std::sqrt(most * (2.0 * h + most)) * (1.0 + 1e-12);
  for (int round = 0; round < 200 && high > low; ++round) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (surplus(at_load(middle)) > 0.0 ? high : low) = middle;
  }
  LaidEnd laid = at_load(high);
  const double v = laid.load;
  const double grown = h > 0.0 ? v / h : 0.0;
  // asinh, also of small numbers
  const double square = grown * grown;
  const double angle = grown < 1e-2 ? grown * (1.0 - square / 6.0 * (1.0 - 0.45 * square))
                                    : portable::log(grown + portable::hypot(1.0, grown));
  laid.width = h / w * angle + yield * h * v / w;
  return laid;
}

/// Unstretched length of rope that lies over the length `left` [m].
double lies(const HungRope& span, double left, double h) {
  double length = left / (1.0 + span.yield * h);
  if (span.laid == nullptr) return length;
  // Newton's method with the strain at the touch-down: the error falls at least as that of a bisection.
  constexpr int rounds = 50;
  for (int round = 0; round < rounds; ++round) {
    const double off = length + span.yield * span.laid->sum(length, h) - left;
    length = std::max(length - off / (1.0 + span.yield * h), 0.0);
    if (std::abs(off) <= 1e-14 * left) break;
  }
  return length;
}

struct Laid {
  std::array<LaidEnd, 2> ends;
  double h = 0.0;
  double across = 0.0;
  double tension = 0.0;  ///< along the chord
};

}  // namespace

std::shared_ptr<const LaidEvidence> laid_evidence(const CableDef& cable, const SpanReport& start,
                                                  const Vector3& gravity) {
  if (start.laid.empty()) return nullptr;
  auto laid = std::make_shared<LaidEvidence>();
  laid->slope = cable.floor_friction * cable.linear_density * gravity.norm();
  for (const SpanReport::Place& place : start.laid) {
    laid->places.push_back({std::abs(place.length - start.laid.front().length), place.tension});
  }
  return laid;
}

double LaidEvidence::sum(double length, double horizontal) const {
  // The rope keeps its tension where the slope allows that. Rope that has come down since was laid with
  // tensions between that of the old touch-down and the new one. Midpoints of many pieces.
  if (!(length > 0.0)) return 0.0;
  constexpr int parts = 4096;
  const double step = length / parts;
  const SpanReport::Place& last = places.back();
  double sum = 0.0;
  std::size_t piece = 1;
  for (int i = 0; i < parts; ++i) {
    const double s = (i + 0.5) * step;
    while (piece < places.size() && places[piece].length < s) ++piece;
    SpanReport::Place from = last;
    SpanReport::Place to{length, horizontal};
    if (piece < places.size()) {
      from = places[piece - 1];
      to = places[piece];
    }
    const double old = from.tension + (to.tension - from.tension) *
                                          ((s - from.length) / (to.length - from.length));
    const double allowed = slope * (length - s);
    sum += std::clamp(old, horizontal - allowed, horizontal + allowed);
  }
  return sum * step;
}

std::optional<LyingRope> lying_rope(const std::array<FloorEnd, 2>& ends, const Vector3& level,
                                    const Vector3& up, const HungRope& span, double tension) {
  const double weight = span.weight.norm();
  const double yield = span.yield;
  const auto laid_with = [&](double h) {
    Laid laid;
    laid.h = h;
    laid.ends = {laid_end(ends[0], -1.0, weight, yield, h),
                 laid_end(ends[1], 1.0, weight, yield, h)};
    laid.across = std::max(laid.ends[1].x - laid.ends[0].x, 0.0);
    const double rise = laid.ends[1].height - laid.ends[0].height;
    const double chord = portable::hypot(laid.across, rise);
    const double turn = 0.5 * (laid.ends[1].load - laid.ends[0].load) * rise;
    laid.tension = chord > 0.0 ? (h * laid.across + turn) / chord : h;
    return laid;
  };
  Laid laid = laid_with(0.0);
  LyingRope rope;
  constexpr double rounding_of_weight = 1e-9;
  const double size = laid.across + laid.ends[0].height + laid.ends[1].height;
  rope.slack =
      tension <= laid.tension * (1.0 + rounding_of_weight) + rounding_of_weight * weight * size;
  if (tension > laid.tension) {
    double low = 0.0;
    double high = tension;
    while (laid_with(high).tension < tension && high < 1e6 * tension) high *= 2.0;
    for (int round = 0; round < 200; ++round) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (laid_with(middle).tension > tension ? high : low) = middle;
    }
    laid = laid_with(high);
  }
  const double left = laid.across - laid.ends[0].width - laid.ends[1].width;
  if (left < 0.0) return std::nullopt;
  rope.length = (laid.ends[0].load + laid.ends[1].load) / weight + lies(span, left, laid.h);
  rope.forces = {laid.h * level - laid.ends[0].load * up, -laid.h * level - laid.ends[1].load * up};
  rope.heights = {laid.ends[0].height, laid.ends[1].height};
  rope.slopes = {-laid.ends[0].slope, laid.ends[1].slope};
  return rope;
}

std::optional<LyingRope> lying_between_points(const HungRope& span, double tension) {
  if (!span.floor) return std::nullopt;
  const double w = span.weight.norm();
  const Vector3 up = -span.weight / w;
  const Vector3 apart = span.end - span.start;
  const Vector3 level = apart - up * apart.dot(up);
  const Vector3 any = std::abs(up.x()) < 0.7 ? Vector3::UnitX() : Vector3::UnitY();
  const Vector3 way = level.norm() > 0.0 ? Vector3(level.normalized())
                                         : Vector3((any - any.dot(up) * up).normalized());
  const std::array<FloorEnd, 2> ends{FloorEnd{0.0, span.start.dot(up) - *span.floor, 0.0},
                                     FloorEnd{level.norm(), span.end.dot(up) - *span.floor, 0.0}};
  return lying_rope(ends, way, up, span, tension);
}

HungLength hung_length(const HungRope& rope, const SpanEvidence& span, End when, double tension) {
  if (ends_on_wheels(span)) {
    const HungOnWheels hung = hung_on_wheels(rope, span, when, tension, span.rest_length[at(when)]);
    return {hung.length, hung.slack};
  }
  if (const auto lying = lying_between_points(rope, tension)) return {lying->length, lying->slack};
  return {hanging_length(rope, tension), false};
}

}  // namespace sheave::certify
