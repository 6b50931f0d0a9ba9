// Every machine that a knot without mass cannot be part of is refused by name.

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/live_world.h"
#include "engine/joints/ball.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr BodyId knot{0};

test::Machine sound() {
  test::Machine m;
  m.model.gravity = test::down;
  BodyDef tied;
  tied.name = "knot";
  tied.mobility = Mobility::knot;
  tied.position = {0.0, -4.0, 0.0};
  m.model.add(tied);
  m.model.add(test::lump("load", {0.0, -6.0, 0.0}, 10.0));
  for (const double x : {-3.0, 3.0}) {
    m.cables.push_back(
        test::cable(x < 0.0 ? "left" : "right",
                    {test::attach(BodyId::world(), {x, 0.0, 0.0}), test::attach(knot)}));
  }
  m.cables.push_back(test::cable("lower", {test::attach(knot), test::attach({1})}));
  return m;
}

/// The errors of the machine after a change.
std::string faults(const std::function<void(test::Machine&)>& change) {
  test::Machine m = sound();
  change(m);
  const auto made = Simulation::create(m.model, m.cables);
  return made ? "" : test::text(made.errors());
}

void expect(const std::string& path, const std::string& part,
            const std::function<void(test::Machine&)>& change) {
  const std::string told = faults(change);
  EXPECT_NE(told.find(path + ":"), std::string::npos) << path << "\n" << told;
  EXPECT_NE(told.find(part), std::string::npos) << part << "\n" << told;
}

TEST(KnotFaults, TheMachineItselfIsSound) {
  EXPECT_EQ(faults([](test::Machine&) {}), "");
}

TEST(KnotFaults, AKnotIsAPoint) {
  expect("/bodies/0/mass", "no mass", [](auto& m) { m.model.bodies[0].mass = 1.0; });
  expect("/bodies/0/shape", "no shape",
         [](auto& m) { m.model.bodies[0].shapes = m.model.bodies[1].shapes; });
  expect("/bodies/0/velocity", "no velocity", [](auto& m) { m.model.bodies[0].velocity.x() = 1; });
  expect("/bodies/0/force", "no load", [](auto& m) { m.model.bodies[0].force.x() = 1; });
  expect("/bodies/0/damping", "no drag", [](auto& m) { m.model.bodies[0].damping = 1.0; });
}

TEST(KnotFaults, TwoToFourRopesMeet) {
  expect("/bodies/0", "1 cable ends there, and a knot joins 2 to 4",
         [](auto& m) { m.cables.resize(1); });
  expect("/bodies/0", "0 cables end there", [](auto& m) { m.cables.clear(); });
  expect("/bodies/0", "5 cables end there", [](auto& m) {
    for (const char* name : {"fourth", "fifth"}) {
      m.cables.push_back(m.cables[0]);
      m.cables.back().name = name;
    }
  });
}

TEST(KnotFaults, CablesEndThereByAttachments) {
  expect("/cables/2/links/0/point", "leave \"point\" out", [](auto& m) {
    m.cables[2].links[0] = test::attach(knot, {0.0, 0.1, 0.0});
  });
  expect("/cables/2/links/1", "cables end at knots", [](auto& m) {
    m.cables[2].links = {test::attach(BodyId::world()), test::attach(knot), test::attach({1})};
  });
  expect("/cables/2/links", "joins two knots", [](auto& m) {
    BodyDef other = m.model.bodies[0];
    other.name = "other";
    other.position.y() = -5.0;
    m.model.add(other);
    m.cables[2].links[1] = test::attach({2});
  });
  expect("/cables/0/links/0/feed_speed", "no cable comes out of a knot", [](auto& m) {
    auto fed = test::attach(knot);
    fed->feed_speed = 0.0;
    m.cables[0].links = {fed, test::attach(BodyId::world(), {-3.0, 0.0, 0.0})};
  });
}

TEST(KnotFaults, SettingsOfCables) {
  expect("/cables/1", "all rigid, or all elastic",
         [](auto& m) { m.cables[1].axial_stiffness = 1e5; });
  const auto all = [](test::Machine& m, const std::function<void(CableDef&)>& set) {
    for (CableDef& cable : m.cables) {
      cable.axial_stiffness = 1e5;
      set(cable);
    }
  };
  expect("/cables/0/damping", "cannot end at a knot",
         [&](auto& m) { all(m, [](CableDef& cable) { cable.damping = 1.0; }); });
  expect("/cables/0/axial_damping", "cannot end at a knot",
         [&](auto& m) { all(m, [](CableDef& cable) { cable.axial_damping = 1.0; }); });
  expect("/cables/0/linear_density", "cannot end at a knot",
         [&](auto& m) { all(m, [](CableDef& cable) { cable.linear_density = 1.0; }); });
  expect("/cables/0/tangent_update", "take \"iteration\"",
         [](auto& m) { m.cables[0].tangent_update = TangentUpdate::substep; });
  expect("/cables/0/tension_table", "cannot end at a knot", [](auto& m) {
    for (CableDef& cable : m.cables) {
      cable.strain_table = {0.0, 0.1};
      cable.tension_table = {0.0, 1e3};
    }
  });
  expect("/cables/0/links/1", "without friction and losses", [](auto& m) {
    auto hole = std::make_shared<PinholeLink>();
    hole->body = BodyId::world();
    hole->point = {-2.0, -2.0, 0.0};
    hole->friction = 0.1;
    m.cables[0].links.insert(m.cables[0].links.begin() + 1, hole);
  });
}

TEST(KnotFaults, JointsNeedABody) {
  expect("/joints/0/body_a", "is a knot", [](auto& m) {
    auto ball = std::make_shared<BallJoint>();
    ball->name = "ball";
    ball->body_a = knot;
    ball->body_b = BodyId{1};
    m.model.joints.push_back(ball);
  });
}

// Stretched ropes whose forces do not balance at the given position.
TEST(KnotFaults, TheForcesBalanceAtTime0) {
  expect("/bodies/0/position", "balance at [0, -3.992", [](auto& m) {
    for (CableDef& cable : m.cables) cable.axial_stiffness = 1e5;
    m.model.bodies[0].position.y() = -3.9;
    m.cables[0].rest_lengths = m.cables[1].rest_lengths = {4.95};
    m.cables[2].rest_lengths = {1.98};
  });
}

// Two loads on one knot between two supports: four tensions, and one row.
TEST(KnotFaults, FourRigidRopesInOnePlane) {
  expect("/bodies/0", "do not determine their tensions", [](auto& m) {
    m.model.add(test::lump("second", {1.0, -6.0, 0.0}, 10.0));
    m.cables.push_back(test::cable("second", {test::attach(knot), test::attach({2})}));
  });
  // The same out of one plane.
  EXPECT_EQ(faults([](test::Machine& m) {
              m.cables.push_back(test::cable(
                  "stay", {test::attach(knot), test::attach(BodyId::world(), {0.0, 0.0, 3.0})}));
            }),
            "");
}

// Two loads whose ropes come into one plane while they swing.
TEST(KnotFaults, FourRopesThatComeIntoOnePlaneEndTheRun) {
  test::Machine m = sound();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  m.model.add(test::lump("second", {0.6, -5.8, 0.5}, 10.0));
  m.cables.push_back(test::cable("second", {test::attach(knot), test::attach({2})}));
  Simulation s = test::start(m);
  std::string why;
  for (int i = 0; i < 600 && why.empty(); ++i) {
    const StepReport report = s.world.step();
    if (!report.ok()) why = report.divergence->message;
  }
  EXPECT_NE(why.find("do not determine their tensions"), std::string::npos) << why;
}

TEST(KnotFaults, LiveWorldsRefuseByName) {
  const test::Machine m = sound();
  auto world = LiveWorld::create(m.model, m.cables);
  ASSERT_TRUE(world) << test::text(world.errors());
  const BodyHandle tied = world->body("knot").value();
  const BodyHandle load = world->body("load").value();
  const CableHandle rope = world->cable("left").value();
  const auto placed = world->place(load, {0.5, -5.0, 0.0}, Quaternion::Identity(), Keep::length);
  ASSERT_FALSE(placed);
  EXPECT_NE(test::text(placed.errors()).find("knots without mass"), std::string::npos);
  PointForce push;
  push.force = {1.0, 0.0, 0.0};
  EXPECT_NE(test::text(world->set_force(tied, push)).find("is a knot"), std::string::npos);
  ASSERT_TRUE(world->step().ok());
  EXPECT_TRUE(world->cut(rope).empty());
  ASSERT_TRUE(world->step().ok());
  EXPECT_TRUE(world->is_cut(rope));
}

}  // namespace
}  // namespace sheave
