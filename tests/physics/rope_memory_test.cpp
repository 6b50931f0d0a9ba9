// Motion of ropes that remember how they were stretched: tests/support/rope_memory.h.

#include "tests/support/rope_memory.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "cable/rope_memory.h"
#include "cable/run_check.h"
#include "tests/support/checked_run.h"
#include "tests/support/friction_links.h"

namespace sheave::rope_memory_motion {
namespace {

using test::g;
using test::rope_memory::give_law;
using test::rope_memory::hanging;
using test::rope_memory::larger_root;
using test::rope_memory::Law;
using test::rope_memory::length;
using test::rope_memory::letting;
using test::rope_memory::loading;
using test::rope_memory::mass;
using test::rope_memory::steep;
using test::rope_memory::step_of;
using test::rope_memory::total_with_loss;
using test::rope_memory::width;

constexpr std::array laws{Law::yields, Law::has_two_curves};

/// Highest and lowest positions of the load, from its release on: where its velocity changes sign
/// between two steps, the farthest point of the parabola of these steps.
std::vector<double> turns(const test::Machine& machine, std::size_t count) {
  Simulation s = test::start(machine);
  std::vector<double> found;
  double speed = 0.0;
  double height = s.world.position({0}).y();
  while (found.size() < count && s.world.state().time < 30.0) {
    EXPECT_TRUE(s.world.step().ok());
    const double next_speed = s.world.state().bodies[0].velocity.y();
    const double next_height = s.world.position({0}).y();
    if (speed * next_speed < 0.0) {
      const double way = speed * speed / (speed - next_speed) * machine.model.step.dt;
      found.push_back(height + 0.5 * way);
    }
    speed = next_speed;
    height = next_height;
  }
  return found;
}

TEST(RopeWithMemory, ReboundsToTheHeightsOfItsEnergy) {
  // The load falls from 0.8 m above the slack rope. With the strain e of the lowest point,
  // m g (H + L e) = L x (integral to e), and the next height follows from the integral back. Turns are
  // second order of the step: a h^2 / 8 with a = 700 m/s2 is 9e-5 m for h = 1e-3; the rope remembers
  // the largest strain of a step's end, and each fall adds its part.
  constexpr double dk = loading - letting;
  for (const auto& c : test::combinations) {
    if (!c.rattle()) continue;
    test::Machine m = hanging(Law::has_two_curves, -0.4);
    m.model.step = step_of(c, 1e-3, 1);
    const std::vector<double> found = turns(m, 6);
    ASSERT_EQ(found.size(), 6U);
    double above = 0.8;
    for (std::size_t i = 0; i < found.size(); i += 2) {
      const double weight = mass * g;
      const double e =
          larger_root(loading, -weight, -dk * width * width / 6.0 - weight * above / length);
      EXPECT_NEAR(found[i], -length * (1.0 + e), 1e-4);
      const double back =
          0.5 * letting * e * e + dk * (0.5 * (e - width) * width + width * width / 3.0);
      above = length * (back / weight - e);
      ASSERT_GT(above, 0.0);
      EXPECT_NEAR(found[i + 1], -length + above, 3e-4);
    }
  }
}

TEST(RopeWithMemory, YieldsByTheEnergyOfAFall) {
  // m g (H + L e) = L k e^2 / 2 at the first fall; the rope is let off on the line from (e, k e) down to
  // p = e (1 - k / E), which gives L E (e - p)^2 / 2 to the flight upwards. The second fall ends where the
  // first one did, because nothing was lost since.
  for (const auto& c : test::combinations) {
    if (!c.rattle()) continue;
    test::Machine m = hanging(Law::yields, -0.4);
    m.model.step = step_of(c, 1e-3, 1);
    const std::vector<double> found = turns(m, 4);
    ASSERT_EQ(found.size(), 4U);
    const double weight = mass * g;
    const double e = larger_root(loading, -weight, -weight * 0.8 / length);
    const double p = e * (1.0 - loading / steep);
    const double up = 0.5 * steep * (e - p) * (e - p) / weight - e;  // over the length L, above L
    EXPECT_NEAR(found[0], -length * (1.0 + e), 1e-4);
    EXPECT_NEAR(found[1], length * (up - 1.0), 5e-4);
    EXPECT_NEAR(found[2], found[0], 2e-4);
    EXPECT_NEAR(found[3], found[1], 5e-4);
    Simulation s = test::start(m);
    while (s.world.state().time < 2.0) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.cable_reports()[0].permanent_stretch, length * p, 1e-4);
    EXPECT_NEAR(s.cable_reports()[0].hysteresis_loss,
                length * 0.5 * (loading * e * e - steep * (e - p) * (e - p)), 0.05);
  }
}

TEST(RopeWithMemory, SwingsDecayAsItsCurvesSay) {
  // About the rest: from a turn at a to b the tension does the work of the weight,
  // k (b^2 - a^2) / 2 - dk (a w / 2 + w^2 / 6) = m g (b - a), and back in the same way.
  constexpr double dk = loading - letting;
  const double weight = mass * g;
  test::Machine m = hanging(Law::has_two_curves, 0.016);
  m.model.step = test::direct_settings(IntegratorKind::rattle, 2e-4);
  const std::vector<double> found = turns(m, 6);
  ASSERT_EQ(found.size(), 6U);
  // The start is on the curve of loading, at the strain b.
  double b = 0.016;
  for (std::size_t i = 0; i < found.size(); i += 2) {
    const double line = dk * (0.5 * (b - width) * width + width * width / 3.0);
    // With d = b - a: k' (b d - d^2 / 2) + line = weight d
    const double d = larger_root(letting, weight - letting * b, -line);
    const double a = b - d;
    EXPECT_NEAR(found[i], -length * (1.0 + a), 2e-6) << i;
    // With d = b - a: k (a d + d^2 / 2) - dk (a w / 2 + w^2 / 6) = weight d
    b = a +
        larger_root(loading, loading * a - weight, -dk * (0.5 * a * width + width * width / 6.0));
    EXPECT_NEAR(found[i + 1], -length * (1.0 + b), 2e-6) << i;
  }
}

TEST(RopeWithMemory, SwingsOnOneLineWithoutALoss) {
  // About the rest at the strain e on the curve of loading with a swing of less than w / 2 below: the
  // slope of the line is that of V + s (U - V), k' + dk (e + w) / w at s = 1, to first order of the
  // swing. A rope that has yielded swings with E.
  for (const Law law : laws) {
    const double e = mass * g / loading;
    test::Machine m = hanging(law, e + 2e-5);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-4);
    const double slope = law == Law::yields ? steep : loading + (loading - letting) * e / width;
    Simulation s = test::start(m);
    const double w = std::sqrt(slope / (length * mass));
    // The rope was stretched to e + 2e-5 first, so the rest of the swing is where the line has the
    // tension m g.
    const double rest = e + 2e-5 - 2e-5 * loading / slope;
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const double x = -s.world.position({0}).y() / length - 1.0 - rest;
      worst = std::max(worst,
                       std::abs(x - 2e-5 * loading / slope * std::cos(w * s.world.state().time)));
    }
    // The curvature dk / w of the line makes 1e-5 x dk / w / slope = 4e-4 of the swing of 1e-5 per
    // period of phase and of shape, over five periods; (w h)^2 / 12 is below 1e-6.
    EXPECT_LT(worst, law == Law::yields ? 1e-10 : 1e-7);
    EXPECT_NEAR(s.cable_reports()[0].hysteresis_loss, 0.0, 1e-9);
  }
}

TEST(RopeWithMemory, KeepsTheEnergyAndItsLossAtAnyStep) {
  // Loads that fall into the rope, fly up and fall again, at 20, 50 and 200 steps per second: residuals
  // of 1e-10 m under 5 kN in each substep.
  for (const Law law : laws) {
    for (const auto& c : test::combinations) {
      if (!c.rattle()) continue;
      for (const double h : {0.05, 0.02, 0.005}) {
        test::Machine m = hanging(law, -0.4);
        m.model.step = step_of(c, h, 1);
        Simulation s = test::start(m);
        const double start = total_with_loss(s);
        double lost = 0.0;
        while (s.world.state().time < 5.0) {
          const StepReport report = s.world.step();
          ASSERT_TRUE(report.ok());
          EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
          EXPECT_NEAR(total_with_loss(s), start, 1e-5) << h << ' ' << s.world.state().time;
          const double now = s.cable_reports()[0].hysteresis_loss;
          EXPECT_GE(now, lost - 1e-9);
          lost = now;
        }
        EXPECT_GT(lost, 10.0);
      }
    }
  }
}

/// A rope whose end is moved up and down by a body with a prescribed motion, slowly or not.
test::Machine pulled(Law law) {
  test::Machine m;
  BodyDef hoist;
  hoist.name = "hoist";
  hoist.mobility = Mobility::kinematic;
  hoist.position = {0.0, length * 1.05, 0.0};
  hoist.oscillation = {0.0, length * 0.04, 0.0};
  hoist.oscillation_frequency = 0.5;
  hoist.velocity = {0.0, 0.02, 0.0};
  m.model.bodies = {hoist};
  m.cables = {test::cable("rope", {test::attach(BodyId::world()), test::attach(BodyId{0})})};
  m.cables[0].rest_lengths = {length};
  give_law(m.cables[0], law);
  return m;
}

TEST(RopeWithMemory, FollowsAPrescribedLoop) {
  // The law does not know of a rate: tension, memory and loss are those of the strains at the steps.
  for (const Law law : laws) {
    for (const auto& c : test::combinations) {
      test::Machine m = pulled(law);
      m.model.step = step_of(c, 0.01, 1);
      Simulation s = test::start(m);
      const RopeMemory own(m.cables[0]);
      double e = 0.05;
      double remembered = own.after(e, 0.0);
      double lost = 0.0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        const double to = s.world.position({0}).y() / length - 1.0;
        lost += length * own.lost(e, to, remembered);
        remembered = own.after(to, remembered);
        e = to;
        const CableReport rope = s.cable_reports()[0];
        EXPECT_NEAR(rope.spans[0].tension, own.tension(e, remembered), 1e-8);
        EXPECT_NEAR(rope.spans[0].remembered, remembered, 1e-14);
        EXPECT_NEAR(rope.hysteresis_loss, lost, 1e-9);
      }
      EXPECT_GT(lost, 1.0);
    }
  }
}

TEST(RopeWithMemory, ConvergesInTheOrderOfItsIntegrator) {
  // Position in the third swing, of 4, 16 and 64 substeps of a step against 1024 of rattle and 4096 of
  // xpbd: errors fall by 16 and by 4, but for the next order of the coarser steps.
  for (const Law law : laws) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      const bool second = integrator == IntegratorKind::rattle;
      const auto height = [&](int substeps) {
        test::Machine m = hanging(law, 0.016);
        m.model.step = test::direct_settings(integrator, 0.01, substeps);
        Simulation s = test::start(m);
        for (int i = 0; i < 57; ++i) EXPECT_TRUE(s.world.step().ok());
        return s.world.position({0}).y();
      };
      const double exact = height(second ? 1024 : 4096);
      std::vector<double> errors;
      for (const int substeps : {1, 4, 16, 64}) {
        errors.push_back(std::abs(height(substeps) - exact));
      }
      EXPECT_LT(errors[0], second ? 1e-3 : 5e-3);
      EXPECT_NEAR(errors[2] / errors[3], second ? 16.0 : 4.0, second ? 1.0 : 0.5);
      EXPECT_NEAR(errors[1] / errors[2], second ? 16.0 : 3.5, second ? 3.0 : 1.0);
    }
  }
}

/// The load beside a link over which its rope passes freely, 1 m before the link.
enum class Freely { pinhole, post };

test::Machine over(Law law, Freely link, double tension, bool from_the_load) {
  test::Machine m = hanging(law, 0.0);
  m.cables.clear();
  m.model.bodies[0].position = {0.0, -1.4, 0.0};
  constexpr double radius = 0.2;
  std::shared_ptr<const LinkDef> middle = std::make_shared<PinholeLink>();
  double reach = 0.0;
  if (link == Freely::post) {
    reach = 2.0 * radius;
    m.model.bodies.push_back(test::post("post", {-radius, 0.0, 0.0}, radius));
    auto roll = test::roll(BodyId{1}, from_the_load ? test::left : test::right);
    roll->friction = 0.0;
    middle = roll;
  }
  m.cables = {test::cable("rope", {test::attach(BodyId::world(), {-reach, -1.0, 0.0}), middle,
                                   test::attach(BodyId{0})})};
  if (from_the_load) std::swap(m.cables[0].links[0], m.cables[0].links[2]);
  give_law(m.cables[0], law);
  m.cables[0].pretension = tension;
  return m;
}

/// Runs the load beside a link, and a load on a single rope of the same length and tension.
void compare_with_one_rope(Law law, const test::Combination& c, Freely link, double tension,
                           bool from_the_load) {
  const double whole = 2.4 + (link == Freely::post ? 0.2 * pi : 0.0);
  test::Machine m = over(law, link, tension, from_the_load);
  m.model.step = step_of(c, 0.002, 1);
  test::Machine single = hanging(law, 0.0);
  single.model.step = m.model.step;
  single.model.bodies[0].position = {0.0, -whole, 0.0};
  single.cables[0].rest_lengths.clear();
  single.cables[0].pretension = tension;
  Simulation s = test::start(m);
  Simulation alone = test::start(single);
  double apart = 0.0;
  const double start = total_with_loss(s);
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    ASSERT_TRUE(alone.world.step().ok());
    apart = std::max(
        apart, std::abs(s.world.position({0}).y() + 1.4 - (alone.world.position({0}).y() + whole)));
    if (c.rattle()) {
      ASSERT_NEAR(total_with_loss(s), start, c.solver == SolverKind::direct ? 1e-5 : 1e-3);
    }
  }
  EXPECT_LT(apart, 1e-7) << int(link) << from_the_load << int(law) << tension;
  const CableReport rope = s.cable_reports()[0];
  const CableReport other = alone.cable_reports()[0];
  EXPECT_NEAR(rope.hysteresis_loss, other.hysteresis_loss, 1e-4);
  EXPECT_NEAR(rope.permanent_stretch, other.permanent_stretch, 1e-7);
  if (c.solver != SolverKind::direct || from_the_load) return;
  const Certificate found = test::checked_run(m, 0.8);
  EXPECT_TRUE(found.clean()) << found.worst()->name << ' ' << found.worst()->value;
}

TEST(RopeWithMemory, PassesFreelyAsOneRope) {
  // Up to the residuals of 400 substeps; with xpbd, too, because each round has the run's one strain.
  // From 20 N the load falls and swings, from 900 N it is thrown up until the rope is slack, and falls
  // into it again.
  for (const Law law : laws) {
    for (const auto& c : test::combinations) {
      for (const Freely link : {Freely::pinhole, Freely::post}) {
        for (const double tension : {20.0, 900.0}) {
          for (const bool from_the_load : {false, true}) {
            compare_with_one_rope(law, c, link, tension, from_the_load);
          }
        }
      }
    }
  }
}

TEST(RopeWithMemory, HasOneMemoryOnEachSideOfALoad) {
  // A load at a point of the rope between two walls: the spans have strains and memories of their own.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.bodies = {test::weight("load", {0.0, 0.02, 0.0}, 200.0)};
  m.cables = {
      test::cable("rope", {test::attach(BodyId::world(), {0.0, 1.0, 0.0}), test::attach(BodyId{0}),
                           test::attach(BodyId::world(), {0.0, -1.0, 0.0})})};
  m.cables[0].rest_lengths = {0.98, 1.0};
  give_law(m.cables[0], Law::yields);
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
  Simulation s = test::start(m);
  const double start = total_with_loss(s);
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    most = std::max(most, (1.0 - s.world.position({0}).y()) / 0.98 - 1.0);
  }
  const CableReport rope = s.cable_reports()[0];
  EXPECT_NEAR(rope.spans[0].remembered, most * (1.0 - loading / steep), 1e-6);
  EXPECT_GT(rope.spans[0].remembered, rope.spans[1].remembered);
  EXPECT_NEAR(total_with_loss(s), start, 1e-5);
}

TEST(RopeWithMemory, KeepsItsMemoryWhereItTouchesAndLeaves) {
  // A load on a rope swings against a round body without friction, lies on it, and leaves it again.
  for (const Law law : laws) {
    test::Machine m = hanging(law, 0.0);
    m.model.bodies[0] = test::lump("load", {-0.8, -1.9, 0.0}, mass);
    BodyDef round = test::post("round", {0.16, -1.0, 0.0}, 0.15);
    round.wrappable = true;
    m.model.bodies.push_back(round);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
    Simulation s = test::start(m);
    const double start = total_with_loss(s);
    double lost = 0.0;
    for (int i = 0; i < 4000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport rope = s.cable_reports()[0];
      EXPECT_GE(rope.hysteresis_loss, lost - 1e-9);
      lost = rope.hysteresis_loss;
    }
    EXPECT_GE(s.cables->events().size(), 2U);
    // Contacts in time are of second order of the step.
    EXPECT_NEAR(total_with_loss(s), start, 1e-3 * mass * g);
    const Certificate found = test::checked_run(m, 3.0);
    EXPECT_TRUE(found.clean()) << found.worst()->name << ' ' << found.worst()->value;
  }
}

TEST(RopeWithMemory, IsCheckedByAnotherComputation) {
  for (const Law law : laws) {
    for (const auto& c : test::combinations) {
      if (c.solver != SolverKind::direct) continue;
      test::Machine m = hanging(law, -0.4);
      m.model.step = step_of(c, 0.01, 8);
      const Certificate found = test::checked_run(m, 3.0);
      EXPECT_TRUE(found.clean()) << found.worst()->name << ' ' << found.worst()->value;
      test::Machine swing = hanging(law, 0.02);
      swing.model.step = m.model.step;
      const Certificate swinging = test::checked_run(swing, 3.0);
      EXPECT_TRUE(swinging.clean()) << swinging.worst()->name << ' ' << swinging.worst()->value;
      // The definition that the certificate reads is let off with another slope, and does not fit.
      Simulation s = test::start(swing);
      CableDef& rope = swing.cables[0];
      if (rope.unloading_stiffness) *rope.unloading_stiffness *= 1.1;
      for (double& tension : rope.unloading_table) tension *= 0.9;
      s.cable_definitions = std::make_shared<const std::vector<CableDef>>(swing.cables);
      RunCheck check(s);
      for (int i = 0; i < 60; ++i) {
        const StepReport report = s.step();
        check.observe(s, report.statistics, i == 59);
      }
      EXPECT_FALSE(check.certificate().clean());
    }
  }
}

TEST(RopeWithMemory, SavesAndRestoresBitForBitInALoop) {
  for (const Law law : laws) {
    test::Machine m = hanging(law, 0.016);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 0.005);
    Simulation s = test::start(m);
    for (int i = 0; i < 77; ++i) ASSERT_TRUE(s.world.step().ok());
    ASSERT_GT(s.cable_reports()[0].spans[0].remembered, 0.0);
    const State middle = s.world.state();
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
    Simulation again = test::start(m);
    ASSERT_TRUE(again.world.restore(middle).empty());
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(again.world.step().ok());
    EXPECT_EQ(hash(again.world.state()), hash(s.world.state()));
    State damaged = middle;
    for (double& number : damaged.features.back().reals) number = std::abs(number);
    damaged.features.back().reals[damaged.features.back().reals.size() - 2] = -1.0;
    EXPECT_FALSE(again.world.restore(damaged).empty());
  }
}

TEST(RopeWithMemory, MovesTheSameInOtherUnits) {
  // Millimetres, tonnes and seconds: forces stay in newtons, energies are in millijoules.
  for (const Law law : laws) {
    test::Machine m = hanging(law, -0.1);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 0.005);
    test::Machine small = m;
    small.model.gravity *= 1000.0;
    small.model.bodies[0].position *= 1000.0;
    small.model.bodies[0].mass = mass / 1000.0;
    small.cables[0].rest_lengths = {length * 1000.0};
    Simulation s = test::start(m);
    Simulation other = test::start(small);
    for (int i = 0; i < 300; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      ASSERT_TRUE(other.world.step().ok());
      ASSERT_NEAR(other.world.position({0}).y(), 1000.0 * s.world.position({0}).y(), 1e-5);
    }
    EXPECT_NEAR(other.cable_reports()[0].hysteresis_loss,
                1000.0 * s.cable_reports()[0].hysteresis_loss, 1e-3);
  }
}

TEST(RopeWithMemory, BreaksAtItsTension) {
  // The hoist rises from the strain 0.05 with 0.02 m/s and reaches the strain of the breaking tension on
  // the table.
  test::Machine m = pulled(Law::yields);
  m.model.bodies[0].oscillation.setZero();
  m.cables[0].breaking_tension = 0.06 * loading;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  Simulation s = test::start(m);
  for (int i = 0; i < 150; ++i) ASSERT_TRUE(s.world.step().ok());
  ASSERT_EQ(s.cables->events().size(), 1U);
  EXPECT_NEAR(s.cables->events()[0].time, 0.01 * length / 0.02, 1e-7);
}

}  // namespace
}  // namespace sheave::rope_memory_motion
