// Bodies that a cable comes to touch though it does not list them.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::attach;
using test::box;
using test::cable;
using test::left;
using test::roll;

BodyDef obstacle(std::string name, std::shared_ptr<const Shape> shape, const Vector3& position) {
  BodyDef body = test::static_body(std::move(name), std::move(shape), position);
  body.wrappable = true;
  return body;
}

std::shared_ptr<const Shape> cylinder(double radius, double length = 0.2) {
  return test::cylinder_of(radius, length);
}

/// An elastic cable of 2 m and 1e-3 m/N from (-1, 0, 0) to (1, 0, 0), both ends kinematic with the
/// velocity `velocity`. Bodies: 0 and 1 its ends, then the obstacles.
test::Machine drawn_cable(const Vector3& velocity, std::vector<BodyDef> obstacles) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::settings(0.01, 1, 20);
  for (const double x : {-1.0, 1.0}) {
    BodyDef end;
    end.name = x < 0.0 ? "first" : "second";
    end.mobility = Mobility::kinematic;
    end.position = {x, 0.0, 0.0};
    end.velocity = velocity;
    m.model.add(end);
  }
  for (BodyDef& body : obstacles) m.model.add(std::move(body));
  m.cables.push_back(cable("rope", {attach({0}), attach({1})}));
  m.cables[0].compliance = 1e-3;
  return m;
}

void step(Simulation& s, int count) {
  for (int i = 0; i < count; ++i) ASSERT_TRUE(s.world.step().ok());
}

TEST(Wrap, ACableIsPulledRoundAPostFromEitherSide) {
  for (const double way : {1.0, -1.0}) {
    for (const bool turned : {false, true}) {
      BodyDef post = obstacle("post", cylinder(0.2), {0.0, 0.3 * way, 0.0});
      if (turned) post.orientation = Quaternion(0.0, 1.0, 0.0, 0.0);  // its axis the other way
      Simulation s = test::start(drawn_cable({0.0, 0.5 * way, 0.0}, {post}));
      step(s, 19);
      EXPECT_TRUE(s.cable_reports()[0].wraps.empty()) << "0.005 m apart";
      step(s, 81);
      const CableReport report = s.cable_reports()[0];
      ASSERT_EQ(report.wraps.size(), 1U);
      const WrapReport& wrap = report.wraps[0];
      EXPECT_EQ(wrap.link.body, BodyId{2});
      // Seen along +z, a cable to the right with the post ahead (above) runs counter-clockwise.
      EXPECT_EQ(wrap.link.winding * (turned ? -1 : 1), way > 0.0 ? 1 : -1);
      // The ends are 0.5 m past their start, 0.2 m past the post's centre; radius 0.2 m.
      const double d = std::hypot(1.0, 0.2);
      const double tangent = std::sqrt(d * d - 0.04);
      // Directions from the centre: to an end atan2(1, 0.2) off the way back, to the tangent point
      // acos(r / d) further.
      const double half_arc = pi - std::atan2(1.0, 0.2) - std::acos(0.2 / d);
      const double length = 2.0 * tangent + 0.4 * half_arc;
      // No friction: one tension throughout. The spring sees two spans, each with its own
      // compliance.
      const double tension = (length - 2.0) / 2e-3;
      EXPECT_NEAR(wrap.link.stored_length, 0.4 * half_arc, 1e-9);
      EXPECT_NEAR(report.spans[0].tension, tension, 1e-6 * tension);
      EXPECT_NEAR(wrap.span.tension, tension, 1e-6 * tension);
      EXPECT_EQ(report.length_error, 0.0);
      ASSERT_EQ(s.cables->events().size(), 1U);
      EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::touch);
      EXPECT_EQ(s.cables->events()[0].link, -1);
      EXPECT_EQ(s.cables->events()[0].body, "post");
    }
  }
}

TEST(Wrap, ACableComesOffWhereItCameOn) {
  // A post, a box that stands on a corner, and one that lies flat; the lowest points of all are at
  // y = 0.1.
  BodyDef tilted = obstacle("box", box({0.2, 0.2, 0.2}), {0.0, 0.1 + 0.1 * std::sqrt(2.0), 0.0});
  tilted.orientation = rotation_by({0.0, 0.0, 0.25 * pi});
  for (const BodyDef& thing : {obstacle("post", cylinder(0.2), {0.0, 0.3, 0.0}), tilted,
                               obstacle("flat", box({0.8, 0.4, 0.2}), {0.0, 0.3, 0.0})}) {
    test::Machine m = drawn_cable(Vector3::Zero(), {thing});
    for (std::size_t i = 0; i < 2; ++i) {
      m.model.bodies[i].oscillation = {0.0, 0.5, 0.0};
      m.model.bodies[i].oscillation_frequency = 1.0;
    }
    Simulation s = test::start(m);
    step(s, 400);
    const auto& events = s.cables->events();
    ASSERT_EQ(events.size(), 8U) << thing.name;
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(events[i].kind, i % 2 == 0 ? CableEvent::Kind::touch : CableEvent::Kind::leave);
      // The chord is at y = 0.5 sin(2 pi t); what happens is found at the end of a step of 0.01 s.
      const double rising = std::asin(0.2) / (2.0 * pi) + static_cast<double>(i / 2);
      const double falling = 0.5 - std::asin(0.2) / (2.0 * pi) + static_cast<double>(i / 2);
      const double expected = i % 2 == 0 ? rising : falling;
      EXPECT_GE(events[i].time, expected - 1e-9) << thing.name;
      EXPECT_LE(events[i].time, expected + 0.01 + 1e-9) << thing.name;
    }
    const CableReport report = s.cable_reports()[0];
    EXPECT_TRUE(report.wraps.empty());
    EXPECT_NEAR(report.spans[0].rest_length, 2.0, 1e-15);
    EXPECT_EQ(report.length_error, 0.0);
  }
}

TEST(Wrap, AFastCableDoesNotGoThroughAThinPost) {
  // 0.1 m in a step, past a post of 2 cm.
  Simulation s = test::start(
      drawn_cable({0.0, 10.0, 0.0}, {obstacle("post", cylinder(0.01), {0.0, 0.25, 0.0})}));
  step(s, 10);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  EXPECT_EQ(report.wraps[0].link.winding, 1);
}

TEST(Wrap, SeveralPostsInOneStepAreTakenInTheirOrder) {
  std::vector<BodyDef> posts;
  for (int i = 0; i < 5; ++i) {
    // Numbered against the cable's direction, on a convex arc, so that the cable needs them all.
    const double x = 0.6 - 0.3 * i;
    posts.push_back(
        obstacle("post" + std::to_string(i), cylinder(0.02), {x, 0.05 + 0.1 * x * x, 0.0}));
  }
  Simulation s = test::start(drawn_cable({0.0, 30.0, 0.0}, posts));
  step(s, 1);
  CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 5U) << "0.3 m: past all of them";
  for (int i = 0; i < 5; ++i) {
    const WrapReport& wrap = report.wraps[static_cast<std::size_t>(i)];
    EXPECT_EQ(wrap.link.body, BodyId{6 - i}) << "from left to right";
    EXPECT_EQ(wrap.after, 0);
    if (i > 0) {
      EXPECT_LT(wrap.link.entry.x(), wrap.link.exit.x());
    }
  }
  EXPECT_EQ(report.length_error, 0.0);
  const std::vector<CableEvent> events = s.cables->events();
  EXPECT_EQ(events.size(), 5U);
}

TEST(Wrap, RoundABoxTheCableLiesAlongTheEdgesItNeeds) {
  Simulation s = test::start(
      drawn_cable({0.0, 0.5, 0.0}, {obstacle("box", box({0.8, 0.4, 0.2}), {0.0, 0.3, 0.0})}));
  step(s, 100);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  // Ends at y = 0.5, lower corners at (+-0.4, 0.1): the lower edge is taken, 0.8 m.
  EXPECT_NEAR(report.wraps[0].link.stored_length, 0.8, 1e-12);
  const double length = 2.0 * std::hypot(0.6, 0.4) + 0.8;
  EXPECT_NEAR(report.spans[0].tension, (length - 2.0) / 2e-3, 1e-6 * (length - 2.0) / 2e-3);
  EXPECT_EQ(report.length_error, 0.0);
}

TEST(Wrap, ALongWallIsTouchedThoughItsCentreLiesBeyondTheCable) {
  // The wall's end, x = 0.5, comes down between the cable's ends; its centre stays to the right of
  // both.
  BodyDef wall = obstacle("wall", box({4.0, 0.2, 0.2}), {2.5, 0.3, 0.0});
  wall.orientation = rotation_by({0.0, 0.0, 0.3});
  const Vector3 corner =
      wall.position + wall.orientation * Vector3(-2.0, -0.1, 0.0) - Vector3(0.0, 0.0, 0.0);
  ASSERT_LT(corner.x(), 1.0);
  wall.position.y() -= corner.y() - 0.2;
  Simulation s = test::start(drawn_cable({0.0, 0.5, 0.0}, {wall}));
  step(s, 60);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  // Round the corner at (corner.x, 0.2): an edge has no arc.
  const double x = corner.x();
  const double length = std::hypot(1.0 + x, 0.1) + std::hypot(1.0 - x, 0.1);
  EXPECT_NEAR(report.wraps[0].link.stored_length, 0.0, 1e-12);
  EXPECT_NEAR(report.spans[0].tension, (length - 2.0) / 2e-3, 1e-6 * (length - 2.0) / 2e-3);
}

TEST(Wrap, ABallInSpaceIsWrappedInThePlaneOfCableAndCentre) {
  // Drawn obliquely, so that no axis of the scene lies in the plane.
  const Vector3 way = Vector3(0.0, 0.3, 0.4) / 0.5;
  Simulation s =
      test::start(drawn_cable(0.5 * way, {obstacle("ball", test::sphere_of(0.2), 0.3 * way)}));
  step(s, 100);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  const double d = std::hypot(1.0, 0.2);
  const double half_arc = pi - std::atan2(1.0, 0.2) - std::acos(0.2 / d);
  const double length = 2.0 * std::sqrt(d * d - 0.04) + 0.4 * half_arc;
  EXPECT_NEAR(report.wraps[0].link.stored_length, 0.4 * half_arc, 1e-6);
  EXPECT_NEAR(report.spans[0].tension, (length - 2.0) / 2e-3, 1e-4 * (length - 2.0) / 2e-3);
}

TEST(Wrap, ALogIsWrappedWhereTheCableMeetsIt) {
  // Free ends make the cable's plane unknown at the start; the log's axis is z, the cable passes
  // 0.7 m along it.
  test::Machine m =
      drawn_cable({0.0, 0.5, 0.0}, {obstacle("log", cylinder(0.2, 2.0), {0.0, 0.3, -0.7})});
  m.model.bodies[0].velocity = {0.0, 0.5, 1e-9};  // leaves the plane, so the general way is taken
  Simulation s = test::start(m);
  step(s, 100);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  EXPECT_NEAR(report.wraps[0].link.center.z(), 0.0, 1e-6);
  const double d = std::hypot(1.0, 0.2);
  const double half_arc = pi - std::atan2(1.0, 0.2) - std::acos(0.2 / d);
  EXPECT_NEAR(report.wraps[0].link.stored_length, 0.4 * half_arc, 1e-6);
  // Beyond its end nothing is touched.
  m.model.bodies[2].position.z() = -1.3;
  Simulation past = test::start(m);
  step(past, 100);
  EXPECT_TRUE(past.cable_reports()[0].wraps.empty());
}

TEST(Wrap, FrictionOfAWrapIsTheCapstans) {
  // The second end goes on to the right when both have gone up: cable is pulled over the post
  // towards it.
  const double friction = 0.3;
  test::Machine m =
      drawn_cable({0.0, 0.5, 0.0}, {obstacle("post", cylinder(0.2), {0.0, 0.3, 0.0})});
  m.model.bodies[1].velocity.x() = 0.3;
  m.cables[0].wrap_friction = friction;
  Simulation s = test::start(m);
  step(s, 100);
  const CableReport report = s.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  const WrapReport& wrap = report.wraps[0];
  const double ratio = std::exp(friction * wrap.link.wrap_angle);
  EXPECT_NEAR(wrap.span.tension / report.spans[0].tension, ratio, 1e-9 * ratio);
  EXPECT_GT(wrap.link.slip, 0.01);
}

TEST(Wrap, ATumblingBoxGainsNoEnergyFromTheCableThatCatchesIt) {
  for (const SolverKind solver : {SolverKind::gauss_seidel, SolverKind::direct}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.0025, 1, 100);
    m.model.step.solver = solver;
    BodyDef thing;
    thing.name = "box";
    thing.position = {0.02, 1.0, 0.0};
    thing.mass = 2.0;
    thing.wrappable = true;
    thing.angular_velocity = {0.1, 0.0, 2.0};
    PlacedShape placed;
    placed.shape = box({0.4, 0.3, 1.0});
    thing.shapes.push_back(placed);
    m.model.add(thing);
    m.cables.push_back(cable("rope", {attach(BodyId::world(), {-1.0, 0.5, 0.0}),
                                      attach(BodyId::world(), {1.0, 0.5, 0.0})}));
    m.cables[0].rest_lengths = {2.3};
    Simulation s = test::start(m);
    const double start = s.world.energy().total();
    double before = start;
    double rise = 0.0;
    for (int i = 0; i < 600; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const double now = s.world.energy().total();
      rise = std::max(rise, now - before);
      before = now;
    }
    EXPECT_FALSE(s.cables->events().empty());
    EXPECT_LT(rise, 1e-3 * start) << "in one step";
    EXPECT_LT(before, start);
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
  }
}

TEST(Wrap, MoreWrapsThanThereArePlacesForAreReported) {
  std::vector<BodyDef> posts;
  for (int i = 0; i < 4; ++i) {
    posts.push_back(obstacle("post" + std::to_string(i), cylinder(0.05),
                             {0.4 * i - 0.6, 0.2 + 0.1 * (i % 2), 0.0}));
  }
  test::Machine m = drawn_cable({0.0, 0.5, 0.0}, posts);
  m.cables[0].most_wraps = 2;
  Simulation s = test::start(m);
  step(s, 200);
  EXPECT_EQ(s.cable_reports()[0].wraps.size(), 2U);
  ASSERT_EQ(s.cables->wrap_warnings().size(), 1U);
  EXPECT_EQ(s.cables->wrap_warnings()[0].cable, "rope");
  m.cables[0].most_wraps = 0;
  Simulation through = test::start(m);
  step(through, 200);
  EXPECT_TRUE(through.cables->events().empty());
}

TEST(Wrap, ACableThatStartsInABodyIsAnError) {
  const test::Machine m =
      drawn_cable(Vector3::Zero(), {obstacle("post", cylinder(0.2), {0.0, 0.1, 0.0})});
  const Result<Simulation> s = Simulation::create(m.model, m.cables);
  ASSERT_FALSE(s.ok());
  EXPECT_EQ(s.errors()[0].path, "/cables/0/links/1");
  EXPECT_NE(s.errors()[0].message.find("runs through the wrappable body \"post\""),
            std::string::npos);
}

// On no side of it, in no plane that follows from the span.
TEST(Wrap, ACableThroughTheMiddleOfABodyIsAnErrorToo) {
  const std::vector<std::shared_ptr<const Shape>> shapes{cylinder(0.2), test::sphere_of(0.2),
                                                         box({0.3, 0.3, 0.3})};
  for (const auto& shape : shapes) {
    const test::Machine m =
        drawn_cable(Vector3::Zero(), {obstacle("post", shape, Vector3::Zero())});
    const Result<Simulation> s = Simulation::create(m.model, m.cables);
    ASSERT_FALSE(s.ok());
    EXPECT_NE(s.errors()[0].message.find("runs through the wrappable body \"post\""),
              std::string::npos);
  }
}

TEST(Wrap, AStateWithWrapsCanBeRestored) {
  test::Machine m =
      drawn_cable(Vector3::Zero(), {obstacle("post", cylinder(0.2), {0.0, 0.3, 0.0}),
                                    obstacle("ball", test::sphere_of(0.1), {0.3, -0.3, 0.0})});
  for (std::size_t i = 0; i < 2; ++i) {
    m.model.bodies[i].oscillation = {0.0, 0.5, 0.1};
    m.model.bodies[i].oscillation_frequency = 1.0;
  }
  Simulation s = test::start(m);
  step(s, 30);
  ASSERT_EQ(s.cable_reports()[0].wraps.size(), 1U);
  const State saved = s.world.state();
  step(s, 50);
  const std::uint64_t later = hash(s.world.state());
  ASSERT_TRUE(s.world.restore(saved).empty());
  step(s, 50);
  EXPECT_EQ(hash(s.world.state()), later);
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(saved).empty());
  step(other, 50);
  EXPECT_EQ(hash(other.world.state()), later);
}

TEST(Wrap, AStateWithAnImpossibleCourseIsRefused) {
  test::Machine m =
      drawn_cable({0.0, 0.5, 0.0}, {obstacle("post", cylinder(0.2), {0.0, 0.3, 0.0})});
  Simulation s = test::start(m);
  step(s, 50);
  const State saved = s.world.state();
  ASSERT_TRUE(s.world.restore(saved).empty());
  int refused = 0;
  const std::size_t integers = saved.features.back().integers.size();
  for (std::size_t i = 0; i < integers; ++i) {
    for (const std::int64_t value :
         std::initializer_list<std::int64_t>{-1000, -2, -1, 0, 1, 2, 5, 17, 1000}) {
      State broken = saved;
      broken.features.back().integers[i] = value;
      if (s.world.restore(broken).empty()) {
        step(s, 3);  // whatever it means, it must not read or write where it should not
      } else {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, static_cast<int>(integers) * 4);
}

TEST(Wrap, RandomContactsLoseNoLength) {
  // Two ends swing with frequencies that have no common period among posts, balls and boxes, in a
  // plane and out of it.
  for (const double depth : {0.0, 0.3}) {
    std::vector<BodyDef> things;
    for (int i = 0; i < 9; ++i) {
      const Vector3 place(0.45 * (i % 3) - 0.45, 0.3 * (i / 3) - 0.3 + (i < 3 ? -0.05 : 0.06), 0.0);
      const auto shape = i % 3 == 0   ? cylinder(0.04)
                         : i % 3 == 1 ? test::sphere_of(0.04)
                                      : box({0.06, 0.08, 0.1});
      things.push_back(obstacle("thing" + std::to_string(i), shape, place));
    }
    test::Machine m = drawn_cable(Vector3::Zero(), things);
    m.model.bodies[0].oscillation = {0.1, 0.9, depth};
    m.model.bodies[0].oscillation_frequency = 1.37;
    m.model.bodies[1].oscillation = {-0.1, 1.1, depth};
    m.model.bodies[1].oscillation_frequency = 1.91;
    m.cables[0].wrap_friction = 0.1;
    Simulation s = test::start(m);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      worst = std::max(worst, std::abs(report.length_error));
      for (const WrapReport& wrap : report.wraps) {
        // Only what has just touched can be below 0, by a neighbour's touch, until the next step.
        const std::string& body =
            m.model.bodies[static_cast<std::size_t>(wrap.link.body.index)].name;
        const bool fresh = std::any_of(
            s.cables->events().begin(), s.cables->events().end(), [&](const CableEvent& event) {
              return event.body == body && event.time == s.world.state().time;
            });
        // Round the corner of a box, in a plane tilted by at most 0.6 m in 1.7 m, an edge of 8 cm
        // counts 5 mm less.
        const double tilt = depth > 0.0 ? 0.005 : 0.0;
        EXPECT_TRUE(wrap.link.stored_length >= -tilt || fresh) << body;
      }
    }
    EXPECT_EQ(worst, 0.0);
    EXPECT_GT(s.cables->events().size(), 100U) << depth;
    const auto& events = s.cables->events();
    for (std::size_t i = 1; i < events.size(); ++i) {
      EXPECT_TRUE(events[i].time > events[i - 1].time || events[i].body != events[i - 1].body);
    }
  }
}

TEST(Wrap, ABeltCanLeaveAllItsListedWheels) {
  // Two posts in a belt part and stretch it; the wheels that it ran over pass each other between
  // its two sides.
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::settings(0.005, 1, 50);
  const auto add = [&](const char* name, double radius, const Vector3& position,
                       const Vector3& velocity, bool wrappable) {
    BodyDef body = obstacle(name, cylinder(radius), position);
    body.mobility = Mobility::kinematic;
    body.velocity = velocity;
    body.wrappable = wrappable;
    return m.model.add(body);
  };
  const BodyId a = add("a", 0.2, {-1.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, false);
  const BodyId b = add("b", 0.2, {1.0, 0.0, 0.0}, {-0.4, 0.0, 0.0}, false);
  add("upper", 0.15, {-0.4, 0.0, 0.0}, {0.0, 1.0, 0.0}, true);
  add("lower", 0.15, {0.4, 0.0, 0.0}, {0.0, -1.0, 0.0}, true);
  CableDef belt = cable("belt", {roll(a, left), roll(b, left)});
  belt.closed = true;
  belt.axial_stiffness = 1000.0;
  m.cables.push_back(belt);
  Simulation s = test::start(m);
  int alone = 0;
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.length_error, 0.0, 1e-14);
    if (report.links[0].touched || report.links[1].touched) continue;
    ++alone;
    ASSERT_EQ(report.wraps.size(), 2U);
    EXPECT_NEAR(report.wraps[0].span.tension, report.wraps[1].span.tension, 1e-6);
  }
  EXPECT_GT(alone, 0);
}

}  // namespace
}  // namespace sheave
