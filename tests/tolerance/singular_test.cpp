// A mechanism that passes singular positions, with a tolerance: IFToMM's benchmark A02. At 0.713 s all
// rods are in line, and the windows could go on as crossed ones from there.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "cable/run_check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

TEST(SingularPosition, KeepsTheEnergyWithASmallTolerance) {
  const SceneResult scene =
      load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/analytic/iftomm-four-bars.json",
                 {{"/step/tolerance", "1e-5", "--tolerance"}});
  ASSERT_TRUE(scene);
  Result<Simulation> made = create_simulation(*scene);
  ASSERT_TRUE(made.ok());
  Simulation& simulation = *made;
  RunCheck check(simulation);
  const double start = simulation.world.energy().total();
  double drift = 0.0;
  std::int64_t kept = 0;
  constexpr int steps = 300;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step({}, check.within(simulation), {});
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.missed_tolerance, 0) << i;
    check.observe(simulation, report.statistics, i + 1 == steps);
    kept += report.statistics.kept_substeps;
    drift = std::max(drift, std::abs(simulation.world.energy().total() - start));
  }
  EXPECT_TRUE(check.certificate().clean());
  // The energy is off by at most (w h)^2 / 4 of the 70 J that flow, with w = 6.84 rad/s at the bottom and
  // h = dt / 32 at most: there h^2 w^3 / 6 is half of the tolerance. Noise took 25 mJ.
  const double h = 0.01 / 32.0;
  EXPECT_LE(drift, 70.0 * std::pow(6.84 * h, 2.0) / 4.0);
  // Substeps stay long: twice as many as the shortest smooth ones would be 64 per step.
  EXPECT_LE(kept, 64 * steps);
}

}  // namespace
}  // namespace sheave::test
