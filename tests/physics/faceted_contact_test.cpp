// Prisms of many sides touch with the corner that is lowest, whichever it is from substep to substep.
// The support of a polygon with n corners on a circle of radius r is between r cos(pi / n) and r: what
// it does comes to what a round body does with the square of the angle of a side.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/contacts/manifold.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/shapes/half_space.h"
#include "tests/support/heaps.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::Heap;

/// Of a prism on a plane: the lowest corner is there, at both ends, now and when it has turned on.
TEST(FacetedContact, HasTheLowestCornersOfStartAndEnd) {
  HalfSpace below;
  below.normal = Vector3::UnitY();
  const ConvexSolid plane = below.solid();
  PlacedSolid floor;
  floor.place(plane, Vector3::Zero(), Quaternion::Identity());
  for (const int sides : {7, 40, 600}) {
    const auto prism = test::polygon(test::ring(sides, 0.04, 0.0), 0.02);
    const ConvexSolid solid = prism->solid();
    for (int i = 0; i < 50; ++i) {
      const double angle = 0.0137 * i;
      for (const double turn : {0.0, 0.003, -0.05}) {
        PlacedSolid placed;
        placed.place(solid, Vector3::Zero(), rotation_by({0.0, 0.0, angle}));
        double reach = 0.0;
        for (const Vector3& corner : placed.vertices) reach = std::max(reach, -corner.y());
        const Vector3 center(0.0, reach + 2e-4, 0.0);
        placed.place(solid, center, rotation_by({0.0, 0.0, angle}));
        SolidMotion motion;
        motion.center = center;
        motion.turn = rotation_by({0.0, 0.0, turn}).toRotationMatrix();
        Manifold manifold;
        find_contacts(placed, floor, 2e-3, manifold, motion);
        double lowest = 1.0;
        for (const Vector3& corner : placed.vertices) {
          lowest = std::min(lowest, motion.moved(corner).y());
        }
        const auto at_lowest = [&](double z) {
          return std::any_of(
              manifold.points.begin(), manifold.points.end(), [&](const ContactPoint& point) {
                return motion.moved(point.core_a).y() < lowest + 1e-8 && point.core_a.z() * z > 0.0;
              });
        };
        EXPECT_TRUE(at_lowest(1.0)) << sides << " " << angle << " " << turn;
        EXPECT_TRUE(at_lowest(-1.0)) << sides << " " << angle << " " << turn;
      }
    }
  }
}

/// The highest corner above the axle of an eccentric of the radius r about (e, 0) that has turned.
double support(const std::vector<Vector3>& outline, double angle) {
  double most = -1.0;
  for (const Vector3& corner : outline) {
    most = std::max(most, corner.x() * std::sin(angle) + corner.y() * std::cos(angle));
  }
  return most;
}

// An eccentric disc of n sides lifts a weight whose face is a box.
TEST(FacetedContact, ACamLiftsByItsSupport) {
  constexpr double radius = 0.04;
  constexpr double off = 0.012;
  for (const test::Method& method : test::methods) {
    for (const int sides : {24, 96, 480}) {
      SCOPED_TRACE(test::name_of(method) + ", sides " + std::to_string(sides));
      Heap heap(method.solver, method.integrator);
      std::vector<Vector3> outline = test::ring(sides, radius, 0.0);
      for (Vector3& corner : outline) corner.x() += off;
      BodyDef cam;
      cam.name = "cam";
      cam.mobility = Mobility::rotor;
      cam.axis = Vector3::UnitZ();
      cam.mass = 1.0;
      cam.drive = DriveKind::speed;
      cam.drive_values = {1.7};
      cam.shapes.push_back({test::polygon(outline, 0.02)});
      // A counterweight, as a rotor has its centre of mass on its axle.
      std::vector<Vector3> against = test::ring(sides, radius, 0.0);
      for (Vector3& corner : against) corner.x() -= off;
      cam.shapes.push_back({test::polygon(against, 0.02), {0.0, 0.0, 0.05}});
      const BodyId shaft = heap.add(cam);
      const double start = support(outline, 0.0);
      const BodyId tappet = heap.put(test::box({0.2, 0.02, 0.03}), {0.0, start + 0.01, 0.0}, 0.5);
      heap.last().mobility = Mobility::slider;
      heap.last().axis = Vector3::UnitY();
      World world = heap.start();
      double worst = 0.0;
      double round = 0.0;
      for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step().ok());
        const double angle = world.state().bodies[static_cast<std::size_t>(shaft.index)].angle;
        const double lift = world.position(tappet).y() - 0.01;
        worst = std::max(worst, std::abs(lift - support(outline, angle)));
        round = std::max(round, std::abs(lift - off * std::sin(angle) - radius));
      }
      // Rows are met to 1e-10 of the scene, of some 0.2 m, and an overlap that a corner has by
      // rounding is opened by a fiftieth per substep.
      EXPECT_LT(worst, 1e-8);
      EXPECT_LT(round, radius * (1.0 - std::cos(pi / sides)) + 1e-8);
    }
  }
}

// A cam on a stem that is pulled along a wall: its outline is a logarithmic spiral of the angle c, so
// that it locks and presses against the wall with F / tan c. A corner is off the point in which the
// spiral touches by half a side at most, s / 2, and F / N = tan c is off by s / (2 d), with d the
// distance of the wall.
TEST(FacetedContact, ASelfLockingCamPressesByItsAngle) {
  constexpr double c = 0.2342;  // 13.42 degrees, less than the friction holds
  constexpr double pulled = 1000.0;
  for (const int sides : {60, 240, 960}) {
    SCOPED_TRACE(sides);
    std::vector<Vector3> outline;
    double longest = 0.0;
    for (int i = 0; i <= sides; ++i) {
      const double angle = -1.4 + 2.8 * i / sides;
      const double r = 0.0377 * std::exp(-std::tan(c) * angle);
      outline.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
      if (i > 0) longest = std::max(longest, (outline[i] - outline[i - 1]).norm());
    }
    const auto reach = [&] {
      double most = 0.0;
      for (const Vector3& p : outline) most = std::max(most, p.x());
      return most;
    };
    const double distance = reach();
    Heap heap(SolverKind::direct, IntegratorKind::rattle);
    heap.model.gravity = Vector3::Zero();
    heap.surface.friction = 0.3;
    BodyDef wall;
    wall.name = "wall";
    wall.mobility = Mobility::fixed;
    wall.position = {distance, 0.0, 0.0};
    const auto half = test::make<HalfSpace>([](HalfSpace& s) { s.normal = -Vector3::UnitX(); });
    wall.shapes.push_back({half});
    heap.add(wall);
    BodyDef stem;
    stem.name = "stem";
    stem.mobility = Mobility::slider;
    stem.axis = Vector3::UnitY();
    stem.mass = 10.0;
    stem.damping = 2000.0;
    const BodyId stem_id = heap.model.add(stem);
    BodyDef cam;
    cam.name = "cam";
    cam.mobility = Mobility::planar;
    cam.mass = 0.1;
    cam.inertia = Vector3::Constant(1e-4);
    cam.shapes.push_back({test::polygon(outline, 0.02)});
    const BodyId cam_id = heap.add(cam);
    auto axle = std::make_shared<HingeJoint>();
    axle->name = "axle";
    axle->body_a = stem_id;
    axle->body_b = cam_id;
    axle->axis = Vector3::UnitZ();
    axle->angle.stiffness = 0.02;  // holds it to the wall
    axle->angle.rest = 0.5;
    heap.model.joints.push_back(axle);
    World world = heap.start();
    for (int i = 1; i <= 60; ++i) {
      const double force = pulled * std::min(i / 30.0, 1.0);
      ASSERT_TRUE(world.set_force(stem_id, {{0.0, -force, 0.0}}).empty());
      ASSERT_TRUE(world.step().ok());
    }
    double normal = 0.0;
    for (const ContactReport& contact : world.contacts()) normal += contact.normal_force;
    // With the torque of the spring, 0.01 N m.
    const double ratio = (pulled + 0.01 / distance) / normal;
    EXPECT_NEAR(ratio, std::tan(c), 0.5 * longest / distance + 1e-5);
    EXPECT_LT(std::abs(world.position(stem_id).y()), 2.0 * longest);
  }
}

/// A prism that rolls on its corners, of the radius `radius` and the inertia c m r^2.
struct Roll {
  int sides = 300;
  double slope = 0.1;  ///< downwards in the way of rolling [rad]
  double start = 0.0;  ///< spin at time 0, with a side on the floor [rad/s]

  static constexpr double radius = 0.1;
  static constexpr double inertia = 0.5;  ///< c

  /// The spin after a second, with the loss of `losses` times its landings. It turns about one corner
  /// after the other: (c + 1) r w' = g sin(slope + x), with x from -pi / n to pi / n. The next corner
  /// lands with w' = w (c + cos a) / (c + 1), a = 2 pi / n: its impulse does not turn about itself.
  [[nodiscard]] double spin(double losses) const {
    constexpr double h = 1e-5;
    const double half = pi / sides;
    const double kept = 1.0 - losses * (1.0 - std::cos(2.0 * half)) / (inertia + 1.0);
    double spin = start;
    double angle = -half;
    for (int i = 0; i < 100000; ++i) {
      const double middle = angle + 0.5 * h * spin;
      spin += h * test::g * std::sin(slope + middle) / ((inertia + 1.0) * radius);
      angle += h * spin;
      if (angle < half) continue;
      spin *= kept;
      angle -= 2.0 * half;
    }
    return spin;
  }
  /// The same of a round body.
  [[nodiscard]] double round_spin() const {
    return start + test::g * std::sin(slope) / ((inertia + 1.0) * radius);
  }
  /// The most by which a substep of `h` [s] may tell another spin. Velocities are those of a time
  /// within the substep. The impulse of the weight acts at the corner of the end, up to half a side
  /// from the axle. On a flat side the spin is larger than on a corner, by the height of the axle.
  [[nodiscard]] double blur(double h) const {
    const double half = pi / sides;
    return test::g / ((inertia + 1.0) * radius) *
           (h * (std::abs(std::sin(slope)) + half) + (1.0 - std::cos(half)) / spin(2.0));
  }
  /// spin(1) by the engine, rolling towards +x or -x, in a world that is turned about the vertical.
  [[nodiscard]] Vector3 rolled(const StepSettings& step, double way, double turn) const {
    Heap heap(step.solver, step.integrator);
    heap.model.step = step;
    heap.surface.friction = 0.8;
    heap.floor();
    const double half = pi / sides;
    const Quaternion about = rotation_by({0.0, turn, 0.0});
    const BodyId prism = heap.put(test::polygon(test::ring(sides, radius, 0.0), 0.1),
                                  {0.0, radius * std::cos(half), 0.0}, 2.0);
    BodyDef& body = heap.last();
    body.inertia = Vector3(1.0, 1.0, inertia * radius * radius) * 2.0;
    body.orientation = about * rotation_by({0.0, 0.0, half - 0.5 * pi});
    body.angular_velocity = about * Vector3(0.0, 0.0, -way * start);
    body.velocity = about * (start * radius * Vector3(way * std::cos(half), std::sin(half), 0.0));
    heap.incline(way * slope);
    heap.model.gravity = about * heap.model.gravity;
    World world = heap.start();
    test::run(world, 1.0);
    return way * (about.conjugate() * world.angular_velocity(prism));
  }
};

// Corners come to bear within substeps, up to six in one. A substep has each landing somewhere
// between its start and its end, where the next corner may be ahead of the axle or behind it by half a
// side. The loss of a landing goes with the square of this distance, so that it is between nothing and
// twice itself. Velocities are those of a time within the substep. (Pushed by corners from their
// places at the start of substeps, the prism would lose up to ten times as much.)
TEST(FacetedContact, APrismRollsAndLosesWhatItsLandingsTake) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 2, 4, 16, 64}) {
      StepSettings step = test::settings(1.0 / 60.0, substeps, 50);
      step.solver = SolverKind::direct;
      step.integrator = integrator;
      for (const Roll& roll : {Roll{100}, Roll{300}, Roll{300, 0.0, 6.0}, Roll{100, -0.05, 9.0}}) {
        SCOPED_TRACE(testing::Message()
                     << test::name_of({step.solver, integrator}) << ", substeps " << substeps
                     << ", sides " << roll.sides << ", start " << roll.start);
        const double blur = roll.blur(1.0 / (60.0 * substeps));
        const double way = substeps % 4 == 0 ? -1.0 : 1.0;
        const Vector3 spin = roll.rolled(step, way, substeps > 1 ? 0.7 : 0.0);
        EXPECT_LE(-spin.z(), roll.round_spin() + blur);
        EXPECT_GE(-spin.z(), roll.spin(2.0) - blur);
        EXPECT_LT(std::abs(spin.x()) + std::abs(spin.y()), 0.01 * roll.spin(1.0));
      }
    }
  }
}

}  // namespace
}  // namespace sheave
