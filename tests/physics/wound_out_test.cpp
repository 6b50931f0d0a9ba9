// Drums whose cable is used up: drum and load are jerked together, and energy does not grow.
//
// The end of the cable becomes a point of the rim. There is no damping in the machine, so with all
// that the cable stores its energy is that of the start, but for what comes taut and is stopped.
// Implicit Euler takes some in every substep. `rattle` takes and gives with a force whose arm turns
// by an angle a within a substep its share a^2, with a up to 0.1 (cable/cable_ends.cpp): here of
// some 3 kJ that flow to and fro through the rim, so some 30 J each time.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/hybrid.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::wound_out {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::right;
using test::roll;

constexpr double load = 100.0;                      // [kg]
constexpr double stored = 2.0;                      // on the drum [m]
constexpr double rigid = 0.0;                       // as a stiffness
constexpr double energy = load * g * 2.0 * stored;  // about what falls, here and on both sides

enum class Kind { rolling, spool, hybrid };

std::shared_ptr<const LinkDef> drum_link(Kind kind, Winding winding) {
  if (kind == Kind::rolling) {
    auto link = roll({0}, winding);
    link->stored_length = stored;
    return link;
  }
  if (kind == Kind::spool) {
    auto link = std::make_shared<SpoolLink>();
    link->body = {0};
    link->winding = winding;
    link->stored_length = stored;
    link->layer_pitch = 0.02;
    return link;
  }
  auto link = std::make_shared<HybridLink>();
  link->body = {0};
  link->winding = winding;
  link->stored_length = stored;
  return link;
}

/// A drum of 1 kg and 0.3 m that lets down a load over a sheave.
test::Machine drum(const StepSettings& step, double stiffness, Kind kind, bool mirrored) {
  test::Machine m;
  m.model.step = step;
  m.model.gravity = test::down;
  const double side = mirrored ? -1.0 : 1.0;
  m.model.add(test::wheel("drum", {0, 0, 0}, 0.3, 0.045));
  m.model.add(test::wheel("sheave", {1.2 * side, 0.8, 0}, 0.25, 0.03));
  m.model.add(test::weight("load", {1.45 * side, -1.5, 0}, load));
  // Seen in a mirror, and counted from the load, the cable winds as before.
  if (mirrored) {
    m.cables.push_back(cable("rope", {attach({2}), roll({1}, right), drum_link(kind, right)}));
  } else {
    m.cables.push_back(cable("rope", {drum_link(kind, right), roll({1}, right), attach({2})}));
  }
  if (stiffness > 0.0) m.cables[0].axial_stiffness = stiffness;
  return m;
}

/// The most that the machine has more than at the start, within `time` [J].
double most_gained(const test::Machine& machine, double time) {
  Simulation s = test::start(machine);
  const double before = s.world.energy().total();
  double most = 0.0;
  while (s.world.state().time < time) {
    EXPECT_TRUE(s.world.step().ok());
    most = std::max(most, s.world.energy().total() - before);
  }
  const std::vector<CableEvent>& events = s.cables->events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const CableEvent& event) {
    return event.kind == CableEvent::Kind::attach;
  }));
  return most;
}

class WoundOut : public test::ForEveryCombination {
 protected:
  [[nodiscard]] static StepSettings steps(int substeps) {
    StepSettings step = step_settings(1.0 / 60.0, 50);
    step.substeps = substeps;
    return step;
  }
};
INSTANTIATE_TEST_SUITE_P(All, WoundOut, testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST_P(WoundOut, EnergyDoesNotGrow) {
  // Sweeps from row to row do not come to the end of it where a stiff rope joins a heavy load and
  // light wheels: what they leave off is in the rope's strain.
  const bool direct = GetParam().solver == SolverKind::direct;
  for (const double stiffness : {1e3, 1e6, 1e9, rigid}) {
    for (const int substeps : {1, 2, 8}) {
      if (!direct && (stiffness > 1e6 || substeps < 8 || GetParam().rattle())) continue;
      for (const bool mirrored : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << "EA " << stiffness << ", " << substeps << (mirrored ? " mirrored" : ""));
        const double gained =
            most_gained(drum(steps(substeps), stiffness, Kind::rolling, mirrored), 1.2);
        // A rope of 1e9 N vibrates with the load by some 3 rad in a substep of 1/480 s. The forces of
        // `rattle` follow the gradients at both ends of the substep, which turn with the drum: it
        // gains 3 %, which is listed in docs/reference/known-faults.md.
        const double share = stiffness == 1e9 ? 0.04 : 0.02;
        EXPECT_LT(gained, GetParam().rattle() ? share * energy : 1e-9 * energy);
      }
    }
  }
}

TEST_P(WoundOut, EnergyDoesNotGrowOnSpoolsAndHybridLinks) {
  if (GetParam().solver != SolverKind::direct) GTEST_SKIP();
  for (const Kind kind : {Kind::spool, Kind::hybrid}) {
    for (const double stiffness : {1e3, 1e6, 1e8}) {
      SCOPED_TRACE(testing::Message() << "EA " << stiffness << ", kind " << static_cast<int>(kind));
      const double gained = most_gained(drum(steps(2), stiffness, kind, false), 1.2);
      EXPECT_LT(gained, GetParam().rattle() ? 0.02 * energy : 1e-9 * energy);
    }
  }
}

// The jerk of an elastic rope at the end of the drum is no impact: the drum and its rim have an
// inertia, and the force is bounded. Energy goes to creep alone (cable/cable_material.cpp), where
// rope comes off the drum or the sheave into a span of another strain: up to 104 J of some 4 kJ.
// By the head of this file a turn of the arm by 100 rad/s x 1/3840 s in a part costs up to 7e-4 of
// the 3 kJ that flow through the rim: 2 J.
TEST(WoundOutCreep, TakesAllThatASoftRopeLoses) {
  for (const double stiffness : {3e2, 1e3, 1e4, 1e5}) {
    StepSettings step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0);
    step.substeps = 64;
    Simulation s = test::start(drum(step, stiffness, Kind::rolling, false));
    const double before = s.world.energy().total();
    double error = 0.0;
    double lost = 0.0;
    while (s.world.state().time < 1.5) {
      ASSERT_TRUE(s.world.step().ok());
      lost = s.cable_reports()[0].creep_loss;
      error = std::max(error, std::abs(s.world.energy().total() + lost - before));
    }
    EXPECT_GT(lost, 5.0) << stiffness;
    EXPECT_LT(error, 3.0) << stiffness;
    EXPECT_GT(lost, 10.0 * error) << stiffness;
  }
}

}  // namespace
}  // namespace sheave::wound_out
