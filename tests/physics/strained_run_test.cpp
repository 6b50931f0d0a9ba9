// The law of a cable of a material over links that let it pass: T = EA e of every span, whatever
// has passed in the substep.
//
// With the unstretched lengths L and the strains e = l / L - 1 that are reported, XPBD asks for T =
// EA e at the end of a substep and `rattle` for the mean of both ends, T = EA (e0 + e1) / 2. Both
// are what a substep is solved for, so they hold to where its rounds end: 1e-10 m of some metres of
// cable, whose stretch is e L. (Lengths that are shared out after the substep miss it by the strain
// times what has passed, a share slip / L of the stretch: 1e-2 here.)

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"

namespace sheave::strained_run {
namespace {

using test::attach;
using test::cable;
using test::eyelet;
using test::roll;

class StrainedRun : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, StrainedRun, testing::ValuesIn(test::combinations),
                         test::combination_name);

/// Two weights on a cable over a link at the origin's height; they start in free fall from where it
/// has no strain.
test::Machine swing(const std::shared_ptr<const LinkDef>& middle, test::Machine m,
                    double stiffness) {
  m.model.gravity = test::down;
  const BodyId first = m.model.add(test::weight("first", {-0.3, -3.0, 0}, 1.0));
  const BodyId second = m.model.add(test::weight("second", {0.3, -4.0, 0}, 3.0));
  m.cables.push_back(cable("rope", {attach(first), middle, attach(second)}));
  m.cables[0].axial_stiffness = stiffness;
  m.model.bodies[static_cast<std::size_t>(first.index)].velocity = {0.0, 2.0, 0.0};
  m.model.bodies[static_cast<std::size_t>(second.index)].velocity = {0.0, -2.0, 0.0};
  return m;
}

/// The largest |T - EA e| of a span over half a second, as a share of the largest T.
double law_error(const test::Machine& m, bool rattle) {
  Simulation s = test::start(m);
  const double stiffness = *m.cables[0].axial_stiffness;
  std::vector<double> before;
  double off = 0.0;
  double largest = 0.0;
  double passed = 0.0;
  for (int i = 0; i < 50; ++i) {
    if (!s.world.step().ok()) ADD_FAILURE();
    std::vector<double> strains;
    const bool taut = std::all_of(before.begin(), before.end(), [](double e) { return e > 0.0; });
    const State& state = s.world.state();
    const std::vector<CableReport> reports =
        s.cables->report(s.world.bodies(), state, state.features.back(), SpanTensions::multipliers);
    for (const SpanReport& span : reports[0].spans) {
      strains.push_back(std::max(span.length / span.rest_length - 1.0, 0.0));
      const std::size_t k = strains.size() - 1;
      largest = std::max(largest, span.tension);
      // Of a spring that was slack the mean counts from 0, of one that has become so to below.
      if (i < 1 || (rattle && !(taut && strains[k] > 0.0))) continue;
      const double mean = rattle ? 0.5 * (before[k] + strains[k]) : strains[k];
      off = std::max(off, std::abs(span.tension - stiffness * mean));
    }
    before = strains;
    passed = s.cable_reports()[0].spans[0].rest_length;
  }
  EXPECT_GT(std::abs(passed - 3.0), 0.3);  // m; much has passed
  return off / largest;
}

TEST_P(StrainedRun, EverySpanHasTheForceOfItsStrainOverAHole) {
  for (const double stiffness : {1e3, 1e7}) {
    test::Machine m;
    m.model.step = step_settings(0.01, 200);
    // Where cable slides against friction, strains are in the ratio of the tensions at the end,
    // which those of `rattle` are not.
    const double friction = GetParam().rattle() ? 0.0 : 0.2;
    m = swing(eyelet(BodyId::world(), {0, 0, 0}, friction), m, stiffness);
    // 1e-10 of 3 m of cable, of the stretch under 20 N.
    EXPECT_LT(law_error(m, GetParam().rattle()), 1e-10 * 3.0 * stiffness / 20.0 + 1e-9);
  }
}

TEST_P(StrainedRun, EverySpanHasTheForceOfItsStrainOverAMasslessWheel) {
  test::Machine m;
  m.model.step = step_settings(0.01, 200);
  BodyDef wheel = test::wheel("wheel", {0, 0, 0}, 0.3, 1.0);
  wheel.spin_inertia = 0.0;
  const BodyId massless = m.model.add(wheel);
  m = swing(roll(massless, test::right), m, 1e4);
  EXPECT_LT(law_error(m, GetParam().rattle()), 1e-10 * 3.0 * 1e4 / 20.0 + 1e-9);
}

}  // namespace
}  // namespace sheave::strained_run
