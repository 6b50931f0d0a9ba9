// An attachment that comes to a wheel ends the run, by name: cable/cable_doubts.cpp.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "engine/math/turn_between.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

/// A chairlift's grip without the lift: an elastic loop over two driven bull wheels of 1 m, 10 m
/// apart, with upright axles, and a chair of 80 kg attached to it half way, which so moves at 1
/// m/s.
test::Machine chairlift(SolverKind solver, IntegratorKind integrator, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 60.0, substeps, 50);
  m.model.step.solver = solver;
  m.model.step.integrator = integrator;
  const auto wheel = [&](const char* name, double x) {
    BodyDef body = test::wheel(name, {x, 0.0, 0.0}, 1.0, 25.0);
    body.axis = Vector3::UnitY();
    body.orientation = turn_between(Vector3::UnitZ(), Vector3::UnitY());
    body.drive = DriveKind::speed;
    body.drive_values = {1.0};
    return m.model.add(body);
  };
  const BodyId bottom = wheel("bottom", 0.0);
  const BodyId top = wheel("top", 10.0);
  const BodyId chair = m.model.add(test::lump("chair", {5.0, 0.0, 1.0}, 80.0));
  CableDef rope = test::cable(
      "rope", {test::attach(chair), test::roll(top, test::left), test::roll(bottom, test::left)});
  rope.closed = true;
  rope.axial_stiffness = 1e6;
  m.cables.push_back(rope);
  return m;
}

// The chair comes to the wheel after about 5 s. Whatever moves until then moves as it should: the
// chair with the rope, and up and down in the sag of the rope, s^3 = m g L^2 / 4 EA with L = 5 m
// from wheel to chair: 0.17 m, swung through twice at less than sqrt(2 g 0.4 m). (Before, the run
// went on, with the chair inside the wheel: 1.2e6 J in 10 s, status done.)
TEST(ArrivingAttachment, EndsTheRunWithItsName) {
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const int substeps : {1, 4, 16}) {
        Simulation s = test::start(chairlift(solver, integrator, substeps));
        double fastest = 0.0;
        std::optional<Divergence> end;
        while (!end && s.world.state().time < 10.0) {
          end = s.world.step().divergence;
          fastest = std::max(fastest, s.world.velocity({2}).norm());
        }
        ASSERT_TRUE(end) << substeps;
        EXPECT_EQ(end->feature, "cables");
        for (const char* name : {"rope", "chair", "top", "link 0", "link 1"}) {
          EXPECT_NE(end->message.find(name), std::string::npos) << end->message;
        }
        EXPECT_GT(end->time, 4.0) << substeps;
        EXPECT_LT(end->time, 5.5) << substeps;
        EXPECT_LT(fastest, 5.0) << substeps;
      }
    }
  }
}

// Counted from the other end and running the other way it comes to the other wheel.
TEST(ArrivingAttachment, EndsTheRunInBothDirections) {
  test::Machine m = chairlift(SolverKind::direct, IntegratorKind::rattle, 4);
  for (int i : {0, 1}) m.model.bodies[static_cast<std::size_t>(i)].drive_values = {-1.0};
  Simulation s = test::start(m);
  std::optional<Divergence> end;
  while (!end && s.world.state().time < 10.0) end = s.world.step().divergence;
  ASSERT_TRUE(end);
  EXPECT_NE(end->message.find("bottom"), std::string::npos) << end->message;
}

// A rigid rope draws the chair to the wheel that drives it. Then this wheel has no more cable to draw.
TEST(ArrivingAttachment, EndsTheRunAtADrivenWheelOfARigidRope) {
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const int substeps : {1, 4, 16}) {
        test::Machine m = chairlift(solver, integrator, substeps);
        m.model.gravity = Vector3::Zero();
        m.model.bodies[0].drive = DriveKind::none;
        m.model.bodies[0].drive_values.clear();
        m.model.bodies[2].velocity = {1.0, 0.0, 0.0};
        m.cables[0].axial_stiffness.reset();
        Simulation s = test::start(m);
        std::optional<Divergence> end;
        while (!end && s.world.state().time < 10.0) end = s.world.step().divergence;
        ASSERT_TRUE(end) << substeps;
        EXPECT_NE(end->message.find("\"top\""), std::string::npos) << end->message;
        // 5 m at 1 m/s.
        EXPECT_NEAR(end->time, 5.0, 1.0 / 60.0 + 1e-6) << substeps;
      }
    }
  }
}

/// A drum with an end of the rope winds in a load of 50 kg at 0.8 m/s; with `knot`, a body of 2 kg
/// is attached between them. It comes to the drum after 2 m.
test::Machine drum_hoist(double stiffness, bool knot, double side) {
  test::Machine m;
  m.model.gravity = test::down;
  BodyDef drum = test::wheel("drum", {0.0, 5.0, 0.0}, 0.2, 0.2);
  drum.drive = DriveKind::speed;
  drum.drive_values = {4.0 * side};
  const BodyId wheel = m.model.add(drum);
  auto spool = test::roll(wheel, side > 0.0 ? test::right : test::left);
  spool->stored_length = 5.0;
  std::vector<std::shared_ptr<const LinkDef>> links{spool};
  if (knot) {
    links.push_back(test::attach(m.model.add(test::lump("knot", {0.2 * side, 3.0, 0.0}, 2.0))));
  }
  const Vector3 below{0.2 * side, knot ? 1.0 : 3.0, 0.0};
  links.push_back(test::attach(m.model.add(test::lump("load", below, 50.0))));
  CableDef rope = test::cable("rope", {});
  rope.links = links;
  rope.axial_stiffness = stiffness;
  m.cables.push_back(rope);
  return m;
}

// At a drum, too, the motion ends with a name. (Before, the load or the knot came inside the drum
// and flew about: 104 kJ with status done, where 1 kJ has been lifted.) Until then there is the work
// of the winch, 52 kg x 9.81 m/s^2 x 2.2 m = 1.1 kJ, and the elastic energy of the rope. A load below the drum
// may also come to rest at the rim, with a drive that stalls.
TEST(ArrivingAttachment, EndsTheRunAtADrum) {
  for (const double stiffness : {1e5, 1e7}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const int substeps : {1, 4, 16, 64}) {
        for (const bool knot : {false, true}) {
          const double side = substeps == 4 ? -1.0 : 1.0;
          SCOPED_TRACE(testing::Message() << stiffness << " " << static_cast<int>(integrator) << " "
                                          << substeps << " knot " << knot);
          test::Machine m = drum_hoist(stiffness, knot, side);
          m.model.step = test::direct_settings(integrator, 1.0 / 60.0);
          m.model.step.substeps = substeps;
          Simulation s = test::start(m);
          const double energy = s.world.energy().total();
          double gained = 0.0;
          std::optional<Divergence> end;
          while (!end && s.world.state().time < 4.0) {
            end = s.world.step().divergence;
            gained = std::max(gained, s.world.energy().total() - energy);
          }
          EXPECT_LT(gained, 1600.0);
          EXPECT_TRUE(end || !s.cables->stall_warnings().empty());
          if (!end) continue;
          EXPECT_NE(end->message.find("has reached the wheel"), std::string::npos) << end->message;
          EXPECT_NE(end->message.find("\"drum\""), std::string::npos) << end->message;
          EXPECT_GT(end->time, 2.2);
        }
      }
    }
  }
}

// A weight on a rail beside a wheel is not inside it: nothing ends. At 5 % of the radius outside of
// the rim the free length is sqrt(2 x 0.05) radii = 0.08 m or more.
TEST(ArrivingAttachment, DoesNotEndTheRunBesideTheWheel) {
  for (const int substeps : {1, 4, 16, 64}) {
    test::Atwood atwood;
    atwood.m2 = 5.0;
    atwood.hang = 0.5;
    test::Machine m = atwood.machine();
    m.model.bodies[1].position.x() -= 0.05 * atwood.radius;
    m.model.step.substeps = substeps;
    Simulation s = test::start(m);
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok()) << i;
    EXPECT_GT(s.world.position({1}).y(), 0.3);
  }
}

}  // namespace
}  // namespace sheave
