// The first symmetric vibration of a sagging elastic span (H. M. Irvine, Cable Structures, MIT Press
// 1981, section 3.2), with the rope as a chain of small bodies between pieces of cable without weight.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// Irvine's span: l = 100 m, w = 1 N/m, H = 10 kN. The sag is l / 800, so that the parabola and the
/// linear theory are right to (w l / H)^2 = 1e-4.
constexpr double irvine_span = 100.0;
constexpr double irvine_weight = 1.0;
constexpr double irvine_horizontal = 1e4;

/// Frequency of the first symmetric vibration over that of a taut string, w l / pi sqrt(m / H), with
/// `count` pieces in one half of the span. The middle moves up and down only, so the lowest mode of the
/// half is symmetric.
double frequency_on_beads(double parameter, int count) {
  const double ratio = irvine_weight * irvine_span / irvine_horizontal;
  // lambda^2 = (w l / H)^2 EA l / (H l_e) with l_e = l (1 + (w l / H)^2 / 8).
  const double stiffness =
      parameter * irvine_horizontal / (ratio * ratio) * (1.0 + ratio * ratio / 8.0);
  const double stretched = 0.5 * irvine_span * (1.0 + ratio * ratio / 24.0);
  const double piece = stretched / (1.0 + irvine_horizontal / stiffness) / count;
  const double mass = 0.1 * irvine_weight * 0.5 * irvine_span / count;
  std::string bodies;
  std::string links = R"({"type": "attachment", "body": "world"})";
  std::string lengths;
  for (int i = 1; i <= count; ++i) {
    const double x = 0.5 * irvine_span * i / count;
    const double y = -0.5 * irvine_weight * x * (irvine_span - x) / irvine_horizontal;
    const bool middle = i == count;
    bodies += fmt::format(
        R"({}{{"name": "b{}", "mobility": {}, "position": [{}, {}, 0], "mass": {}, "shape": {{"type": "sphere", "radius": 0.01}}}})",
        i > 1 ? "," : "", i,
        middle ? R"("slider", "axis": [0, 1, 0])" : R"("planar", "axis": [0, 0, 1])", x, y,
        middle ? 0.5 * mass : mass);
    links += fmt::format(R"(, {{"type": "attachment", "body": "b{}"}})", i);
    lengths += fmt::format("{}{}", i > 1 ? "," : "", piece);
  }
  Simulation s = simulation_of(fmt::format(
      R"("bodies": [{}], "cables": [{{"name": "line", "axial_stiffness": {}, "rest_lengths": [{}], "links": [{}]}}])",
      bodies, stiffness, lengths, links));
  const Equilibrium rest = find_equilibrium(s);
  EXPECT_TRUE(rest.converged) << rest.message;
  const Modes modes = find_modes(s);
  double least = 1e300;
  for (const Mode& mode : modes.modes) {
    // The small bodies turn freely.
    if (mode.eigenvalue > 1e-3) least = std::min(least, mode.eigenvalue);
  }
  return std::sqrt(least) * irvine_span / std::numbers::pi *
         std::sqrt(0.1 * irvine_weight / irvine_horizontal);
}

TEST(SaggingSpan, HasIrvinesFirstSymmetricVibration) {
  struct Published {
    double parameter = 0.0;
    double ratio = 0.0;
  };
  const std::array<Published, 3> published{
      Published{10.0, 1.34513}, Published{4.0 * std::numbers::pi * std::numbers::pi, 2.0},
      Published{100.0, 2.59719}};
  for (const auto& [parameter, ratio] : published) {
    const double coarse = frequency_on_beads(parameter, 8);
    const double middle = frequency_on_beads(parameter, 16);
    const double fine = frequency_on_beads(parameter, 32);
    // Lumped weights on a polygon are of second order, (pi k / 2 n)^2 / 24 for k half waves. The next
    // order changes the ratio by some (pi k / 2 n)^2 / 2, which is 0.13 for k = 2.6 and n = 8.
    EXPECT_NEAR((coarse - middle) / (middle - fine), 4.0, 0.15) << parameter;
    // The extrapolation leaves the fourth order of 64 pieces, below 1e-5, the five decimals of the
    // published numbers, and the theory's (w l / H)^2 with a factor of order 1.
    EXPECT_NEAR(fine + (fine - middle) / 3.0, ratio, 1e-4 * ratio) << parameter;
  }
}

}  // namespace
}  // namespace sheave
