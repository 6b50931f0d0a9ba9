#include "cable/wheel_catenary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cable/lying_rope.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr double upright = 0.5 * std::numbers::pi;

struct Slopes {
  double first = 0.0;   ///< [rad]
  double second = 0.0;  ///< [rad]

  [[nodiscard]] double size() const { return std::max(std::abs(first), std::abs(second)); }
};

/// Tension with this potential above the weight, T + e T^2 / 2 = q.
double tension_of(double q, double yield) {
  const double square = std::max(1.0 + 2.0 * yield * q, 1e-12);
  return 2.0 * q / (1.0 + std::sqrt(square));
}

double potential_of(double tension, double yield) {
  return tension * (1.0 + 0.5 * yield * tension);
}

/// The rope on a wheel between two slopes, where its potential is `potential` at height 0.
WheelArc arc_between(const WheelSpan& span, double radius, double center, double from, double to,
                     double potential) {
  // Gauss's rule with five points: the integrands are smooth over a quarter turn.
  constexpr std::array<double, 5> places{0.0, 0.5384693101056831, -0.5384693101056831,
                                         0.9061798459386640, -0.9061798459386640};
  constexpr std::array<double, 5> shares{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                         0.2369268850561891, 0.2369268850561891};
  WheelArc arc;
  if (radius == 0.0 || from == to) return arc;
  const double half = 0.5 * (to - from);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double angle = 0.5 * (from + to) + half * places[i];
    const double height = center + radius * portable::cos(angle);
    const double tension = tension_of(potential + span.weight * height, span.yield);
    const double length = radius * half * shares[i] / (1.0 + span.yield * tension);
    arc.length += length;
    arc.height += height * length;
    arc.energy += 0.5 * span.yield * tension * tension * length;
  }
  return arc;
}

/// Puts the tangent points at these slopes; false if the second is behind the first.
bool put_between(const WheelSpan& span, const Slopes& slopes, WheelCatenary& found) {
  found.first_slope = slopes.first;
  found.second_slope = slopes.second;
  HangingRope& rope = found.rope;
  rope.weight = span.weight;
  rope.yield = span.yield;
  rope.grip = span.grip;
  rope.across = span.across - span.second_radius * portable::sin(slopes.second) +
                span.first_radius * portable::sin(slopes.first);
  rope.clearance = span.clearance + span.first_radius * portable::cos(slopes.first);
  rope.rise = span.rise + span.second_radius * portable::cos(slopes.second) -
              span.first_radius * portable::cos(slopes.first);
  // Tangent points above each other differ by the rounding of the places of the wheels.
  const double size = std::abs(span.across) + std::abs(span.rise) + std::abs(span.first_radius) +
                      std::abs(span.second_radius);
  constexpr double rounding = 1e-14;
  const bool apart = rope.across >= -rounding * size;
  rope.across = std::max(rope.across, 0.0);
  return apart && rope.chord() > rounding * size;
}

/// Finds the arcs, and the tensions at the points of the straight tangent.
void add_arcs(const WheelSpan& span, WheelCatenary& found) {
  const double on_first = span.first_radius * portable::cos(found.first_slope);
  const double potential =
      potential_of(found.catenary.start_tension(), span.yield) - span.weight * on_first;
  found.first_arc =
      arc_between(span, span.first_radius, 0.0, found.first_slope, span.slope, potential);
  found.second_arc =
      arc_between(span, span.second_radius, span.rise, span.slope, found.second_slope, potential);
  const double level = portable::cos(span.slope);
  found.first_tension = tension_of(potential + span.weight * span.first_radius * level, span.yield);
  found.second_tension =
      tension_of(potential + span.weight * (span.rise + span.second_radius * level), span.yield);
}

/// The slopes of the rope at its ends, as far as ends can have them.
Slopes slopes_of(const WheelSpan& span, const WheelCatenary& found) {
  const Catenary& hung = found.catenary;
  const Slopes slopes{slope_of(hung.horizontal, hung.up_at_start(span.weight)),
                      slope_of(hung.horizontal, hung.up_at_end(span.weight))};
  return {std::min(slopes.first, span.slope), std::max(slopes.second, span.slope)};
}

/// Broyden's method for slopes that are those of the rope between their tangent points. The slopes of
/// the rope hardly depend on the places of the tangent points, so it begins with fixed-point rounds.
template <class Hang>
class SlopeSearch {
 public:
  SlopeSearch(const WheelSpan& span, Hang hang) : span_(span), hang_(hang) {}

  WheelCatenary run() {
    constexpr double settled = 1e-15;
    constexpr double nearly_settled = 1e-8;
    constexpr int most_rounds = 100;
    constexpr int most_idle = 8;
    WheelCatenary best;
    best.found = false;
    double least = 1e300;
    Slopes at{span_.slope, span_.slope};
    int idle = 0;
    for (int round = 0; round < most_rounds && idle < most_idle; ++round) {
      WheelCatenary now = now_;
      if (!put_between(span_, at, now)) {
        if (round == 0) break;
        at = {0.5 * (at.first + at_.first), 0.5 * (at.second + at_.second)};
        ++idle;
        continue;
      }
      now.catenary = hang_(now);
      const Slopes wanted = slopes_of(span_, now);
      const Slopes off{at.first - wanted.first, at.second - wanted.second};
      if (round > 0) learn(at, off);
      idle = off.size() < 0.5 * least ? 0 : idle + 1;
      if (off.size() < least) {
        least = off.size();
        best = now;
      }
      now_ = now;
      at_ = at;
      off_ = off;
      if (least <= settled) break;
      at = next();
    }
    best.found = least <= nearly_settled;
    if (!best.found) best = straight();
    add_arcs(span_, best);
    return best;
  }

 private:
  /// Broyden's update of the inverse derivative.
  void learn(const Slopes& at, const Slopes& off) {
    const Slopes moved{at.first - at_.first, at.second - at_.second};
    const Slopes change{off.first - off_.first, off.second - off_.second};
    const Slopes told{inverse_[0] * change.first + inverse_[1] * change.second,
                      inverse_[2] * change.first + inverse_[3] * change.second};
    const double along = moved.first * told.first + moved.second * told.second;
    const double square = moved.first * moved.first + moved.second * moved.second;
    constexpr double least_share = 0.1;
    if (!(along > least_share * square)) return;
    const Slopes row{moved.first * inverse_[0] + moved.second * inverse_[2],
                     moved.first * inverse_[1] + moved.second * inverse_[3]};
    const Slopes rest{(moved.first - told.first) / along, (moved.second - told.second) / along};
    inverse_[0] += rest.first * row.first;
    inverse_[1] += rest.first * row.second;
    inverse_[2] += rest.second * row.first;
    inverse_[3] += rest.second * row.second;
  }

  [[nodiscard]] Slopes next() const {
    const double first = at_.first - inverse_[0] * off_.first - inverse_[1] * off_.second;
    const double second = at_.second - inverse_[2] * off_.first - inverse_[3] * off_.second;
    return {std::clamp(first, -upright, span_.slope), std::clamp(second, span_.slope, upright)};
  }

  /// The rope between the points of the straight tangent.
  WheelCatenary straight() {
    WheelCatenary rope;
    static_cast<void>(put_between(span_, {span_.slope, span_.slope}, rope));
    rope.catenary = hang_(rope);
    rope.found = false;
    return rope;
  }

  const WheelSpan& span_;
  Hang hang_;
  WheelCatenary now_;
  Slopes at_;
  Slopes off_;
  std::array<double, 4> inverse_{1.0, 0.0, 0.0, 1.0};
};

}  // namespace

std::optional<WheelCatenary> slack_on_floor(const WheelSpan& span) {
  WheelCatenary rope;
  if (!(span.clearance < std::numeric_limits<double>::infinity()) ||
      !put_between(span, {std::min(-upright, span.slope), upright}, rope)) {
    return std::nullopt;
  }
  const auto slack = lying_of_tension(rope.rope, 0.0);
  if (!slack) return std::nullopt;
  rope.catenary = *slack;
  rope.catenary.below = 0.0;
  add_arcs(span, rope);
  return rope;
}

double slope_of(double level, double up) { return portable::atan2(up, std::max(level, 0.0)); }

WheelCatenary wheel_catenary_of_length(const WheelSpan& span, double length) {
  // A span that has been drawn in is not shorter than this share of its wheels.
  constexpr double least = 1e-9;
  length = std::max(length, least * (std::abs(span.across) + std::abs(span.rise) +
                                     std::abs(span.first_radius) + std::abs(span.second_radius)));
  if (auto slack = slack_on_floor(span); slack && length >= slack->length()) {
    slack->catenary.length += length - slack->length();
    return *slack;
  }
  return SlopeSearch(span,
                     [&](const WheelCatenary& rope) {
                       // The arcs bear the tension of the last round; at the start they are left out.
                       WheelCatenary now = rope;
                       if (rope.catenary.length > 0.0) add_arcs(span, now);
                       constexpr double least_share = 1e-6;
                       const double left = length - now.first_arc.length - now.second_arc.length;
                       return catenary_of_length(rope.rope, std::max(left, least_share * length));
                     })
      .run();
}

WheelCatenary wheel_catenary_of_tension(const WheelSpan& span, double tension) {
  if (auto slack = slack_on_floor(span); slack && tension <= slack->catenary.tension) {
    slack->catenary.below = slack->catenary.tension - tension;
    return *slack;
  }
  return SlopeSearch(
             span,
             [&](const WheelCatenary& rope) { return catenary_of_tension(rope.rope, tension); })
      .run();
}

Excess excess_of(const WheelSpan& span, const WheelCatenary& rope, double straight) {
  const Excess free = excess_of(rope.rope, rope.catenary);
  const double tension = rope.catenary.tension;
  const double strained = 1.0 + span.yield * tension;
  Excess excess;
  excess.length = rope.length() * strained - straight;
  // The arcs stretch by as much as they become shorter.
  excess.slope = free.slope;
  excess.across = free.across;
  if (rope.catenary.is_slack()) excess.length -= excess.slope * rope.catenary.below;
  return excess;
}

double height_integral(const WheelSpan& span, const WheelCatenary& rope) {
  const double start = span.first_radius * portable::cos(rope.first_slope);
  return rope.first_arc.height + start * rope.catenary.length +
         height_integral(rope.rope, rope.catenary) + rope.second_arc.height;
}

double elastic_energy(const WheelCatenary& rope) {
  return rope.first_arc.energy + elastic_energy(rope.rope, rope.catenary) + rope.second_arc.energy;
}

}  // namespace sheave
