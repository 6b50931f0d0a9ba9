// Listed links on smooth bodies: the rope lies along a geodesic and slides over the body.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/edit.h"
#include "cable/links/surface.h"
#include "cable/live_world.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::cylinder_of;
using test::sphere_of;
using test::static_body;

std::shared_ptr<SurfaceLink> lie_on(BodyId body, Winding winding, double friction = 0.0) {
  auto link = std::make_shared<SurfaceLink>();
  link->body = body;
  link->winding = winding;
  link->friction = friction;
  return link;
}

/// The text of the errors of a machine.
std::string refusal(const test::Machine& m) {
  const auto made = Simulation::create(m.model, m.cables);
  return made ? std::string() : test::text(made.errors());
}

const Vector3 wall_point(-0.5, 0.0, -0.2);

/// A weight of 1 kg at `place` on a rope of 1e-4 m/N per span from the wall over a bar of 0.1 m
/// along z through the origin; both turned by `turn`.
test::Machine weight_on_bar(const Vector3& place, double friction = 0.0, bool back = false,
                            const Quaternion& turn = Quaternion::Identity()) {
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  m.model.gravity = turn * test::down;
  m.model.add(static_body("bar", cylinder_of(0.1, 3.0), Vector3::Zero()));
  m.model.bodies[0].orientation = turn;
  BodyDef bob;
  bob.name = "bob";
  bob.mass = 1.0;
  bob.inertia = Vector3(1e-2, 1e-2, 1e-2);
  bob.position = turn * place;
  m.model.add(bob);
  // From the wall the rope comes over the bar to its right side: clockwise about +z.
  if (back) {
    m.cables.push_back(test::cable("rope", {test::attach({1}), lie_on({0}, test::left, friction),
                                            test::attach(BodyId::world(), turn * wall_point)}));
  } else {
    m.cables.push_back(
        test::cable("rope", {test::attach(BodyId::world(), turn * wall_point),
                             lie_on({0}, test::right, friction), test::attach({1})}));
  }
  m.cables[0].compliance = 1e-4;
  return m;
}

/// Length from the wall over the bar by unrolling, for a point that hangs beside the bar.
double unrolled_length(const Vector3& place) {
  const double r = 0.1;
  const double da = std::hypot(wall_point.x(), wall_point.y());
  const double db = std::hypot(place.x(), place.y());
  // Angles from the positive x axis, clockwise from the wall over the top.
  const double between =
      std::atan2(wall_point.y(), wall_point.x()) - std::atan2(place.y(), place.x());
  const double level = std::sqrt(da * da - r * r) + std::sqrt(db * db - r * r) +
                       r * (between - std::acos(r / da) - std::acos(r / db));
  return std::hypot(level, place.z() - wall_point.z());
}

// Both spans beside the link find that the rope cannot lie on its own end; the fault is told once.
TEST(SurfaceLink, AFaultOfALinkIsReportedOnce) {
  test::Machine m = weight_on_bar({0.3, -0.5, 0.0});
  auto on_its_end = std::make_shared<SurfaceLink>();
  on_its_end->body = m.cables[0].links.back()->body;
  on_its_end->winding = test::right;
  BodyDef& end = m.model.bodies[static_cast<std::size_t>(on_its_end->body.index)];
  end.shapes = {{sphere_of(0.05)}};
  m.cables[0].links[1] = on_its_end;
  const Errors errors = Simulation::check(m.model, m.cables);
  ASSERT_EQ(errors.size(), 1U) << test::text(errors);
  EXPECT_EQ(errors[0].path, "/cables/0/links/2");
}

TEST(SurfaceLink, AtTimeZeroARopeOverABarIsTheUnrolledLine) {
  for (const Vector3& place : {Vector3(0.3, -0.4, 0.3), Vector3(0.1, -1.0, -0.2)}) {
    for (const bool back : {false, true}) {
      const Simulation s = test::start(weight_on_bar(place, 0.0, back));
      const CableReport report = s.cable_reports()[0];
      EXPECT_NEAR(report.total_length, unrolled_length(place), 1e-14);
      ASSERT_TRUE(report.links[1].surface.has_value());
      EXPECT_TRUE(report.links[1].touched);
      EXPECT_GT(report.links[1].stored_length, 0.0);
    }
  }
}

// From half a turn to 260 degrees, in two directions and turned in space. In the unrolled plane the rope
// is a straight line; its length seen along the bar is that of two tangents and an arc.
TEST(SurfaceLink, TheRopeMayWrapMoreThanHalfATurn) {
  constexpr double r = 0.1;
  constexpr double reach = 1.0;  // of both tangents
  constexpr double rise = 0.4;   // along the bar
  for (const double wrap : {180.0, 180.1, 225.0, 260.0}) {
    for (const bool clockwise : {true, false}) {
      for (const double turned : {0.0, 0.3, 1.1}) {
        SCOPED_TRACE(testing::Message() << wrap << " degrees, " << clockwise << ", " << turned);
        const double arc = wrap * std::acos(-1.0) / 180.0;
        const double way = clockwise ? -1.0 : 1.0;
        const Quaternion turn(Eigen::AngleAxisd(turned, Vector3(1.0, 2.0, 0.5).normalized()));
        // The point at the end of a tangent of the length `along` from the rim at `angle`.
        const auto place = [&](double angle, double along, double z) -> Vector3 {
          return turn * Vector3(r * std::cos(angle) - along * way * std::sin(angle),
                                r * std::sin(angle) + along * way * std::cos(angle), z);
        };
        test::Machine m;
        m.model.gravity = test::down;
        m.model.add(static_body("bar", cylinder_of(r, 3.0), Vector3::Zero()));
        m.model.bodies[0].orientation = turn;
        m.cables.push_back(test::cable(
            "rope", {test::attach(BodyId::world(), place(0.2, -reach, 0.0)),
                     lie_on({0}, clockwise ? test::right : test::left),
                     test::attach(BodyId::world(), place(0.2 + way * arc, reach, rise))}));
        m.cables[0].compliance = 1e-4;
        ASSERT_EQ(refusal(m), "");
        const CableReport report = test::start(m).cable_reports()[0];
        EXPECT_NEAR(report.total_length, std::hypot(2.0 * reach + r * arc, rise), 1e-13);
      }
    }
  }
}

// Nothing holds the rope along the bar, so the weight swings along it, too, and comes to rest across
// from the wall_point, where both spans have its weight. With a friction of 0.3 the tensions differ by at
// most e^(0.3 x angle).
TEST(SurfaceLink, AWeightSlidesAlongABarUntilTheRopeIsSquareToIt) {
  for (const bool back : {false, true}) {
    test::Machine m = weight_on_bar({0.1, -0.8, 0.3}, 0.0, back);
    m.model.bodies[1].damping = 4.0;
    Simulation s = test::start(m);
    test::run(s.world, 20.0);
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(s.world.position({1}).x(), 0.1, 1e-7);
    EXPECT_NEAR(s.world.position({1}).z(), wall_point.z(), 1e-7);
    EXPECT_NEAR(report.spans[0].tension, test::g, 1e-6);
    EXPECT_NEAR(report.spans[1].tension, test::g, 1e-6);
    EXPECT_EQ(report.length_error, 0.0);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  }
}

// A free swing obliquely over the bar: energy within the second order of the step, and the same
// machine when it is turned in space.
TEST(SurfaceLink, ASwingObliquelyOverABarKeepsItsEnergy) {
  const Quaternion turn = rotation_by({0.4, -1.3, 0.7});
  std::vector<double> drifts;
  for (const int substeps : {4, 8, 16, 32}) {
    test::Machine m = weight_on_bar({0.5, -0.3, 0.3});
    m.model.step.substeps = substeps;
    Simulation s = test::start(m);
    const double energy = s.world.energy().total();
    double drift = 0.0;
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      drift = std::max(drift, std::abs(s.world.energy().total() - energy));
    }
    drifts.push_back(drift);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    test::Machine turned = weight_on_bar({0.5, -0.3, 0.3}, 0.0, false, turn);
    turned.model.step.substeps = substeps;
    Simulation other = test::start(turned);
    test::run(other.world, 0.5);
    Simulation plain = test::start(m);
    test::run(plain.world, 0.5);
    EXPECT_LT((turn * plain.world.position({1}) - other.world.position({1})).norm(), 1e-9);
  }
  EXPECT_GT(drifts[0] / drifts[3], 30.0) << "second order: 64";
  EXPECT_LT(drifts[3], 1e-3 * test::g);
}

// The bob flies over the bar and comes back: the rope leaves the bar and touches it again, at the
// same link. No length is lost.
TEST(SurfaceLink, ARopeLeavesItsBodyAndComesBack) {
  for (const auto& shape : {cylinder_of(0.25, 3.0), sphere_of(0.25)}) {
    test::Machine m;
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
    BodyDef body = static_body("body", shape, {0.05, -0.2, 0.45});
    body.mobility = Mobility::kinematic;
    body.oscillation = {0.0, -0.25, 0.1};
    body.oscillation_frequency = 1.0;
    body.orientation = rotation_by({0.2, 0.3, 0.0});
    m.model.add(body);
    m.cables.push_back(test::cable(
        "rope", {test::attach(BodyId::world(), {-1.0, 0.0, 0.0}), lie_on({0}, test::right),
                 test::attach(BodyId::world(), {1.0, 0.0, 0.8})}));
    m.cables[0].compliance = 1e-4;
    Simulation s = test::start(m);
    const double length = s.cable_reports()[0].total_length;
    test::run(s.world, 1.9);
    const auto& events = s.cables->events();
    ASSERT_EQ(events.size(), 4U);
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(events[i].kind, i % 2 == 0 ? CableEvent::Kind::leave : CableEvent::Kind::touch);
      EXPECT_EQ(events[i].link, 1);
    }
    const CableReport report = s.cable_reports()[0];
    EXPECT_TRUE(report.links[1].touched);
    EXPECT_TRUE(report.wraps.empty());
    EXPECT_EQ(report.total_length, length);
    EXPECT_EQ(report.length_error, 0.0);
  }
}

// A ball, a bar and a wheel in one rope, from either end: one tension all along, that of the whole
// length; and a state that was kept goes on as it was, in another world, too.
TEST(SurfaceLink, SeveralInARowAreOneRope) {
  std::vector<double> tensions;
  for (const bool back : {false, true}) {
    test::Machine m;
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
    m.model.gravity = test::down;
    m.model.add(static_body("ball", sphere_of(0.2), {-0.6, -0.05, 0.1}));
    m.model.add(static_body("bar", cylinder_of(0.1, 3.0), {0.1, 0.1, 0.0}));
    m.model.bodies[1].orientation = rotation_by({0.1, 0.2, 0.0});
    BodyDef bob;
    bob.name = "bob";
    bob.mass = 1.0;
    bob.inertia = Vector3(1e-2, 1e-2, 1e-2);
    bob.position = {0.3, -0.7, 0.2};
    m.model.add(bob);
    const Vector3 end(-1.2, -0.3, -0.1);
    m.cables.push_back(
        back ? test::cable("rope", {test::attach({2}), lie_on({1}, test::left),
                                    lie_on({0}, test::left), test::attach(BodyId::world(), end)})
             : test::cable("rope", {test::attach(BodyId::world(), end), lie_on({0}, test::right),
                                    lie_on({1}, test::right), test::attach({2})}));
    m.cables[0].axial_stiffness = 2e4;
    Simulation s = test::start(m);
    test::run(s.world, 0.4);
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.spans[1].tension, report.spans[0].tension, 1e-6);
    EXPECT_NEAR(report.spans[2].tension, report.spans[0].tension, 1e-6);
    EXPECT_LT(std::abs(report.length_error), 1e-15);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    tensions.push_back(report.spans[0].tension);
    const State kept = s.world.state();
    test::run(s.world, 0.6);
    const std::uint64_t hash_then = hash(s.world.state());
    Simulation other = test::start(m);
    ASSERT_TRUE(other.world.restore(kept).empty());
    test::run(other.world, 0.6);
    EXPECT_EQ(hash(other.world.state()), hash_then);
  }
  EXPECT_NEAR(tensions[0], tensions[1], 1e-6 * tensions[0]);
}

// The bob pulls the rope over a rough helix: the capstan's law with the angle of the helix.
TEST(SurfaceLink, FrictionIsTheCapstansOnAHelix) {
  test::Machine m = weight_on_bar({0.3, -0.6, 0.6}, 0.25);
  m.model.step.integrator = IntegratorKind::xpbd;
  m.model.step.substeps = 16;
  m.model.bodies[1].mobility = Mobility::kinematic;
  m.model.bodies[1].velocity = {0.2, -0.3, 0.1};
  Simulation s = test::start(m);
  test::run(s.world, 0.5);
  const CableReport report = s.cable_reports()[0];
  const Vector3 in = report.spans[0].end - report.spans[0].start;
  const double slope = in.z() / in.norm();
  EXPECT_GT(slope, 0.2);
  EXPECT_NEAR(report.links[1].wrap_angle,
              report.links[1].stored_length * (1.0 - slope * slope) / 0.1, 1e-12);
  const double ratio = std::exp(0.25 * report.links[1].wrap_angle);
  EXPECT_NEAR(report.spans[1].tension / report.spans[0].tension, ratio, 1e-8 * ratio);
}

// A running rope that is led over a bar keeps its length; the weight comes to rest as above.
TEST(SurfaceLink, AnEditLeadsARopeOverABar) {
  test::Machine m = weight_on_bar({0.5, 0.05, 0.3});
  m.cables[0].links.erase(m.cables[0].links.begin() + 1);
  m.cables[0].compliance.reset();
  m.cables[0].axial_stiffness = 1e3;
  m.model.bodies[1].damping = 4.0;
  LiveWorld world = test::live(m);
  const CableHandle rope = world.cables()[0];
  const double length = *world.length(rope);
  const BodyId bar{0};
  test::edit(world, [&](Edit& e) { e.insert(rope, 0, lie_on(bar, test::right)); });
  EXPECT_EQ(*world.length(rope), length);
  EXPECT_GT(*world.stored_length(rope, 1), 0.0);
  test::advance(world, 1200);
  EXPECT_EQ(*world.length(rope), length);
  const CableReport lies = world.simulation().cable_reports()[0];
  EXPECT_NEAR(lies.spans[0].tension, test::g, 1e-6);
  EXPECT_NEAR(lies.spans[1].tension, test::g, 1e-6);
  test::edit(world, [&](Edit& e) { e.remove_link(rope, 1); });
  EXPECT_EQ(*world.length(rope), length);
}

// The bar is the second of two shapes; the first one lies elsewhere.
TEST(SurfaceLink, LiesOnTheShapeThatItNames) {
  const Vector3 place(0.3, -0.4, 0.3);
  test::Machine m = weight_on_bar(place);
  m.model.bodies[0].shapes.insert(m.model.bodies[0].shapes.begin(),
                                  {sphere_of(0.05), Vector3(0.0, 5.0, 0.0)});
  EXPECT_GT(test::start(m).cable_reports()[0].total_length, 5.0);
  auto named =
      std::make_shared<SurfaceLink>(static_cast<const SurfaceLink&>(*m.cables[0].links[1]));
  named->shape = 1;
  m.cables[0].links[1] = named;
  const Simulation s = test::start(m);
  EXPECT_NEAR(s.cable_reports()[0].total_length, unrolled_length(place), 1e-14);
  named->shape = 2;
  EXPECT_NE(refusal(m).find("has 2 shapes; the first one has the number 0"), std::string::npos)
      << refusal(m);
}

// A bob falls on a rope from a point on the bar's own body, until the rope comes to lie on the bar.
TEST(SurfaceLink, ThatStartsLiftedIsTouchedLater) {
  test::Machine m = weight_on_bar({0.5, 0.6, 0.0});
  auto lifted =
      std::make_shared<SurfaceLink>(static_cast<const SurfaceLink&>(*m.cables[0].links[1]));
  lifted->lifted = true;
  m.cables[0].links[0] = test::attach({0}, wall_point);
  m.cables[0].links[1] = lifted;
  m.cables[0].compliance.reset();
  Simulation s = test::start(m);
  const double length = (Vector3(0.5, 0.6, 0.0) - wall_point).norm();
  EXPECT_FALSE(s.cable_reports()[0].links[1].touched);
  bool touched = false;
  for (int i = 0; i < 40; ++i) {
    const StepReport step = s.step();
    ASSERT_TRUE(step.ok()) << i << " " << (step.divergence ? step.divergence->message : "");
    const CableReport report = s.cable_reports()[0];
    touched = touched || report.links[1].touched;
    EXPECT_NEAR(report.total_length, length, 1e-13);
    if (!report.links[1].touched) continue;
    // The rope is as long as the way over the bar.
    EXPECT_LT(unrolled_length(s.world.position(BodyId{1})), length * (1.0 + 1e-6));
  }
  EXPECT_TRUE(touched);
}

TEST(SurfaceLink, RefusesImpossibleSettings) {
  EXPECT_EQ(refusal(weight_on_bar({0.3, -0.4, 0.3})), "");
  test::Machine m = weight_on_bar({0.3, -0.4, 0.3});
  auto box = std::make_shared<Box>();
  box->size = {0.2, 0.2, 1.0};
  m.model.bodies[0].shapes[0].shape = box;
  EXPECT_NE(refusal(m).find("a surface link needs a sphere, a cylinder, a capsule, a cone"),
            std::string::npos);
  // The rope passes above the bar without touching it.
  m = weight_on_bar({0.5, 0.9, 0.3});
  EXPECT_NE(refusal(m).find("does not reach the body"), std::string::npos) << refusal(m);
  m = weight_on_bar({0.3, -0.4, 3.9});
  EXPECT_NE(refusal(m).find("beyond an end of the cylinder"), std::string::npos) << refusal(m);
  m = weight_on_bar({0.3, -0.4, 0.3});
  m.cables[0].links.pop_back();
  EXPECT_NE(refusal(m).find("between the ends of a cable"), std::string::npos) << refusal(m);
  m = weight_on_bar({0.3, -0.4, 0.3});
  auto link = lie_on({0}, test::right);
  link->normal = Vector3::UnitX();
  m.cables[0].links[1] = link;
  EXPECT_NE(refusal(m).find("perpendicular to the axis"), std::string::npos) << refusal(m);
}

}  // namespace
}  // namespace sheave
