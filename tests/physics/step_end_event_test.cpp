// Events that fall on the very end of a substep, and a little to either side of it: rounding
// decides in which substep they are found, and that must make no difference.
//
// Without gravity everything before and after an event moves evenly, so what follows is known to
// rounding.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/joints/slider.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::Heap;

constexpr double step_length = 1.0 / 60.0;
/// How much later than the end of the 30th step, at 1 m/s and 0.5 s [m].
constexpr std::array<double, 5> event_shifts{-1e-9, -1e-12, 0.0, 1e-12, 1e-9};
// Row::softness leaves 1e-9 of an impact, and the shift is 1e-9 at the most.
constexpr double event_tolerance = 1e-8;

StepSettings step_end_settings(const test::Method& method) {
  StepSettings step = test::settings(step_length, 1, 50);
  step.solver = method.solver;
  step.integrator = method.integrator;
  return step;
}

void take_steps(World& world, int count) {
  for (int i = 0; i < count; ++i) ASSERT_TRUE(world.step().ok());
}

TEST(StepEndEvents, BallsThatMeetSeparate) {
  for (const test::Method& method : test::methods) {
    for (const double restitution : {0.0, 0.5, 1.0}) {
      for (const double shift : event_shifts) {
        SCOPED_TRACE(test::name_of(method) + ", restitution " + std::to_string(restitution) +
                     ", shift " + std::to_string(1e12 * shift) + "e-12");
        Heap heap(method.solver, method.integrator);
        heap.model.gravity.setZero();
        heap.model.step = step_end_settings(method);
        heap.surface.restitution = restitution;
        const BodyId first = heap.put(test::ball(0.25), Vector3::Zero());
        heap.last().velocity = {0.5, 0.0, 0.0};
        const BodyId second = heap.put(test::ball(0.25), {1.0 + shift, 0.0, 0.0});
        heap.last().velocity = {-0.5, 0.0, 0.0};
        World world = heap.start();
        take_steps(world, 60);
        EXPECT_NEAR(world.velocity(first).x(), -0.5 * restitution, event_tolerance);
        EXPECT_NEAR(world.velocity(second).x(), 0.5 * restitution, event_tolerance);
        EXPECT_NEAR(world.position(first).x(), 0.25 - 0.25 * restitution, event_tolerance);
      }
    }
  }
}

TEST(StepEndEvents, ABallThatMeetsTheFloorBounces) {
  // Under gravity, at rest 1 m above a floor that it meets after n steps, and so on: with e = 1 its
  // energy is what it was.
  for (const test::Method& method : test::methods) {
    for (const double shift : event_shifts) {
      SCOPED_TRACE(test::name_of(method) + ", shift " + std::to_string(1e12 * shift) + "e-12");
      const double height = 0.5 * test::g * 0.25;  // fallen through in 30 steps by `rattle`
      Heap heap(method.solver, method.integrator);
      heap.model.step = step_end_settings(method);
      heap.surface.restitution = 1.0;
      heap.floor();
      const BodyId ball = heap.put(test::ball(0.25), {0.0, 0.25 + height + shift, 0.0});
      World world = heap.start();
      take_steps(world, 59);
      // `xpbd` has the velocity of the middle of a substep, and an impact that it moves by half of
      // one.
      const double lag = method.integrator == IntegratorKind::xpbd ? test::g * step_length : 1e-8;
      EXPECT_NEAR(world.velocity(ball).y(), test::g * step_length, lag);
      EXPECT_NEAR(world.position(ball).y(),
                  0.25 + height - 0.5 * test::g * step_length * step_length,
                  height * (method.integrator == IntegratorKind::xpbd ? 0.1 : 1e-8));
    }
  }
}

TEST(StepEndEvents, StopsHold) {
  for (const test::Method& method : test::methods) {
    for (const double shift : event_shifts) {
      SCOPED_TRACE(test::name_of(method) + ", shift " + std::to_string(1e12 * shift) + "e-12");
      Model model;
      model.gravity.setZero();
      model.step = step_end_settings(method);
      BodyDef body = test::lump("sledge", Vector3::Zero(), 2.0);
      body.velocity = {1.0, 0.0, 0.0};
      const BodyId sledge = model.add(body);
      auto guide = std::make_shared<SliderJoint>();
      guide->name = "guide";
      guide->body_a = BodyId::world();
      guide->body_b = sledge;
      guide->axis = Vector3::UnitX();
      guide->travel.upper = 0.5 + shift;
      model.joints.push_back(guide);
      World world = test::start(model);
      take_steps(world, 60);
      EXPECT_NEAR(world.velocity(sledge).norm(), 0.0, event_tolerance);
      EXPECT_NEAR(world.position(sledge).x(), 0.5, event_tolerance);
    }
  }
}

TEST(StepEndEvents, CablesGoTaut) {
  // Two bodies of 1 kg and 3 kg: the cable takes the relative velocity, and the momentum stays.
  for (const test::Method& method : test::methods) {
    for (const double shift : event_shifts) {
      SCOPED_TRACE(test::name_of(method) + ", shift " + std::to_string(1e12 * shift) + "e-12");
      test::Machine m;
      m.model.gravity.setZero();
      m.model.step = step_end_settings(method);
      BodyDef moving = test::lump("moving", {1.0, 0.0, 0.0}, 1.0);
      moving.velocity = {1.0, 0.0, 0.0};
      const BodyId first = m.model.add(moving);
      const BodyId second = m.model.add(test::lump("waiting", Vector3::Zero(), 3.0));
      m.cables.push_back(test::cable("rope", {test::attach(first), test::attach(second)}));
      m.cables[0].rest_lengths = {1.5 + shift};
      Simulation s = test::start(m);
      take_steps(s.world, 60);
      EXPECT_NEAR(s.world.velocity(first).x(), 0.25, event_tolerance);
      EXPECT_NEAR(s.world.velocity(second).x(), 0.25, event_tolerance);
      EXPECT_NEAR(s.world.position(first).x(), 1.5 + 0.125, event_tolerance);
    }
  }
}

TEST(StepEndEvents, CablesAreCut) {
  for (const test::Method& method : test::methods) {
    for (const double shift : event_shifts) {
      SCOPED_TRACE(test::name_of(method) + ", shift " + std::to_string(1e12 * shift) + "e-12");
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = step_end_settings(method);
      const BodyId load = m.model.add(test::weight("load", {0.0, -1.0, 0.0}, 2.0));
      m.cables.push_back(test::cable("rope", {test::attach(BodyId::world()), test::attach(load)}));
      m.cables[0].cut_time = 0.5 + shift;
      Simulation s = test::start(m);
      take_steps(s.world, 60);
      EXPECT_NEAR(s.world.velocity(load).y(), -0.5 * test::g, event_tolerance);
      ASSERT_EQ(s.cables->events().size(), 1U);
      EXPECT_NEAR(s.cables->events()[0].time, 0.5, 1e-8);
    }
  }
}

}  // namespace
}  // namespace sheave
