// An attachment that comes to a pinhole or to the end of a sheath ends the run, by name:
// cable/cable_arrival.cpp.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "cable/links/sheath.h"
#include "engine/body_set.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

std::shared_ptr<PinholeLink> eye(const Vector3& point) {
  auto link = std::make_shared<PinholeLink>();
  link->point = point;
  return link;
}

struct Hoist {
  double stiffness = 0.0;  ///< EA [N]; 0: rigid
  bool sheath = false;     ///< in place of two pinholes
  bool free = false;       ///< the load is free, not on a rail
  bool reversed = false;   ///< the cable counts from the load
  IntegratorKind integrator = IntegratorKind::rattle;
  int substeps = 4;

  /// A drum draws a load of 10 kg by 0.3 m/s to the second of two pinholes, or to the end of a
  /// sheath, which is 1.05 m above it.
  [[nodiscard]] test::Machine machine() const {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::direct_settings(integrator, 1.0 / 60.0);
    m.model.step.substeps = substeps;
    BodyDef drum = test::wheel("drum", {-1.1, -0.8, 0.0}, 0.1, 0.01);
    drum.drive = DriveKind::speed;
    drum.drive_values = {3.0};
    auto spool = test::roll(m.model.add(drum), reversed ? test::left : test::right);
    spool->stored_length = 3.0;
    BodyDef load = free ? test::lump("load", {1.0, -1.05, 0.0}, 10.0)
                        : test::weight("load", {1.0, -1.05, 0.0}, 10.0);
    auto held = test::attach(m.model.add(load));
    CableDef rope = test::cable("rope", {});
    rope.links.push_back(spool);
    if (sheath) {
      auto conduit = std::make_shared<SheathLink>();
      conduit->points = {{-1.0, 0.0, 0.0}, {0.0, 0.5, 0.0}, {1.0, 0.0, 0.0}};
      if (reversed) std::reverse(conduit->points.begin(), conduit->points.end());
      conduit->friction = 0.1;
      rope.links.push_back(conduit);
    } else {
      rope.links.push_back(eye({-1.0, 0.0, 0.0}));
      rope.links.push_back(eye({1.0, 0.0, 0.0}));
    }
    rope.links.push_back(held);
    if (reversed) std::reverse(rope.links.begin(), rope.links.end());
    if (stiffness > 0.0) {
      rope.axial_stiffness = stiffness;
      rope.pretension = 98.1;
    }
    m.cables.push_back(rope);
    return m;
  }
};

// The load comes to the eye after 1.05 m / 0.3 m/s. Its speed is then that of the rope, and of the
// vibration with which the drum has started, at most as fast. (Before, the load went through the eye
// and back, at 112 m/s.)
TEST(ArrivingAtEye, EndsTheRunWithItsName) {
  for (const double stiffness : {2e4, 1e6}) {
    for (const bool sheath : {false, true}) {
      for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
        for (const int substeps : {1, 4, 16}) {
          Hoist hoist{stiffness, sheath, substeps == 4, substeps == 16, integrator, substeps};
          SCOPED_TRACE(testing::Message() << stiffness << " sheath " << sheath << " "
                                          << static_cast<int>(integrator) << " " << substeps);
          Simulation s = test::start(hoist.machine());
          double fastest = 0.0;
          std::optional<Divergence> end;
          while (!end && s.world.state().time < 6.0) {
            end = s.world.step().divergence;
            fastest = std::max(fastest, s.world.velocity({1}).norm());
          }
          ASSERT_TRUE(end);
          EXPECT_EQ(end->feature, "cables");
          const std::string place = sheath ? "the end of the sheath" : "the pinhole";
          for (const std::string& word :
               {std::string("\"rope\""), std::string("\"load\""), place}) {
            EXPECT_NE(end->message.find(word), std::string::npos) << end->message;
          }
          // The strain m g / EA, and twice that in the vibration.
          const double stretch = 2.0 * 98.1 / stiffness * 4.0;
          EXPECT_NEAR(end->time, 3.5, (stretch + 0.3 / 60.0) / 0.3 + 0.01);
          EXPECT_LT(fastest, 0.7);
        }
      }
    }
  }
}

// The end of a sheath on another body counts where that body is: here it comes towards the load, which
// hangs from it and keeps its distance but for the rope that the drum draws.
TEST(ArrivingAtEye, EndsTheRunAtAMovingEndOfASheath) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 4, 16}) {
      test::Machine m = Hoist{1e6, true, false, false, integrator, substeps}.machine();
      BodyDef arm = test::lump("arm", {1.0, 0.0, 0.0}, 1.0);
      arm.mass.reset();
      arm.inertia.reset();
      arm.mobility = Mobility::kinematic;
      arm.velocity = {0.0, 0.1, 0.0};
      auto conduit = std::make_shared<SheathLink>();
      conduit->exit = m.model.add(arm);
      conduit->points = {{-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
      conduit->length = 3.0;
      conduit->bend = 1.0;
      m.cables[0].links[1] = conduit;
      Simulation s = test::start(m);
      std::optional<Divergence> end;
      while (!end && s.world.state().time < 6.0) end = s.world.step().divergence;
      ASSERT_TRUE(end) << substeps;
      for (const char* name : {"the end of the sheath", "\"arm\"", "\"load\""}) {
        EXPECT_NE(end->message.find(name), std::string::npos) << end->message;
      }
      EXPECT_NEAR(end->time, 3.5, 0.05);
    }
  }
}

// A rigid rope is spent there.
TEST(ArrivingAtEye, EndsTheRunOfARigidRope) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 4, 16}) {
      Hoist hoist{0.0, false, false, false, integrator, substeps};
      Simulation s = test::start(hoist.machine());
      std::optional<Divergence> end;
      while (!end && s.world.state().time < 6.0) end = s.world.step().divergence;
      ASSERT_TRUE(end) << substeps;
      EXPECT_NE(end->message.find("the pinhole"), std::string::npos) << end->message;
      EXPECT_NEAR(end->time, 3.5, 1.0 / 60.0 + 1e-6);
    }
  }
}

/// A bead of 1 kg on a level rail, `below` a pinhole, from which a rope leads over it to a weight of
/// 2 kg; it starts 0.5 m before the pinhole.
test::Machine bead(double below, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0);
  m.model.step.substeps = substeps;
  BodyDef slider = test::lump("bead", {-0.5, -below, 0.0}, 1.0);
  slider.mobility = Mobility::slider;
  slider.axis = Vector3::UnitX();
  const BodyId moving = m.model.add(slider);
  const BodyId weight = m.model.add(test::weight("weight", {1.0, -2.0, 0.0}, 2.0));
  CableDef rope = test::cable("rope", {});
  rope.links = {test::attach(moving), eye({0.0, 0.0, 0.0}), eye({1.0, 0.0, 0.0}),
                test::attach(weight)};
  rope.axial_stiffness = 1e5;
  rope.pretension = 19.62;
  m.cables.push_back(rope);
  return m;
}

// It passes below the pinhole, to and fro, and gives and takes the energy of the weight. At 3 m/s it
// moves by 5 cm per substep at most.
TEST(ArrivingAtEye, EndsNoRunBesideThePinhole) {
  for (const int substeps : {1, 4, 16}) {
    Simulation s = test::start(bead(0.1, substeps));
    const double energy = s.world.energy().total();
    double farthest = 0.0;
    for (int i = 0; i < 180; ++i) {
      ASSERT_TRUE(s.world.step().ok()) << i;
      farthest = std::max(farthest, s.world.position({0}).x());
    }
    EXPECT_GT(farthest, 0.4) << substeps;
    if (substeps > 1) {
      EXPECT_NEAR(s.world.energy().total(), energy, 0.02 * 9.81);
    }
  }
}

// On a rail through the pinhole it arrives.
TEST(ArrivingAtEye, EndsTheRunOnARailThroughThePinhole) {
  for (const int substeps : {1, 4, 16, 64}) {
    Simulation s = test::start(bead(0.0, substeps));
    std::optional<Divergence> end;
    while (!end && s.world.state().time < 3.0) end = s.world.step().divergence;
    ASSERT_TRUE(end) << substeps;
    EXPECT_LT(std::abs(s.world.position({0}).x()), 0.05);
  }
}

// A bead whose rope is slack flies through.
TEST(ArrivingAtEye, EndsNoRunOfASlackRope) {
  test::Machine m = bead(0.0, 4);
  m.model.gravity = Vector3::Zero();
  m.model.bodies[0].velocity = {1.0, 0.0, 0.0};
  m.cables[0].pretension.reset();
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok()) << i;
  EXPECT_NEAR(s.world.position({0}).x(), 0.5, 1e-9);
}

// A body whose motion is given may be led through a pinhole, as through a wheel.
TEST(ArrivingAtEye, EndsNoRunOfALedBody) {
  test::Machine m = bead(0.0, 4);
  BodyDef& led = m.model.bodies[0];
  led.mobility = Mobility::kinematic;
  led.axis.reset();
  led.mass.reset();
  led.inertia.reset();
  led.velocity = {1.0, 0.0, 0.0};
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok()) << i;
  EXPECT_NEAR(s.world.position({0}).x(), 0.5, 1e-9);
}

}  // namespace
}  // namespace sheave
