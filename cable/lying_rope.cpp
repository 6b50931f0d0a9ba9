#include "cable/lying_rope.h"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Below this share of the rope's weight the horizontal component counts as 0.
constexpr double least_share = 1e-12;

/// Length to spare of a slack rope per tension that is asked for below its own one, times w.
constexpr double slack_yield = 1.0;

/// The heights of both ends above the floor [m].
struct Heights {
  double start = 0.0;
  double end = 0.0;
};

Heights heights_of(const HangingRope& rope) {
  return {std::max(rope.clearance, 0.0), std::max(rope.clearance + rope.rise, 0.0)};
}

/// sinh u - u.
double sinh_less_argument(double u, double sinh) {
  if (u > 0.3) return sinh - u;
  // The next term is below 1e-15 of the sum.
  const double square = u * u;
  return u * square / 6.0 *
         (1.0 +
          square / 20.0 * (1.0 + square / 42.0 * (1.0 + square / 72.0 * (1.0 + square / 110.0))));
}

/// u - 2 tanh(u / 2), with the given 2 tanh(u / 2).
double argument_less_tanh(double u, double twice_tanh) {
  if (u > 0.1) return u - twice_tanh;
  // The next term is below 1e-15 of the sum.
  const double v = 0.25 * u * u;
  return u * v *
         (1.0 / 3.0 -
          v * (2.0 / 15.0 - v * (17.0 / 315.0 - v * (62.0 / 2835.0 - v * (1382.0 / 155925.0)))));
}

/// (sinh u cosh u + u) / 2 - sinh u.
double lifted(double u, double sinh, double cosh) {
  if (u > 0.3) return 0.5 * (sinh * cosh + u) - sinh;
  // The sum of (2^(n - 2) - 1) u^n / n! over odd n; the next term is below 1e-15 of the sum.
  const double square = u * u;
  return u * square *
         (1.0 / 6.0 + square * (7.0 / 120.0 +
                                square * (31.0 / 5040.0 +
                                          square * (127.0 / 362880.0 +
                                                    square * (511.0 / 39916800.0 +
                                                              square * (2047.0 / 6227020800.0))))));
}

double width_of(const HangingRope& rope) {
  // Ends above each other count as apart by this share.
  constexpr double least_width = 1e-12;
  const auto [start, end] = heights_of(rope);
  return std::max(rope.across, least_width * (start + end));
}

/// The rope on its floor with this horizontal component.
struct LyingRope {
  HungPart start;
  HungPart end;
  double width = 0.0;
  double horizontal = 0.0;

  LyingRope(const HangingRope& rope, double h) : width(width_of(rope)), horizontal(h) {
    const auto [first, second] = heights_of(rope);
    start = hung_part(rope, first, h);
    end = hung_part(rope, second, h);
  }
  [[nodiscard]] double surplus() const { return start.surplus + end.surplus; }
  [[nodiscard]] double hung() const { return start.length + end.length; }
  [[nodiscard]] double hung_slope() const { return start.length_slope + end.length_slope; }

  /// J of a rope of this unstretched length.
  [[nodiscard]] FloorProfile::Sum laid(const HangingRope& rope, double length) const {
    const double lies = length - hung();
    // A rope that is too short for its floor has the continuation of the same law.
    if (rope.grip.profile == nullptr || lies <= 0.0) return {lies * horizontal, lies, horizontal};
    return rope.grip.profile->limited_sum(lies, horizontal, rope.grip.slope);
  }
  /// L + e (J + s H) - x - g, which is 0 for the length L of the rope.
  [[nodiscard]] double excess(const HangingRope& rope, double length, double sum) const {
    return length - width + rope.yield * (sum + hung() * horizontal) - surplus();
  }
  [[nodiscard]] double length(const HangingRope& rope) const {
    double length = (width + surplus()) / (1.0 + rope.yield * horizontal);
    if (rope.grip.profile == nullptr) return length;
    constexpr int most_rounds = 20;
    constexpr double rounding = 2e-16;
    for (int round = 0; round < most_rounds; ++round) {
      const FloorProfile::Sum sum = laid(rope, length);
      const double change = excess(rope, length, sum.sum) / (1.0 + rope.yield * sum.by_length);
      length -= change;
      if (std::abs(change) <= rounding * length) break;
    }
    return length;
  }
  /// The derivative of excess() by H for a fixed length; > 0.
  [[nodiscard]] double excess_slope(const HangingRope& rope, const FloorProfile::Sum& sum) const {
    const double falls = start.surplus_slope + end.surplus_slope;
    return rope.yield * (sum.by_tension + hung() + hung_slope() * (horizontal - sum.by_length)) -
           falls;
  }
  /// dL / dH
  [[nodiscard]] double length_slope(const HangingRope& rope) const {
    const FloorProfile::Sum sum = laid(rope, length(rope));
    return std::min(-excess_slope(rope, sum) / (1.0 + rope.yield * sum.by_length), 0.0);
  }
  /// Width of the part on the floor [m]; < 0: the rope does not touch it.
  [[nodiscard]] double floored(double yield) const {
    const double strained = 1.0 + yield * horizontal;
    return width - (start.length * strained - start.surplus) -
           (end.length * strained - end.surplus);
  }
  [[nodiscard]] double chord_tension(const HangingRope& rope) const {
    return (horizontal * width + 0.5 * rope.weight * (end.length - start.length) * rope.rise) /
           portable::hypot(width, rope.rise);
  }
  [[nodiscard]] double chord_slope(const HangingRope& rope) const {
    const double turn = 0.5 * rope.weight * (end.length_slope - start.length_slope) * rope.rise;
    // The sum is positive but for steep ropes that their own weight stretches by the ratio of width
    // to half of the rise.
    constexpr double least = 0.1;
    return std::max(width + turn, least * width) / portable::hypot(width, rope.rise);
  }
};

/// A horizontal component at which the slopes of a slack rope are taken [N].
double nearly_slack(const HangingRope& rope) {
  const auto [start, end] = heights_of(rope);
  return least_share * rope.weight * (width_of(rope) + start + end);
}

Catenary catenary_at(const HangingRope& rope, const LyingRope& lying, double length) {
  Catenary catenary;
  catenary.lies = true;
  catenary.length = length;
  catenary.horizontal = lying.horizontal;
  catenary.start_up = -rope.weight * lying.start.length;
  catenary.end_up = rope.weight * lying.end.length;
  catenary.vertical = 0.5 * (catenary.start_up + catenary.end_up);
  catenary.mean_end = 0.5 * (lying.start.tension + lying.end.tension);
  catenary.tension = lying.chord_tension(rope);
  return catenary;
}

/// The root of a function of H that rises, by Newton's method in a bracket. `function` gives value and
/// slope.
template <class Function>
double rising_root(Function function, double start) {
  double low = 0.0;
  double high = 0.0;  // 0: not known
  double h = start;
  double last = h;  // the last change
  for (int round = 0; round < 200; ++round) {
    const auto [value, slope] = function(h);
    if (value == 0.0) return h;
    (value > 0.0 ? high : low) = h;
    double next = slope > 0.0 ? h - value / slope : 1e3 * h;
    const double change = std::abs(next - h);
    // The last digits are those of the rounding of the function.
    constexpr double nearly = 1e-11;
    constexpr double rounding = 2e-16;
    if (change <= rounding * h || (change >= 0.5 * last && change <= nearly * h)) return next;
    last = change;
    if (high == 0.0) next = std::min(next, 1e3 * h);
    if (high > 0.0 && !(next > low && next < high)) {
      next = low > 0.0 ? std::sqrt(low) * std::sqrt(high) : 1e-2 * high;
    }
    h = next;
  }
  return h;
}

struct Sloped {
  double value = 0.0;
  double slope = 0.0;
};

}  // namespace

HungPart hung_part(const HangingRope& rope, double height, double h) {
  const double w = rope.weight;
  const double e = rope.yield;
  HungPart part;
  part.tension = h;
  if (!(height > 0.0)) return part;
  const double strained = 1.0 + e * h;
  const double lift = w * height;
  // T - H, without the difference of nearly equal numbers
  const double more = 2.0 * lift / (strained + std::sqrt(strained * strained + 2.0 * e * lift));
  const double up = std::sqrt(more * (2.0 * h + more));  // w s
  part.tension = h + more;
  part.length = up / w;
  part.length_slope = more / (w * up * (1.0 + e * part.tension));
  const double stretched = e * up * up * up / (6.0 * w * w);
  if (!(h > 0.0)) {
    part.surplus = part.length;
    part.height = 0.5 * up * up / (w * w) + stretched;
    return part;
  }
  const double grown = (more + up) / h;  // exp(u) - 1
  double angle = portable::log(1.0 + grown);
  // Newton's method restores the digits that the sum has lost.
  if (grown < 1.0) angle -= (portable::expm1(angle) - grown) / (1.0 + grown);
  part.surplus = h / w * sinh_less_argument(angle, up / h);
  part.surplus_slope = -(argument_less_tanh(angle, 2.0 * more / up) +
                         more * more * e / (up * (1.0 + e * part.tension))) /
                       w;
  part.height = h / w * (h / w) * lifted(angle, up / h, part.tension / h) + stretched;
  return part;
}

double least_tension(const HangingRope& rope) { return LyingRope(rope, 0.0).chord_tension(rope); }

std::optional<Catenary> lying_of_length(const HangingRope& rope, double length) {
  if (!rope.has_floor()) return std::nullopt;
  const LyingRope slack(rope, 0.0);
  // The parts that hang are shortest without a horizontal component.
  if (length < slack.start.length + slack.end.length) return std::nullopt;
  if (length >= slack.length(rope)) return catenary_at(rope, slack, length);
  const double longer = length - slack.width;
  if (rope.yield == 0.0 && longer <= 0.0) return std::nullopt;
  // The tension of a rope that lies whole, or with short parts that hang as parabolas.
  const double stretched = rope.yield > 0.0 ? -longer / (rope.yield * length) : 0.0;
  const double surplus = slack.start.surplus + slack.end.surplus;
  const double start = std::max({stretched, nearly_slack(rope), rope.weight * surplus});
  const double h = rising_root(
      [&](double at) -> Sloped {
        const LyingRope lying(rope, at);
        const FloorProfile::Sum sum = lying.laid(rope, length);
        return {lying.excess(rope, length, sum.sum), lying.excess_slope(rope, sum)};
      },
      start);
  const LyingRope lying(rope, h);
  if (lying.floored(rope.yield) < 0.0) return std::nullopt;
  return catenary_at(rope, lying, length);
}

std::optional<Catenary> lying_of_tension(const HangingRope& rope, double tension) {
  if (!rope.has_floor()) return std::nullopt;
  const LyingRope slack(rope, 0.0);
  if (tension <= slack.chord_tension(rope)) {
    Catenary catenary = catenary_at(rope, slack, slack.length(rope));
    catenary.below = catenary.tension - tension;
    return catenary;
  }
  const double chord = portable::hypot(slack.width, rope.rise);
  const double h = rising_root(
      [&](double at) -> Sloped {
        const LyingRope lying(rope, at);
        return {lying.chord_tension(rope) - tension, lying.chord_slope(rope)};
      },
      (tension - slack.chord_tension(rope)) * chord / slack.width);
  const LyingRope lying(rope, h);
  if (lying.floored(rope.yield) < 0.0) return std::nullopt;
  return catenary_at(rope, lying, lying.length(rope));
}

LyingSlopes lying_slopes(const HangingRope& rope, const Catenary& catenary) {
  LyingSlopes slopes;
  if (catenary.is_slack()) {
    slopes.length = -slack_yield / rope.weight;
    return slopes;
  }
  const LyingRope lying(rope, std::max(catenary.horizontal, nearly_slack(rope)));
  slopes.horizontal = 1.0 / lying.chord_slope(rope);
  slopes.start = -rope.weight * lying.start.length_slope * slopes.horizontal;
  slopes.end = rope.weight * lying.end.length_slope * slopes.horizontal;
  slopes.length = slopes.horizontal * lying.length_slope(rope);
  return slopes;
}

Excess lying_excess(const HangingRope& rope, const Catenary& catenary) {
  // L (1 + e T) - c, without the difference of nearly equal numbers: with the length l on the floor
  // it is g + e (L (T - H) + l H - J) - z^2 / (c + x).
  const double e = rope.yield;
  const LyingRope now(rope, catenary.horizontal);
  const double x = now.width;
  const double chord = portable::hypot(x, rope.rise);
  const double beside = rope.rise * rope.rise / (chord + x);  // c - x
  const double turn = 0.5 * rope.weight * (now.end.length - now.start.length) * rope.rise;
  const double more = (turn - now.horizontal * beside) / chord;  // T - H
  const double length = now.length(rope);
  const double held = (length - now.hung()) * now.horizontal - now.laid(rope, length).sum;
  const double strained = 1.0 + e * catenary.tension;
  Excess excess;
  excess.length = now.surplus() + e * (length * more + held) - beside;
  // Without friction the sum is not negative. Rope that friction holds stretched is shorter.
  if (rope.grip.profile == nullptr) excess.length = std::max(excess.length, 0.0);
  if (catenary.is_slack()) {
    excess.slope = -slack_yield / rope.weight;
    excess.length -= excess.slope * catenary.below;
    return excess;
  }
  const LyingRope near(rope, std::max(catenary.horizontal, nearly_slack(rope)));
  excess.slope = near.length_slope(rope) / near.chord_slope(rope) * strained + e * length;
  if (rope.grip.profile == nullptr) excess.slope = std::min(excess.slope, 0.0);
  return excess;
}

TouchDown touch_down(const HangingRope& rope, const Catenary& catenary) {
  if (!catenary.lies) {
    const double up =
        rope.grip.at_end ? -catenary.up_at_end(rope.weight) : catenary.up_at_start(rope.weight);
    return {-std::max(up, 0.0) / rope.weight, catenary.horizontal};
  }
  const LyingRope lying(rope, catenary.horizontal);
  const double length = catenary.is_slack() ? lying.length(rope) : catenary.length;
  return {std::max(length - lying.hung(), 0.0), catenary.horizontal};
}

FloorProfile lying_tensions(const HangingRope& rope, const Catenary& catenary) {
  FloorProfile tensions = *rope.grip.profile;
  const auto [length, tension] = touch_down(rope, catenary);
  tensions.limit(length, tension, rope.grip.slope);
  return tensions;
}

double lying_height_integral(const HangingRope& rope, const Catenary& catenary) {
  const LyingRope lying(rope, catenary.horizontal);
  return lying.start.height + lying.end.height - rope.clearance * catenary.length;
}

double lying_energy(const HangingRope& rope, const Catenary& catenary) {
  const double start = -catenary.start_up;
  const double sum = start * start * start + catenary.end_up * catenary.end_up * catenary.end_up;
  double level = catenary.length * catenary.horizontal * catenary.horizontal;
  if (rope.grip.profile != nullptr) {
    const double hung = (start + catenary.end_up) / rope.weight;
    level =
        hung * catenary.horizontal * catenary.horizontal + lying_tensions(rope, catenary).square();
  }
  return 0.5 * rope.yield * (level + sum / (3.0 * rope.weight));
}

}  // namespace sheave
