#include "cable/catenary.h"

#include <algorithm>
#include <cmath>

#include "cable/lying_rope.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr double least_parameter = 1e-18;
constexpr double most_parameter = 50.0;
/// An inextensible rope is longer than its chord by at least this share.
constexpr double least_excess = 1e-13;
/// Ends above each other count as apart by this share of the rope.
constexpr double least_across = 1e-12;

/// The functions of the parameter p in the formulas of the head of the header.
struct Hyperbolics {
  double sinh = 0.0;
  double cosh = 1.0;
  double tanh = 0.0;
  double g = 1.0;  ///< p / tanh p
};

Hyperbolics hyperbolics_at(double p) {
  Hyperbolics shape;
  const double grown = portable::expm1(p);
  const double shrunk = -grown / (grown + 1.0);  // exp(-p) - 1
  shape.sinh = 0.5 * (grown - shrunk);
  shape.cosh = 1.0 + 0.5 * (grown + shrunk);
  shape.tanh = shape.sinh / shape.cosh;
  shape.g = p / shape.tanh;
  return shape;
}

/// g - cosh^2 p, without the difference of two numbers near 1.
double g_less_square(double p, const Hyperbolics& shape) {
  const double square = p * p;
  if (p > 0.1) return shape.g - shape.cosh * shape.cosh;
  // g - 1 = p^2/3 - p^4/45 + 2 p^6/945 - p^8/4725; the next term is below 1e-14 of the first.
  const double g =
      square * (1.0 / 3.0 - square * (1.0 / 45.0 - square * (2.0 / 945.0 - square / 4725.0)));
  return g - shape.sinh * shape.sinh;
}

double derivative_of_g(double p, const Hyperbolics& shape) {
  if (p < 1e-3) return p * (2.0 / 3.0);
  return (shape.sinh * shape.cosh - p) / (shape.sinh * shape.sinh);
}

/// `rope` with ends that are not quite above each other.
HangingRope apart(HangingRope rope, double length) {
  rope.across = std::max(rope.across, least_across * std::max(length, std::abs(rope.rise)));
  return rope;
}

double squared(double number) { return number * number; }

/// (L w / 2 S tanh p)^2 as a function of S and p: the square of the unstretched length that ends in
/// these places need.
double needed_square(const HangingRope& rope, const Hyperbolics& shape, double mean_end) {
  const double stretch = rope.yield * mean_end;
  return squared(rope.rise / (1.0 + stretch)) +
         squared(rope.across * shape.cosh / (shape.g + stretch));
}

Catenary catenary_at(const HangingRope& rope, double p, const Hyperbolics& shape, double length,
                     double mean_end) {
  Catenary catenary;
  catenary.length = length;
  catenary.mean_end = mean_end;
  catenary.parameter = p;
  const double stretch = rope.yield * mean_end;
  const double force = mean_end / length;
  catenary.horizontal = force * rope.across / (shape.g + stretch);
  catenary.vertical = force * rope.rise / (1.0 + stretch);
  const double chord = rope.chord();
  catenary.tension = (catenary.horizontal * rope.across + catenary.vertical * rope.rise) / chord;
  return catenary;
}

/// The chord tension of a taut rope of this length: E = w^2 x^2 c / 24 T^2, so
/// e L T^3 + (L - c) T^2 = w^2 x^2 c / 24.
double taut_tension(const HangingRope& rope, double length) {
  const double chord = rope.chord();
  const double spring = rope.yield * length;
  const double sag = squared(rope.weight * rope.across) * chord / 24.0;
  const double longer = length - chord;
  double tension = 0.0;
  if (spring > 0.0) tension = std::max(std::cbrt(sag / spring), -longer / spring);
  if (longer > 0.0) {
    const double without = std::sqrt(sag / longer);
    tension = spring > 0.0 ? std::min(tension, without) : without;
  }
  return tension;
}

/// A root of a function that increases with ln p: Newton's method in a bracket.
template <class Function>
double root_by_logarithm(Function function, double start) {
  double low = least_parameter;
  double high = most_parameter;
  double p = std::clamp(start, low, high);
  for (int round = 0; round < 100; ++round) {
    const auto [value, slope] = function(p);  // slope: by ln p
    if (value == 0.0) return p;
    (value > 0.0 ? high : low) = p;
    const double step = slope > 0.0 ? -value / slope : 0.0;
    double next = std::abs(step) < 5.0 && step != 0.0 ? p * portable::exp(step) : 0.0;
    if (!(next >= low && next <= high)) next = std::sqrt(low) * std::sqrt(high);
    constexpr double rounding = 2e-16;
    if (std::abs(next - p) <= rounding * p || high - low <= rounding * high) return next;
    p = next;
  }
  return p;
}

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// The mean end tension S of the rope with this parameter and these ends. `mean` is a guess [N]; the
/// last change of Newton's method, which squares the error, is below the share `near`.
double mean_end_at(const HangingRope& rope, const Hyperbolics& shape, double mean, double near) {
  const double scale = 0.5 * rope.weight / shape.tanh;  // S / L
  double most = scale * std::sqrt(needed_square(rope, shape, 0.0));
  if (rope.yield == 0.0) return most;
  // S^2 = scale^2 needed(S), whose right side falls with S.
  double least = 0.0;
  mean = std::min(most, mean);
  for (int round = 0; round < 100; ++round) {
    const double stretch = rope.yield * mean;
    const double up = squared(rope.rise / (1.0 + stretch));
    const double along = squared(rope.across * shape.cosh / (shape.g + stretch));
    const double needed = scale * scale * (up + along);
    const double value = mean * mean - needed;
    (value > 0.0 ? most : least) = mean;
    const double slope = 2.0 * mean + 2.0 * scale * scale * rope.yield *
                                          (up / (1.0 + stretch) + along / (shape.g + stretch));
    double next = mean - value / slope;
    if (!(next >= least && next <= most)) next = 0.5 * (least + most);
    if (std::abs(next - mean) <= near * mean) return next;
    mean = next;
  }
  return mean;
}

/// 2 T c / w as a function of p, as x^2 / (p + s tanh p) + z^2 / ((1 + s) tanh p) with the stretch
/// s = e S. The function falls with p.
struct ScaledTension {
  double value = 0.0;
  double slope = 0.0;  ///< by p, with S as it follows p
  double steep = 0.0;  ///< the part of the value that tends to 0 for large p
};

ScaledTension scaled_tension(const HangingRope& rope, double p, const Hyperbolics& shape,
                             double mean_end) {
  const double s = rope.yield * mean_end;
  const double t = shape.tanh;
  const double t_slope = 1.0 / squared(shape.cosh);
  const double x = squared(rope.across) / (p + s * t);
  const double z = squared(rope.rise) / (1.0 + s);
  const double lean = x / (p + s * t);
  ScaledTension scaled;
  scaled.value = x + z / t;
  // 1 / tanh p - 1, without the difference of two numbers near 1.
  scaled.steep = x + z / (shape.sinh * (shape.sinh + shape.cosh));
  scaled.slope = -lean * (1.0 + s * t_slope) - z * t_slope / squared(t);
  if (s == 0.0) return scaled;
  // s^2 = (e w / 2)^2 N with N = x^2 cosh^2 p / (p + s t)^2 + z^2 / (t (1 + s))^2.
  const double along = lean * squared(shape.cosh);
  const double up = z / ((1.0 + s) * squared(t));
  const double by_p =
      2.0 * along * (t - (1.0 + s * t_slope) / (p + s * t)) - 2.0 * up * t_slope / t;
  const double by_s = 2.0 * (along * t / (p + s * t) + up / (1.0 + s));
  const double s_slope = by_p / (2.0 * (along + up) / s + by_s);
  scaled.slope -= s_slope * (lean * t + z / (t * (1.0 + s)));
  return scaled;
}

}  // namespace

double HangingRope::chord() const { return portable::hypot(across, rise); }

double Catenary::start_tension() const {
  if (lies) return portable::hypot(horizontal, start_up);
  return mean_end - vertical * hyperbolics_at(parameter).tanh;
}

double Catenary::end_tension() const {
  if (lies) return portable::hypot(horizontal, end_up);
  return mean_end + vertical * hyperbolics_at(parameter).tanh;
}

Catenary catenary_of_length(const HangingRope& given, double length) {
  if (const auto lying = lying_of_length(given, length)) return *lying;
  const HangingRope rope = apart(given, length);
  if (rope.yield == 0.0) length = std::max(length, rope.chord() * (1.0 + least_excess));
  const double pull = 0.5 * rope.weight * length;
  const double wanted = 2.0 * portable::log(length);
  const auto too_long = [&](double p) -> ValueAndSlope {
    const Hyperbolics shape = hyperbolics_at(p);
    const double mean_end = pull / shape.tanh;
    const double stretch = rope.yield * mean_end;
    const double up = squared(rope.rise / (1.0 + stretch));
    const double along = squared(rope.across * shape.cosh / (shape.g + stretch));
    const double stretch_slope = -stretch / (shape.sinh * shape.cosh);
    const double slope =
        -2.0 * up * stretch_slope / (1.0 + stretch) +
        2.0 * along *
            (shape.tanh - (derivative_of_g(p, shape) + stretch_slope) / (shape.g + stretch));
    return {portable::log(up + along) - wanted, p * slope / (up + along)};
  };
  const double tension = taut_tension(rope, length);
  const double start =
      tension > 0.0 ? std::min(pull / tension, 1.0 + portable::log(1.0 + pull / tension)) : 1.0;
  const double p = root_by_logarithm(too_long, start);
  const Hyperbolics shape = hyperbolics_at(p);
  return catenary_at(rope, p, shape, length, pull / shape.tanh);
}

Catenary catenary_of_tension(const HangingRope& given, double tension) {
  if (const auto lying = lying_of_tension(given, tension)) return *lying;
  const HangingRope rope = apart(given, given.chord());
  const double wanted = 2.0 * tension * rope.chord() / rope.weight;
  double mean_end = std::max(tension, 0.0);
  // The tension less that of a rope with p = infinity.
  const auto left = [&] { return wanted - squared(rope.rise) / (1.0 + rope.yield * mean_end); };
  double low = least_parameter;
  double high = most_parameter;
  double p = 1.0;
  if (const double rest = left(); rest > 0.0) {
    // The parameters of ropes with one of both parts of this tension: neither is too large.
    const double z = squared(rope.rise);
    p = std::max(
        {0.5 * portable::log(1.0 + 2.0 * z / rest), z / (z + rest), squared(rope.across) / rest});
    p = std::clamp(p, low, high);
  }
  double last_step = high;
  constexpr int free_rounds =
      4;  // Newton's method rarely needs more, and may take long steps at first
  for (int round = 0; round < 100; ++round) {
    const Hyperbolics shape = hyperbolics_at(p);
    mean_end = mean_end_at(rope, shape, mean_end, 1e-9);
    const ScaledTension scaled = scaled_tension(rope, p, shape, mean_end);
    const double value = scaled.value - wanted;
    (value > 0.0 ? low : high) = p;
    // Newton's method; where it can, for 1 / steep, which is nearly linear in p. Far above the root,
    // where steep may fall as exp(-p), it goes below the root at once.
    const double rest = left();
    const double share = rest > 0.0 ? scaled.steep / rest : 1.0;
    double next = share < 0.5 ? p * share : p - value / scaled.slope * share;
    const bool slow = round >= free_rounds && std::abs(next - p) > 0.5 * last_step;
    if (slow || !(next >= low && next <= high)) next = std::sqrt(low) * std::sqrt(high);
    last_step = std::abs(next - p);
    const bool found = last_step <= 1e-9 * p;
    p = next;
    if (found) break;
  }
  const Hyperbolics shape = hyperbolics_at(p);
  mean_end = mean_end_at(rope, shape, mean_end, 1e-9);
  return catenary_at(rope, p, shape, 2.0 * mean_end * shape.tanh / rope.weight, mean_end);
}

double tension_bound(const HangingRope& given, double length) {
  // An inextensible rope has T = w (x^2 / p + z^2 / tanh p) / 2 c and (L^2 - z^2) / x^2 =
  // (sinh p / p)^2, where sinh p / p < exp(p^2 / 6) and 1 / tanh p < 1 + 1 / p. A rope that stretches
  // sags more.
  const HangingRope rope = apart(given, length);
  const double rise = std::abs(rope.rise);
  const double longer = std::sqrt((length - rise) * (length + rise)) / rope.across;
  const double p = std::sqrt(6.0 * portable::log(longer));
  const double chord = rope.chord();
  return 0.5 * rope.weight * (chord / p + rise * rise / chord);
}

Excess excess_of(const HangingRope& given, const Catenary& catenary) {
  if (catenary.lies) return lying_excess(given, catenary);
  const HangingRope rope = apart(given, catenary.length);
  const Hyperbolics shape = hyperbolics_at(catenary.parameter);
  const double h = catenary.horizontal;
  const double v = catenary.vertical;
  const double s = catenary.mean_end;
  const double length = catenary.length;
  const double ends = s * s - squared(v * shape.tanh);  // product of the end tensions
  // The flexibility d(x, z) / d(H, V) at a fixed length.
  const double rising = length / s * squared(h * shape.cosh) / ends;
  const double mixed = -length / s * h * v / ends;
  const double g_less_1 = g_less_square(catenary.parameter, shape) + squared(shape.sinh);
  const double along = length / s * (g_less_1 + squared(v / shape.cosh) / ends);
  const double stretch = rope.yield * length;
  const double xx = along + stretch;
  const double zz = rising + stretch;
  // d(x, z) / dL at fixed forces.
  const double x_by_length = h * (s / ends + rope.yield);
  const double z_by_length = v * (s / squared(shape.cosh) / ends + rope.yield);
  const double chord = rope.chord();
  const double nx = rope.across / chord;
  const double nz = rope.rise / chord;
  const double determinant = xx * zz - mixed * mixed;
  // -d(H, V) / dL = F^-1 d(x, z) / dL, and -dT / dL its component along the chord.
  const double h_falls = (zz * x_by_length - mixed * z_by_length) / determinant;
  const double v_falls = (xx * z_by_length - mixed * x_by_length) / determinant;
  const double falling = nx * h_falls + nz * v_falls;
  Excess excess;
  const double strain = rope.yield * catenary.tension;
  excess.length = std::max(length * (1.0 + strain) - given.chord(), 0.0);
  excess.slope = std::min(stretch - (1.0 + strain) / falling, 0.0);
  excess.across = (nx * v_falls - nz * h_falls) / falling;
  return excess;
}

double height_integral(const HangingRope& given, const Catenary& catenary) {
  if (catenary.lies) return lying_height_integral(given, catenary);
  const HangingRope rope = apart(given, catenary.length);
  const Hyperbolics shape = hyperbolics_at(catenary.parameter);
  const double s = catenary.mean_end;
  const double sag = squared(catenary.horizontal) * g_less_square(catenary.parameter, shape) /
                     (4.0 * s * s * shape.tanh);
  const double chord = 0.5 * catenary.vertical / s;
  const double length = catenary.length;
  const double stretch = rope.yield * (0.5 * catenary.vertical - rope.weight * length / 12.0);
  return length * length * (sag + chord + stretch);
}

double elastic_energy(const HangingRope& rope, const Catenary& catenary) {
  if (catenary.lies) return lying_energy(rope, catenary);
  const double square_mean = squared(catenary.horizontal) + squared(catenary.vertical) +
                             squared(rope.weight * catenary.length) / 12.0;
  return 0.5 * rope.yield * catenary.length * square_mean;
}

}  // namespace sheave
