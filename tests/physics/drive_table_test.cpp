// Tables that drives follow: what comes of the motion between their points.
//
// A platform of 2 kg is carried round a circle by two cables, which are wound by drums to the
// angles that this takes. With d from drum to platform and r the drum's radius, the free cable is l
// = sqrt(d^2 - r^2) long and leaves the drum at the angle psi = direction of d - o acos(r / d), o =
// 1 on the left drum and -1 on the right; so the drum has to turn by (psi - psi0) + o (l - l0) / r.
// The tensions follow from 2 kg (a - g) = T1 u1 + T2 u2, with u along the free cables.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;
using test::start;

constexpr double drum_radius = 0.2;
constexpr double circle_radius = 0.4;
constexpr double turn_rate = 2.0 * pi / 3.0;  // of the circle [rad/s]
constexpr std::array<double, 2> side{1.0, -1.0};
const std::array<Vector3, 2> drum_center{Vector3(-1.5, 1.0, 0.0), Vector3(1.5, 1.0, 0.0)};

Vector3 platform(double time) {
  const double angle = turn_rate * time;
  return {circle_radius * std::sin(angle), -circle_radius * std::cos(angle) - 1.0, 0.0};
}

struct Free {
  double length = 0.0;
  double angle = 0.0;  // of the drum's point that it leaves
  Vector3 direction = Vector3::Zero();
};

Free free_cable(std::size_t drum, const Vector3& to) {
  const Vector3 way = to - drum_center[drum];
  const double distance = way.norm();
  Free free;
  free.length = std::sqrt(distance * distance - drum_radius * drum_radius);
  free.angle = std::atan2(way.y(), way.x()) - side[drum] * std::acos(drum_radius / distance);
  const Vector3 rim(std::cos(free.angle), std::sin(free.angle), 0.0);
  free.direction = (way - drum_radius * rim) / free.length;
  return free;
}

double drum_angle(std::size_t drum, double time) {
  const Free now = free_cable(drum, platform(time));
  const Free first = free_cable(drum, platform(0.0));
  return now.angle - first.angle + side[drum] * (now.length - first.length) / drum_radius;
}

std::array<double, 2> tensions(double time) {
  const Vector3 a = turn_rate * turn_rate * (Vector3(0.0, -1.0, 0.0) - platform(time));
  const Vector3 force = 2.0 * (a + g * Vector3::UnitY());
  const Vector3 u = -free_cable(0, platform(time)).direction;
  const Vector3 v = -free_cable(1, platform(time)).direction;
  const double determinant = u.x() * v.y() - u.y() * v.x();
  return {(force.x() * v.y() - force.y() * v.x()) / determinant,
          (u.x() * force.y() - u.y() * force.x()) / determinant};
}

/// The largest relative error of both tensions in the middle second, with table points so far
/// apart.
double tension_error(double spacing, double h, Interpolation interpolation) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = h;
  machine.model.step.substeps = 1;
  BodyDef body;
  body.name = "platform";
  body.mobility = Mobility::planar;
  body.mass = 2.0;
  body.inertia = Vector3(0.1, 0.1, 0.1);
  body.position = platform(0.0);
  body.velocity = {circle_radius * turn_rate, 0.0, 0.0};
  const BodyId load{2};
  for (std::size_t i = 0; i < 2; ++i) {
    BodyDef drum = test::wheel("drum " + std::to_string(i), drum_center[i], drum_radius, 0.1);
    drum.drive = DriveKind::angle;
    drum.drive_interpolation = interpolation;
    for (int k = 0; k <= std::lround(3.0 / spacing); ++k) {
      drum.drive_times.push_back(k * spacing);
      drum.drive_values.push_back(drum_angle(i, k * spacing));
    }
    const double rate = (drum_angle(i, 1e-5) - drum_angle(i, -1e-5)) / 2e-5;
    drum.angular_velocity = {0.0, 0.0, rate};
    machine.model.bodies.push_back(drum);
    auto spool = std::make_shared<SpoolLink>();
    spool->body = BodyId{static_cast<int>(i)};
    spool->winding = i == 0 ? test::left : test::right;
    spool->stored_length = 3.0;
    machine.cables.push_back(
        test::cable("cable " + std::to_string(i), {spool, test::attach(load)}));
  }
  machine.model.bodies.push_back(body);
  Simulation simulation = start(machine);
  double largest = 0.0;
  while (simulation.world.state().time < 2.0) {
    EXPECT_TRUE(simulation.world.step().ok());
    const double time = simulation.world.state().time;
    if (time < 1.0) continue;
    // What is reported is the mean of the step, of its middle to second order.
    const std::array<double, 2> exact = tensions(time - 0.5 * h);
    const std::vector<CableReport> reports = simulation.cable_reports();
    for (std::size_t i = 0; i < 2; ++i) {
      largest = std::max(largest, std::abs(reports[i].spans[0].tension / exact[i] - 1.0));
    }
  }
  return largest;
}

TEST(DriveTable, TensionsOfAPlatformOnACircleConvergeWithTheSpacing) {
  // Second derivatives of a spline, and so accelerations, are right to the second order of its
  // spacing.
  const double coarse = tension_error(0.2, 1.0 / 480.0, Interpolation::cubic);
  const double fine = tension_error(0.1, 1.0 / 480.0, Interpolation::cubic);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
  // (turn rate x spacing)^2 / 12 of an acceleration of 1.75 m/s2 is 0.0064 m/s2, 7e-4 of gravity,
  // and the cables, which meet at an obtuse angle, have up to 3 times that.
  EXPECT_LT(fine, 2.2e-3);
  // The same points joined by lines: the load is thrown from corner to corner.
  EXPECT_GT(tension_error(0.1, 1.0 / 480.0, Interpolation::linear), 1.0);
}

}  // namespace
}  // namespace sheave
