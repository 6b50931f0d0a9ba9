// Ropes over cones, tori and ellipsoids: as links and as bodies that a rope finds by itself.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/surface.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/torus.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::cylinder_of;
using test::make;
using test::sphere_of;
using test::static_body;

std::shared_ptr<Shape> ellipsoid_of(const Vector3& half_axes) {
  return make<Ellipsoid>([&](Ellipsoid& e) { e.half_axes = half_axes; });
}

std::shared_ptr<Shape> torus_of(double radius, double tube) {
  return make<Torus>([&](Torus& t) { t.radius = radius, t.tube_radius = tube; });
}

std::shared_ptr<Shape> cone_of(double radius, double top, double length) {
  return make<Cone>([&](Cone& c) { c.radius = radius, c.top_radius = top, c.length = length; });
}

std::shared_ptr<SurfaceLink> beside(int body, const Vector3& side) {
  auto link = std::make_shared<SurfaceLink>();
  link->body = BodyId{body};
  link->side_point = side;
  return link;
}

/// A body with this shape, turned, between two points, with a rope over the side of +y.
struct Form {
  const char* name;
  std::shared_ptr<Shape> shape;
  Vector3 place;
  Vector3 turn;
};

std::vector<Form> forms() {
  return {{"ellipsoid", ellipsoid_of({0.3, 0.2, 0.6}), Vector3::Zero(), {0.2, 0.3, 0.1}},
          // The rope crosses the top of the ring's tube.
          {"torus", torus_of(0.6, 0.15), {0.0, -0.6, 0.0}, {0.1, 1.5, 0.0}},
          {"cone", cone_of(0.25, 0.15, 1.5), Vector3::Zero(), {0.1, 0.2, 0.0}},
          {"upturned cone", cone_of(0.15, 0.25, 1.5), Vector3::Zero(), {0.1, 0.2, 0.0}}};
}

/// A weight of 1 kg on a rope over the form from a point of the world; all turned by `turn`.
test::Machine weight_on(const Form& form, const Quaternion& turn = Quaternion::Identity(),
                        double friction = 0.0) {
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  m.model.gravity = turn * test::down;
  m.model.add(static_body("form", form.shape, turn * form.place));
  m.model.bodies[0].orientation = turn * rotation_by(form.turn);
  BodyDef bob;
  bob.name = "bob";
  bob.mass = 1.0;
  bob.inertia = Vector3(1e-2, 1e-2, 1e-2);
  bob.position = turn * Vector3(0.6, -0.5, 0.1);
  m.model.add(bob);
  const Vector3 top = form.place + Vector3(0.0, form.shape->type() == "torus" ? 0.6 : 0.0, 0.0) +
                      Vector3(0.0, 1.0, 0.0);
  auto link = beside(0, rotation_by(form.turn).conjugate() * (top - form.place));
  link->friction = friction;
  m.cables.push_back(test::cable(
      "rope",
      {test::attach(BodyId::world(), turn * Vector3(-0.8, -0.3, -0.05)), link, test::attach({1})}));
  m.cables[0].compliance = 1e-4;
  return m;
}

std::string refused(const test::Machine& m) {
  const auto made = Simulation::create(m.model, m.cables);
  return made ? std::string() : test::text(made.errors());
}

// The published path (tests/cable/geodesic_surfaces_test.cpp) as a cable; its side points are those of
// the published test. Rounding of the sum: thirty operations of the size of the length.
TEST(CurvedSurface, FourBodiesInARowAreThePublishedPath) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.add(static_body("torus", torus_of(10.0, 1.0), {1.0, 11.0, 0.0}));
  m.model.bodies[0].orientation = rotation_by({0.0, 0.5 * pi, 0.0});
  m.model.add(static_body("ellipsoid", ellipsoid_of({1.0, 1.0, 0.75}), {4.5, 1.0, 0.0}));
  m.model.add(static_body("ball", sphere_of(1.5), {4.0, -2.0, 0.0}));
  m.model.add(static_body("bar", cylinder_of(2.0, 6.0), {-2.0, -1.5, 0.0}));
  m.cables.push_back(test::cable(
      "rope", {test::attach(BodyId::world(), Vector3::Zero()), beside(0, {0.0, -8.0, 0.0}),
               beside(1, {1.0, 1.0, 0.0}), beside(2, {1.0, -2.0, 0.0}), beside(3, {0.0, -3.0, 0.0}),
               test::attach(BodyId::world(), {-4.0, 0.0, 0.0})}));
  m.cables[0].compliance = 1e-4;
  ASSERT_EQ(refused(m), "");
  const CableReport report = test::start(m).cable_reports()[0];
  EXPECT_NEAR(report.total_length, 15.0 + 5.5 * pi / 2.0, 2e-13);
  const std::vector<double> radii{1.0, 1.0, 1.5, 2.0};
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_NEAR(report.links[i + 1].stored_length, radii[i] * pi / 2.0, 1e-12) << i;
    EXPECT_NEAR(report.links[i + 1].wrap_angle, pi / 2.0, 1e-12) << i;
  }
}

// A free swing of a weight on a rope over each body: energy within the second order of the step, the
// same machine turned in space, and a certificate that differentiates the path again.
TEST(CurvedSurface, ASwingKeepsItsEnergyInSecondOrder) {
  const Quaternion turn = rotation_by({0.4, -1.3, 0.7});
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    ASSERT_EQ(refused(weight_on(form)), "");
    std::vector<double> drifts;
    for (const int substeps : {8, 16, 32}) {
      test::Machine m = weight_on(form);
      m.model.step.substeps = substeps;
      Simulation s = test::start(m);
      ASSERT_GT(s.cable_reports()[0].links[1].stored_length, 0.01);
      const double energy = s.world.energy().total();
      double drift = 0.0;
      for (int i = 0; i < 12; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        drift = std::max(drift, std::abs(s.world.energy().total() - energy));
      }
      drifts.push_back(drift);
      EXPECT_TRUE(s.cable_reports()[0].links[1].touched);
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
    EXPECT_GT(drifts[0] / drifts[2], 9.0) << "second order: 16";
    EXPECT_LT(drifts[2], 2e-3 * test::g);
    Simulation plain = test::start(weight_on(form));
    Simulation other = test::start(weight_on(form, turn));
    test::run(plain.world, 0.1);
    test::run(other.world, 0.1);
    EXPECT_LT((turn * plain.world.position({1}) - other.world.position({1})).norm(), 1e-9);
  }
}

// The rope is pulled over a rough body: the capstan's law with the integral of the curvature.
TEST(CurvedSurface, FrictionIsTheCapstansOnTheGeodesic) {
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    test::Machine m = weight_on(form, Quaternion::Identity(), 0.25);
    m.model.step.integrator = IntegratorKind::xpbd;
    m.model.step.substeps = 16;
    m.model.bodies[1].mobility = Mobility::kinematic;
    m.model.bodies[1].velocity = {0.1, -0.3, 0.02};
    Simulation s = test::start(m);
    test::run(s.world, 0.1);
    const CableReport report = s.cable_reports()[0];
    ASSERT_TRUE(report.links[1].touched);
    EXPECT_GT(report.links[1].wrap_angle, 0.1);
    const double ratio = std::exp(0.25 * report.links[1].wrap_angle);
    EXPECT_NEAR(report.spans[1].tension / report.spans[0].tension, ratio, 1e-8 * ratio);
  }
}

// A body of each form is pushed into a rope between two walls and drawn back: one touch, one departure,
// and not a bit of the rope's length is lost. The tension is that of the length, whether the rope finds
// the body or has it in its list.
TEST(CurvedSurface, ARopeFindsTheBodyAndLeavesIt) {
  std::map<std::string, double> tensions;
  for (const bool listed : {false, true}) {
    for (const Form& form : forms()) {
      SCOPED_TRACE(form.name);
      test::Machine m;
      m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
      const bool ring = form.shape->type() == "torus";
      BodyDef body = static_body("body", form.shape, form.place + Vector3(0.0, -0.3, 0.0));
      body.mobility = Mobility::kinematic;
      body.oscillation = {0.0, 0.25, 0.0};
      body.oscillation_frequency = 1.0;
      body.orientation = rotation_by(form.turn);
      body.wrappable = !listed;
      m.model.add(body);
      m.model.add(static_body("post", sphere_of(0.01), Vector3::Zero()));
      auto lifted = beside(
          0, rotation_by(form.turn).conjugate() * Vector3(0.0, (ring ? 0.6 : 0.0) + 1.0, 0.0));
      lifted->lifted = true;
      std::vector<std::shared_ptr<LinkDef>> links{test::attach(BodyId::world(), {-1.0, 0.0, -0.1}),
                                                  test::attach({1}, {1.0, 0.0, 0.2})};
      if (listed) links.insert(links.begin() + 1, lifted);
      CableDef rope;
      rope.name = "rope";
      for (const auto& link : links) rope.links.push_back(link);
      rope.compliance = 1e-4;
      m.cables.push_back(rope);
      ASSERT_EQ(refused(m), "");
      Simulation s = test::start(m);
      const double length = s.cable_reports()[0].total_length;
      test::run(s.world, 0.25);
      const CableReport lies = s.cable_reports()[0];
      const bool touched = listed ? lies.links[1].touched : lies.wraps.size() == 1;
      EXPECT_TRUE(touched);
      const double tension = lies.spans[0].tension;
      EXPECT_GT(tension, 1.0);
      // Both searches end at 1e-12 of the length, and 1e-4 m/N makes a newton of 1e-4 m.
      const double found = tensions.try_emplace(form.name, tension).first->second;
      EXPECT_NEAR(tension, found, 1e-7);
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
      test::run(s.world, 0.5);
      const auto& events = s.cables->events();
      ASSERT_EQ(events.size(), 2U);
      EXPECT_EQ(events[0].kind, CableEvent::Kind::touch);
      EXPECT_EQ(events[1].kind, CableEvent::Kind::leave);
      const CableReport report = s.cable_reports()[0];
      EXPECT_EQ(report.total_length, length);
      EXPECT_EQ(report.length_error, 0.0);
    }
  }
}

// A rope runs through a ring that moves about it. While the ring does not come to the rope, no wrap
// appears on either side of the hole; then the inner side of the tube takes the rope along.
TEST(CurvedSurface, ARopeThroughARingIsFree) {
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  BodyDef ring = static_body("ring", torus_of(0.3, 0.05), {0.0, 0.0, 0.0});
  ring.mobility = Mobility::kinematic;
  ring.orientation = rotation_by({0.0, 0.5 * pi, 0.0});
  ring.oscillation = {0.0, 0.2, 0.1};
  ring.oscillation_frequency = 1.0;
  ring.wrappable = true;
  m.model.add(ring);
  m.cables.push_back(test::cable("rope", {test::attach(BodyId::world(), {-1.0, 0.0, 0.0}),
                                          test::attach(BodyId::world(), {1.0, 0.0, 0.0})}));
  m.cables[0].compliance = 1e-4;
  Simulation s = test::start(m);
  test::run(s.world, 2.0);
  EXPECT_TRUE(s.cables->events().empty());
  m.model.bodies[0].oscillation = {0.0, 0.4, 0.2};
  Simulation other = test::start(m);
  test::run(other.world, 0.25);
  const CableReport report = other.cable_reports()[0];
  ASSERT_EQ(report.wraps.size(), 1U);
  // The rope is drawn towards +y, as far as the tube's inner side.
  EXPECT_GT(report.wraps[0].link.entry.y(), 0.05);
  EXPECT_TRUE(other.certificate()->clean()) << other.certificate()->worst()->sentence();
}

TEST(CurvedSurface, TellsOfARopeAlongAHollowPart) {
  // Round the outside of a ring a rope is not held. It slides to the inside, where the tube is hollow
  // along it; a rope across the tube is on no hollow part.
  for (const bool along : {true, false}) {
    test::Machine m;
    m.model.add(static_body("ring", torus_of(0.4, 0.1), Vector3::Zero()));
    if (!along) m.model.bodies[0].orientation = rotation_by({0.0, 0.5 * pi, 0.0});
    const double x = along ? 0.5 : 0.3;
    CableDef rope = test::cable(
        "rope", {test::attach(BodyId::world(), {-x, -2.0, 0.0}), beside(0, {0.0, 1.0, 0.0}),
                 test::attach(BodyId::world(), {x, -2.0, 0.0})});
    rope.axial_stiffness = 1e4;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    ASSERT_TRUE(s.step().ok());
    const auto warnings = s.cables->misplaced_warnings();
    ASSERT_EQ(warnings.size(), along ? 1U : 0U);
    if (!along) continue;
    EXPECT_TRUE(warnings[0].hollow);
    EXPECT_EQ(warnings[0].body, 0);
    // Both tangents to the inner circle cross below it.
    const double turned =
        3.0 * pi - 2.0 * (std::atan2(2.0, 0.5) + std::acos(0.3 / std::hypot(0.5, 2.0)));
    EXPECT_NEAR(warnings[0].beyond, 0.3 * turned, 1e-9);
  }
}

TEST(CurvedSurface, AStateGoesOnAsItWas) {
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    const test::Machine m = weight_on(form);
    Simulation s = test::start(m);
    test::run(s.world, 0.2);
    const State kept = s.world.state();
    test::run(s.world, 0.2);
    Simulation other = test::start(m);
    ASSERT_TRUE(other.world.restore(kept).empty());
    test::run(other.world, 0.2);
    EXPECT_EQ(hash(other.world.state()), hash(s.world.state()));
  }
}

TEST(CurvedSurface, RefusesImpossibleSettings) {
  const auto expect = [](const test::Machine& m, const std::string& words) {
    SCOPED_TRACE(words);
    EXPECT_NE(refused(m).find(words), std::string::npos) << refused(m);
  };
  const Form egg = forms()[0];
  const auto with = [&](auto change) {
    test::Machine m = weight_on(egg);
    auto link =
        std::make_shared<SurfaceLink>(static_cast<const SurfaceLink&>(*m.cables[0].links[1]));
    change(*link);
    m.cables[0].links[1] = link;
    return m;
  };
  expect(with([](SurfaceLink& l) { l.winding = test::right; }),
         "exactly one of \"winding\", \"side\" and \"side_point\"");
  expect(with([](SurfaceLink& l) { l.side_point.reset(); }),
         "exactly one of \"winding\", \"side\" and \"side_point\"");
  expect(with([](SurfaceLink& l) { l.normal = Vector3::UnitX(); }), "belongs to \"winding\"");
  expect(with([](SurfaceLink& l) { l.side_point = Vector3(0.1, 0.05, 0.1); }),
         "the point lies inside the shape");
  // The end of the rope lies in the body.
  test::Machine m = weight_on(egg);
  m.model.bodies[1].position = {0.1, 0.05, 0.0};
  expect(m, "lies inside the body of");
  // Two bodies of the row share the place where the rope comes onto the second.
  m = weight_on(egg);
  m.model.add(static_body("ball", sphere_of(0.1), Vector3::Zero()));
  m.cables[0].links.insert(m.cables[0].links.begin() + 2, beside(2, {0.0, 1.0, 0.0}));
  expect(m, "inside the body of");
  // Degenerate sizes.
  m = weight_on({"", ellipsoid_of({1.0, 1.0, 0.001}), Vector3::Zero(), Vector3::Zero()});
  expect(m, "at most 100 times the shortest");
  m = weight_on({"", torus_of(0.1, 0.1), Vector3::Zero(), Vector3::Zero()});
  expect(m, "must leave a hole");
  m = weight_on({"", cone_of(0.2, 0.2, 1.0), Vector3::Zero(), Vector3::Zero()});
  expect(m, "use a \"cylinder\"");
  m = weight_on(egg);
  m.model.colliders.push_back({});
  m.model.colliders.back().body = BodyId{0};
  expect(m, "meets cables and the ground, but no other body");
}

}  // namespace
}  // namespace sheave
