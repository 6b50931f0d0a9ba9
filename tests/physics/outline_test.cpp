// Cables on outlines: cams, polygons as wheels, bodies that tumble on their cable.

#include "cable/outline.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/constraint_batch.h"
#include "engine/shapes/prism.h"
#include "tests/support/builders.h"
#include "tests/support/gradient_check.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

/// A body whose shape is a regular prism with corners on a circle of this radius about `center`.
BodyDef polygon(std::string name, int corners, double radius, const Vector3& center,
                double inertia) {
  BodyDef body = test::wheel(std::move(name), Vector3::Zero(), radius, inertia);
  auto prism = std::make_shared<Prism>();
  prism->length = 0.1;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    prism->outline.emplace_back(center.x() + radius * std::cos(angle),
                                center.y() + radius * std::sin(angle), 0.0);
  }
  body.shapes = {{prism}};
  if (center.norm() > 0.0) {
    // Counterweights beside the cable's plane bring the centre of mass back to the axle.
    auto half = std::make_shared<Prism>(*prism);
    half->length = 0.05;
    const Quaternion turned = rotation_by({0.0, 0.0, pi});
    body.shapes.push_back({half, {0.0, 0.0, 0.3}, turned});
    body.shapes.push_back({half, {0.0, 0.0, -0.3}, turned});
  }
  return body;
}

/// A cable from a point far above to a spool on a cam that turns about the origin.
struct Cam {
  static constexpr double radius = 0.2;
  static constexpr double eccentricity = 0.1;
  static constexpr double height = 3.0;
  test::Machine machine;

  explicit Cam(int corners) {
    BodyDef body = corners > 0 ? polygon("cam", corners, radius, {eccentricity, 0.0, 0.0}, 0.05)
                               : test::wheel("cam", Vector3::Zero(), radius, 0.05);
    auto spool = roll(machine.model.add(body), left);
    spool->stored_length = 20.0;
    if (corners == 0) spool->center = Vector3(eccentricity, 0.0, 0.0);
    machine.cables.push_back(cable("rope", {attach(BodyId::world(), {0.0, height, 0.0}), spool}));
  }

  /// Torque per tension about the axle when the cam has turned by `angle`.
  [[nodiscard]] double torque(double angle) const {
    test::Machine turned = machine;
    turned.model.bodies[0].orientation = rotation_by({0.0, 0.0, angle});
    const Simulation s = test::start(turned);
    Substep substep(s.world.bodies(), s.world.state(), 0.01, 1);
    ConstraintBatch& batch = *s.world.features().back();
    batch.begin(substep, s.world.state().features.back());
    RowList rows;
    batch.linearise(substep, rows);
    return rows[0].terms[0].angular.z();
  }

  /// The lever arm of the tangent from (0, height) to the disc about (e cos, e sin), by elementary
  /// geometry: the line makes the angle asin(r / d) with the line to the centre.
  [[nodiscard]] static double lever(double angle) {
    const double x = eccentricity * std::cos(angle);
    const double y = eccentricity * std::sin(angle) - height;
    const double d = std::hypot(x, y);
    // Down from the point, the disc on the left of a cable that winds on counter-clockwise.
    const double direction = std::atan2(y, x) - std::asin(radius / d);
    const Vector3 u(std::cos(direction), std::sin(direction), 0.0);
    return Vector3(0.0, height, 0.0).cross(u).z();
  }
};

TEST(Cam, TorqueOfAnEccentricDiscIsTensionTimesLeverArm) {
  const Cam cam(0);
  for (int i = 0; i < 72; ++i) {
    const double angle = 2.0 * pi * i / 72.0;
    // The cable pulls the rim along -u; rounding of lengths of 3 m.
    EXPECT_NEAR(cam.torque(angle), -Cam::lever(angle), 1e-13) << angle;
  }
}

TEST(Cam, TorqueOfA256GonIsThatOfTheDiscWithinATenthOfAPercent) {
  const Cam cam(256);
  for (int i = 0; i < 72; ++i) {
    const double angle = 2.0 * pi * i / 72.0;
    const double lever = Cam::lever(angle);
    // The line passes through a corner, within r (1 - cos(pi / 256)) = 1.5e-5 m of the disc's
    // tangent; the smallest arm is r - e = 0.1 m.
    EXPECT_NEAR(cam.torque(angle), -lever, 1.6e-5) << angle;
    EXPECT_LT(1.6e-5 / std::abs(lever), 1e-3);
  }
}

TEST(CableOnOutline, GradientsAreExactInOnePlane) {
  test::Machine m;
  const BodyId a = m.model.add(polygon("a", 7, 0.3, {0.05, 0.02, 0.0}, 0.05));
  BodyDef block = polygon("b", 5, 0.25, Vector3::Zero(), 0.05);
  block.mobility = Mobility::planar;
  block.position = {1.5, 0.3, 0.0};
  const BodyId b = m.model.add(block);
  // An outline that looks the other way: its own normal is -z, so its windings are mirrored.
  BodyDef flipped = polygon("c", 6, 0.2, Vector3::Zero(), 0.05);
  flipped.position = {3.0, -0.2, 0.0};
  flipped.orientation = rotation_by({pi, 0.0, 0.0});
  const BodyId c = m.model.add(flipped);
  const BodyId w = m.model.add(test::wheel("w", {4.2, 0.3, 0.0}, 0.2, 0.05));
  // The block is laid round once: a rope in one plane does not come to it from that side.
  const auto round_block = roll(b, left);
  round_block->turns = 1;
  const auto round_flipped = roll(c, left);
  round_flipped->turns = 1;
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-1.0, -0.5, 0.0}), roll(a, right), round_block,
                     round_flipped, roll(w, left), attach(BodyId::world(), {4.0, -2.0, 0.0})}));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Simulation s = test::start(m);
    Substep substep(s.world.bodies(), s.world.state(), 0.01, 1);
    ConstraintBatch& batch = *s.world.features().back();
    batch.begin(substep, s.world.state().features.back());
    test::displace(substep, 0.1, 2.0, seed);
    const test::GradientCheck check = test::check_gradients(substep, batch);
    EXPECT_GT(check.compared, 8);
    EXPECT_LT(check.error, 1e-9) << check.worst << " seed " << seed;
  }
}

TEST(CableOnOutline, GradientsAreExactInSpaceBetweenPointAndPolygon) {
  test::Machine m;
  BodyDef block = polygon("block", 6, 0.3, Vector3::Zero(), 0.05);
  block.mobility = Mobility::free;
  block.orientation = rotation_by({0.3, -0.2, 0.1});
  const BodyId b = m.model.add(block);
  m.cables.push_back(cable("rope", {attach(BodyId::world(), {-1.0, -0.8, 0.3}), roll(b, right),
                                    attach(BodyId::world(), {1.3, -0.9, -0.2})}));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Simulation s = test::start(m);
    Substep substep(s.world.bodies(), s.world.state(), 0.01, 1);
    ConstraintBatch& batch = *s.world.features().back();
    batch.begin(substep, s.world.state().features.back());
    test::displace(substep, 0.02, 0.05, seed);
    const test::GradientCheck check = test::check_gradients(substep, batch);
    EXPECT_LT(check.error, 1e-9) << check.worst << " seed " << seed;
  }
}

/// Acceleration of weights of 1 kg and 2 kg over a regular polygon inscribed in a circle (0
/// corners: the circle), as an average over 1.5 s in which the wheel turns some 5 times.
double polygon_acceleration(int corners) {
  constexpr double radius = 0.25;
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.002, 1, 20);
  const BodyDef circle = test::wheel("wheel", Vector3::Zero(), radius, 0.05);
  const BodyId wheel =
      m.model.add(corners > 0 ? polygon("wheel", corners, radius, Vector3::Zero(), 0.05) : circle);
  const BodyId a = m.model.add(test::weight("a", {-radius, -30.0, 0.0}, 1.0));
  const BodyId b = m.model.add(test::weight("b", {radius, -30.0, 0.0}, 2.0));
  m.cables.push_back(cable("rope", {attach(a), roll(wheel, right), attach(b)}));
  Simulation s = test::start(m);
  test::run(s.world, 1.5);
  EXPECT_LT(std::abs(s.cable_reports()[0].length_error), 1e-15);
  return -2.0 * (s.world.position(b).y() + 30.0) / (1.5 * 1.5);
}

TEST(CableOnOutline, PolygonsConvergeToTheCircleInSecondOrder) {
  // A polygon with n corners acts on average like a wheel with its perimeter, 2 n r sin(pi / n),
  // which falls short of the circle's by pi^2 / 6 n^2. With J / r^2 = 0.8 kg beside 3 kg, a = g /
  // (3 + J / r^2) falls by 2 * 0.8 / 3.8 of that share.
  const double circle = polygon_acceleration(0);
  std::vector<double> errors;
  for (const int corners : {8, 16, 32, 64}) {
    const double error = (circle - polygon_acceleration(corners)) / circle;
    const double expected = 2.0 * 0.8 / 3.8 * pi * pi / 6.0 / (corners * corners);
    // The average ends somewhere between two corners, where the lever arm is off its mean by up to
    // the same share.
    EXPECT_NEAR(error, expected, 0.25 * expected) << corners;
    errors.push_back(error);
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2.0, 0.35);
  }
}

TEST(CableOnOutline, ManyTurnsOfAPolygonMoveTheirPerimeters) {
  // A square drum is driven; the load rises by one perimeter per turn, however fast it turns: here
  // 1.7 turns per step.
  for (const double turns_per_step : {0.05, 0.4, 1.7}) {
    test::Machine m;
    m.model.step = test::settings(0.01, 1, 10);
    BodyDef drum = polygon("drum", 4, 0.1, Vector3::Zero(), 0.01);
    drum.mobility = Mobility::kinematic;
    drum.axis.reset();
    drum.mass.reset();
    drum.inertia.reset();
    drum.angular_velocity = {0.0, 0.0, 2.0 * pi * turns_per_step / 0.01};
    auto spool = roll(m.model.add(drum), left);
    spool->stored_length = 100.0;
    const BodyId load = m.model.add(test::weight("load", {-0.1, -100.0, 0.0}, 1.0));
    m.cables.push_back(cable("rope", {attach(load), spool}));
    Simulation s = test::start(m);
    const double before = s.cable_reports()[0].links[1].stored_length;
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    const double perimeter = 4.0 * 0.1 * std::sqrt(2.0);
    // 20 steps are a whole number of quarter turns; the direction of the span hardly changes over
    // 100 m.
    EXPECT_NEAR(std::abs(report.links[1].stored_length - before), 20.0 * turns_per_step * perimeter,
                0.01 * perimeter)
        << turns_per_step;
  }
}

// What comes onto a corner and goes again is edges, whose sum may be -1e-17 m at the last corner.
// The cable is still bent round that.
TEST(CableOnOutline, ACableStaysOnItsLastCornerAsLongAsItIsBent) {
  int bent = 0;
  for (int i = 0; i < 40; ++i) {
    const double size = 1.0 + 0.0137 * i;
    test::Machine m;
    m.model.gravity = Vector3::Zero();
    m.model.step = test::settings(0.02, 1, 20);
    const auto end = [&](double x) {
      BodyDef body = test::lump(x < 0.0 ? "a" : "b", {size * x, -0.6 * size, 0.0}, 1.0);
      body.mobility = Mobility::planar;
      body.axis = Vector3::UnitZ();
      body.velocity = {0.0, 0.6 * size, 0.0};
      return m.model.add(body);
    };
    BodyDef post = polygon("post", 8, 0.2 * size, Vector3::Zero(), 1.0);
    post.mobility = Mobility::planar;
    const BodyId a = end(-1.0);
    const BodyId b = end(1.0);
    m.cables.push_back(cable("rope", {attach(a), roll(m.model.add(post), right), attach(b)}));
    m.cables[0].compliance = 1e-3;
    Simulation s = test::start(m);
    // From three corners or more to the uppermost, over which the spans end 0.2 to either side.
    const CableReport before = s.cable_reports()[0];
    EXPECT_GT(before.links[1].stored_length, 0.2 * size);
    test::run(s.world, 1.0);
    const CableReport after = s.cable_reports()[0];
    ASSERT_EQ(after.spans.size(), 2U) << size;
    EXPECT_TRUE(after.links[1].touched) << size;
    EXPECT_TRUE(s.cables->events().empty()) << size;
    // A few edges, each rounded to the grain of lengths, 2^-48 m here.
    EXPECT_NEAR(after.links[1].stored_length, 0.0, 4.0 * std::ldexp(1.0, -48));
    bent += after.links[1].touched ? 1 : 0;
  }
  EXPECT_EQ(bent, 40);
}

/// A rope over the uppermost corner of an octagon. Its end beside the plane goes down, so that the
/// next corner comes to lie under the rope, too; then its end in the plane goes up, until it is
/// bent round that corner alone, by 0.3 rad.
Simulation rope_on_its_last_corner(double size, bool counted_from_the_end_beside) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::settings(0.02, 1, 20);
  m.model.step.solver = SolverKind::direct;
  const auto end = [&](std::string name, const Vector3& position, double velocity) {
    BodyDef body = test::lump(std::move(name), size * position, 1.0);
    body.mobility = Mobility::kinematic;
    body.velocity = {0.0, size * velocity, 0.0};
    return m.model.add(body);
  };
  BodyDef post = polygon("post", 8, 0.2 * size, Vector3::Zero(), 1.0);
  post.mobility = Mobility::kinematic;
  post.axis = Vector3::UnitZ();
  const auto in_plane = attach(end("in plane", {-1.0, 0.1, 0.0}, 0.8));
  const auto beside = attach(end("beside", {1.0, 0.1, 0.5}, -1.1));
  const BodyId body = m.model.add(post);
  m.cables.push_back(counted_from_the_end_beside
                         ? cable("rope", {beside, roll(body, left), in_plane})
                         : cable("rope", {in_plane, roll(body, right), beside}));
  m.cables[0].compliance = 1e-3;
  return test::start(m);
}

// Beside the plane a corner stores less than the edges that come to it are long (tilt_loss), so
// what the last corner stores falls short of 0 by millimetres, whichever end of the cable is beside
// the plane. Where only the span before the link was asked, ropes whose other end was beside it
// went through the corner (one bent by 40 degrees lost 12 kN without a word).
TEST(CableOnOutline, ACableStaysOnItsLastCornerWithEitherEndBesideThePlane) {
  for (int i = 0; i < 40; ++i) {
    const double size = 1.0 + 0.0137 * i;
    const double corner = 0.2 * std::sqrt(0.5);  // the second one, at 45 degrees
    for (const bool from_beside : {false, true}) {
      Simulation s = rope_on_its_last_corner(size, from_beside);
      test::run(s.world, 1.0);
      EXPECT_TRUE(s.cables->events().empty()) << size;
      CableReport rope = s.cable_reports()[0];
      ASSERT_TRUE(rope.links[1].touched) << size << from_beside;
      EXPECT_LT(rope.links[1].stored_length, -1e-3 * size);
      if (from_beside) std::reverse(rope.spans.begin(), rope.spans.end());
      EXPECT_NEAR(rope.spans[0].length, size * std::hypot(1.0 + corner, 0.9 - corner), 1e-12);
      EXPECT_NEAR(rope.spans[1].length, size * std::hypot(1.0 - corner, 1.0 + corner, 0.5), 1e-12);
    }
  }
}

}  // namespace
}  // namespace sheave
