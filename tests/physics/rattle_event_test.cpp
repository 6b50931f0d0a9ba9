// What events do to the energy where no damping hides it.
//
// `rattle` conserves H + h^2 G + ... of a smooth motion, G being smooth in the state, so H
// oscillates by h^2 (G(t0) - G(t)). An event ends one smooth motion and begins another with another
// G: over a run H is off by h^2 times a sum of such differences. That is no work of the event, and
// falls as h^2. What the event itself does shows in the substep after it: there H may change by no
// more than in the smooth substeps beside it.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/hybrid.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

/// A body of 2.4 kg on a cable of which `stored` is wound on a wheel, as in
/// scenes/paper/hybrid.json.
test::Machine unwinding(double stored, double h) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(h, 1, 20);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = IntegratorKind::rattle;
  const BodyId wheel = m.model.add(test::wheel("wheel", Vector3::Zero(), 0.25, 0.0625));
  BodyDef body = test::lump("body", {0.25, -0.6, 0.0}, 2.4);
  body.mobility = Mobility::planar;
  const BodyId weight = m.model.add(body);
  auto end = std::make_shared<HybridLink>();
  end->body = wheel;
  end->winding = test::left;
  end->stored_length = stored;
  m.cables.push_back(test::cable("rope", {test::attach(weight, {0.0, 0.1, 0.0}), end}));
  return m;
}

/// Energies after each substep, over the first, up to `time` or until the cable goes slack: what
/// follows is an impact.
struct TautRun {
  std::vector<double> energy{0.0};
  std::vector<std::size_t> events;  ///< substeps at whose end they came
};

TautRun taut_run(const test::Machine& m, double time) {
  Simulation s = test::start(m);
  TautRun run;
  const double start = s.world.energy().total();
  const auto steps = static_cast<std::size_t>(std::lround(time / m.model.step.dt));
  while (run.energy.size() <= steps) {
    const StepReport report = s.world.step();
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
    bool taut = false;
    const CableReport cable = s.cable_reports()[0];
    for (const SpanReport& span : cable.spans) taut = taut || span.tension > 0.0;
    if (!taut) break;
    if (s.cables->events().size() > run.events.size()) run.events.push_back(run.energy.size());
    run.energy.push_back(s.world.energy().total() - start);
  }
  return run;
}

TEST(RattleEvents, EndsThatAttachAndWindCreateNoEnergy) {
  int checked = 0;
  for (const double stored : {0.5, 0.7, 1.0, 1.3, 1.5}) {
    for (const double h : {1.0 / 240.0, 1.0 / 960.0}) {
      const TautRun run = taut_run(unwinding(stored, h), 2.0);
      const auto change = [&](std::size_t i) { return run.energy[i + 1] - run.energy[i]; };
      for (const std::size_t event : run.events) {
        if (event < 1 || event + 2 >= run.energy.size()) continue;
        ++checked;
        // Rounding of energies of 54 J, some 1e-14 each, and 1e-10 m of the solver's under 10 N.
        EXPECT_LE(change(event), std::max({change(event - 1), change(event + 1), 0.0}) + 1e-8)
            << stored << " m, " << h << " s, event at substep " << event;
      }
    }
  }
  EXPECT_GT(checked, 20);
}

TEST(RattleEvents, TheExcessEnergyFallsWithTheSquareOfTheStep) {
  // Longer substeps are cut where the rim turns by more than 0.1 rad, and are better than their order.
  std::vector<double> excess;
  for (const double h : {1.0 / 960.0, 1.0 / 1920.0, 1.0 / 3840.0}) {
    const TautRun run = taut_run(unwinding(1.5, h), 2.2);
    EXPECT_GE(run.events.size(), 3U);
    const auto [least, most] = std::minmax_element(run.energy.begin(), run.energy.end());
    // Far less than what the swings between the events oscillate by.
    EXPECT_LT(*most, 1e-3 * -*least) << h;
    excess.push_back(*most);
  }
  EXPECT_GE(std::log2(excess[0] / excess[1]), 1.9);
  EXPECT_GE(std::log2(excess[1] / excess[2]), 1.9);
}

TEST(RattleEvents, ATouchCreatesNoMoreThanTheWorkOfItsOvershoot) {
  // A cable of 1 m swings against a post of radius r at a = 0.5 m from its top and is bent by the
  // angle p when it is found to touch. The way round the post is longer than the straight one by d
  // = a b p^2 / (2 (a + b)), b the rest, and pulling the ball back by d under the tension T makes T
  // d. p is what the free part has turned by in a substep at the most, v h / b. (Not to be kept out
  // as at hybrid ends: cable that is not given back would be lost or return when it leaves.)
  for (const double h : {1.0 / 240.0, 1.0 / 960.0}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(h, 1, 20);
    m.model.step.solver = SolverKind::direct;
    m.model.step.integrator = IntegratorKind::rattle;
    BodyDef post = test::wheel("post", {0.05, -0.5, 0.0}, 0.05, 1.0);
    post.mobility = Mobility::fixed;
    post.axis.reset();
    const BodyId peg = m.model.add(post);
    BodyDef body = test::lump("ball", {-std::sin(0.5), -std::cos(0.5), 0.0}, 1.0);
    body.mobility = Mobility::planar;
    const BodyId ball = m.model.add(body);
    auto passed = test::roll(peg, test::left);
    passed->lifted = true;
    m.cables.push_back(
        test::cable("rope", {test::attach(BodyId::world()), passed, test::attach(ball)}));
    Simulation s = test::start(m);
    std::size_t seen = 0;
    int touches = 0;
    double before = s.world.energy().total();
    for (int i = 0; i < static_cast<int>(8.0 / h); ++i) {
      const bool touched = s.cables->events().size() > seen &&
                           s.cables->events().back().kind == CableEvent::Kind::touch;
      seen = s.cables->events().size();
      const double speed = s.world.velocity(ball).norm();
      ASSERT_TRUE(s.world.step().ok());
      const double now = s.world.energy().total();
      if (touched) {
        ++touches;
        const double tension = s.cable_reports()[0].spans[1].tension;
        const double a = 0.5;
        const double b = 0.5;
        const double overshoot = a * speed * speed * h * h / (2.0 * b * (a + b));
        // What the smooth motion changes beside is of h^3, and less than a hundredth of it.
        EXPECT_LE(now - before, 1.01 * tension * overshoot) << h;
      }
      before = now;
    }
    EXPECT_GE(touches, 3);
  }
}

}  // namespace
}  // namespace sheave
