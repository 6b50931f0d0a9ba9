// Spans of a rope with weight that share their rope (cable/heavy_runs.cpp).

#include "cable/heavy_runs.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave::heavy_runs {
namespace {

constexpr double g = 9.81;
constexpr double weight = 3.0 * g;
constexpr double yield = 1e-8;

HeavyShape shape_of(double across, double rise, double w = weight, double e = yield) {
  HeavyShape shape;
  shape.rope = {across, rise, w, e};
  shape.straight = shape.rope.chord();
  return shape;
}

/// A rope from (0, 30) through eyes at (40, 34) and (90, 31) down to a counterweight at (90, 12).
std::array<SharedSpan, 3> track() {
  std::array<SharedSpan, 3> spans;
  spans[0].shape = shape_of(40.0, 4.0);
  spans[1].shape = shape_of(50.0, -3.0);
  spans[2].shape = shape_of(0.0, -19.0);
  return spans;
}

TEST(HeavyRun, SharesItsRopeAsAnotherProgramDoes) {
  // SciPy's fsolve for H and L of each span with T + T^2 / 2 EA - w z of 2000 kg at z = 12:
  //   T1 = T(z1); H = T1 cos a; V = T1 sin a; T2 = hypot(H, V + w L);
  //   x = H / w (asinh((V + w L) / H) - asinh(V / H)) + H L / EA; z = (T2 - T1) / w + L (V + w L / 2) / EA
  const std::array<double, 3> lengths{40.197068220623024, 50.09085453863464, 18.99621984165248};
  std::array<SharedSpan, 3> spans = track();
  const std::array<double, 3> off{3.0, -2.5, -0.5};
  for (const std::size_t i : {0U, 1U, 2U}) spans[i].rest = lengths[i] + off[i];
  // A guess that is wrong by an order of magnitude in either direction.
  for (const double guess : {2e3, 2e5}) {
    spans[0].tension = guess;
    ASSERT_TRUE(share_rope(spans));
    // Residuals of 1e-13 m of a total stiffness of 5 mm/kN.
    for (const std::size_t i : {0U, 1U, 2U}) EXPECT_NEAR(spans[i].length, lengths[i], 1e-11);
    EXPECT_NEAR(spans[0].shape.ends(spans[0].tension)[0], 20149.63468311069, 1e-6);
    EXPECT_NEAR(spans[1].shape.ends(spans[1].tension)[0], 20267.33089849126, 1e-6);
    EXPECT_NEAR(spans[2].shape.ends(spans[2].tension)[1], 2000.0 * g, 1e-6);
  }
}

/// Elastic energy and weight of a span of this length whose start has a height.
double energy_of(const HeavyShape& shape, double length, double height) {
  const Catenary hung = catenary_of_length(shape.rope, length);
  return elastic_energy(shape.rope, hung) +
         shape.rope.weight * (length * height + height_integral(shape.rope, hung));
}

TEST(HeavyRun, HasTheLeastEnergyOfAllWaysToShareItsRope) {
  std::array<SharedSpan, 3> spans = track();
  for (SharedSpan& span : spans) span.rest = 1.004 * span.shape.straight;
  spans[0].tension = 1e4;
  ASSERT_TRUE(share_rope(spans));
  const std::array<double, 3> heights{30.0, 34.0, 31.0};
  const auto energy = [&](std::size_t from, std::size_t to, double moved) {
    return energy_of(spans[from].shape, spans[from].length - moved, heights[from]) +
           energy_of(spans[to].shape, spans[to].length + moved, heights[to]);
  };
  for (const auto& [from, to] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{0U, 2U}}) {
    const double least = energy(from, to, 0.0);
    const double more = energy(from, to, 1e-4) - least;
    const double less = energy(from, to, -1e-4) - least;
    EXPECT_GT(more, 0.0);
    EXPECT_GT(less, 0.0);
    // A slope would make them differ by its double; the third order is 1e-4 m over the excess of
    // 4 mm per metre and span.
    EXPECT_NEAR(more / less, 1.0, 0.05);
  }
}

TEST(HeavyRun, HasTensionsWithTheDerivativesOfFiniteDifferences) {
  for (const double tension : {2e3, 5e3, 1e5}) {
    const auto tensions = [&](double unknown) {
      RunTensions run(unknown);
      std::array<RunTensions::Span, 3> found;
      const std::array<SharedSpan, 3> spans = track();
      for (const std::size_t i : {0U, 1U, 2U})
        found[i] = run.next(spans[i].shape, 7.0 * static_cast<double>(i), 0.0);
      return found;
    };
    const double step = 1e-3 * tension;
    const auto now = tensions(tension);
    const auto more = tensions(tension + step);
    const auto less = tensions(tension - step);
    for (const std::size_t i : {1U, 2U}) {
      EXPECT_TRUE(now[i].found);
      // One-sided steps of 1e-5 against central ones of 1e-3.
      EXPECT_NEAR(now[i].weight, (more[i].tension - less[i].tension) / (2.0 * step), 2e-5);
    }
  }
}

TEST(HeavyRun, FindsNoTensionBelowTheLeastThatALevelSpanCanHave) {
  // T = H cosh(w x / 2 H) of a level inextensible span x is least at w x / 2 H = 1.19968: 0.75444 w x.
  const double least = 0.75444 * weight * 20.0;
  for (const double share : {0.98, 1.02}) {
    RunTensions run(share * least + 0.5 * weight);
    // A rope of 1 m that hangs straight down has at its end its chord tension less half its weight.
    static_cast<void>(run.next(shape_of(0.0, -1.0, weight, 0.0), 0.0, 0.0));
    const RunTensions::Span level = run.next(shape_of(20.0, 0.0, weight, 0.0), 0.0, 0.0);
    EXPECT_EQ(level.found, share > 1.0) << share;
    EXPECT_TRUE(std::isfinite(level.tension) && level.tension > 0.0);
  }
}

}  // namespace
}  // namespace sheave::heavy_runs
