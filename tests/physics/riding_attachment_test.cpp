// An attachment between two spans rides over a wrappable wheel: the cable behind it comes onto the
// wheel, and the cable before it leaves (cable/cable_doubts.cpp, cable/cable_contacts.cpp).
//
// The landing. The attachment is at the centre of a ball of radius d on the body, so it moves on the
// radius R = r + d while it rides on a wheel of radius r. It comes along the tangent of the wheel and
// lands where R cos a = r. There it has the speed v sin a across the wheel, and the contact takes
//
//   E = v^2 sin^2 a / 2 / (sin^2 a / M + cos^2 a / m),   sin^2 a = 1 - (r / R)^2,
//
// with the mass m of the body and the mass M of all that moves along the cable.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/surface.h"
#include "tests/support/builders.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

constexpr double wheel_radius = 0.5;
constexpr double ridden_inertia = 0.05;
constexpr double left_mass = 10.0;
constexpr double grip_mass = 2.0;
constexpr double right_mass = 11.0;

struct Ride {
  IntegratorKind integrator = IntegratorKind::rattle;
  SolverKind solver = SolverKind::direct;
  int substeps = 8;
  double ball = 0.01;                        ///< radius of the grip's ball [m]
  double speed = 1.2;                        ///< of the rope, upwards on the grip's side [m/s]
  double friction = 0.5;                     ///< of the rope on the wheel
  std::optional<double> stiffness;           ///< EA [N]
  bool mirrored = false;                     ///< the cable is counted from the other end
  Quaternion turn = Quaternion::Identity();  ///< of the whole machine
  Mobility mobility = Mobility::planar;      ///< of the grip and the weights
};

/// Bodies: 0 wheel, 1 left weight, 2 grip, 3 right weight. The grip is 0.3 m below the axle.
test::Machine riding(const Ride& ride) {
  test::Machine m;
  const auto turned = [&](const Vector3& v) -> Vector3 { return ride.turn * v; };
  m.model.gravity = turned(test::down);
  m.model.step = test::direct_settings(ride.integrator, 1.0 / 60.0, ride.substeps);
  m.model.step.solver = ride.solver;
  BodyDef wheel = test::wheel("wheel", Vector3::Zero(), wheel_radius, 1.0);
  wheel.spin_inertia = ridden_inertia;
  wheel.orientation = ride.turn;
  wheel.axis = turned(Vector3::UnitZ());
  wheel.angular_velocity = turned({0.0, 0.0, -ride.speed / wheel_radius});
  wheel.wrappable = true;
  m.model.add(wheel);
  const auto ball = [&](const char* name, double x, double y, double mass, double radius) {
    BodyDef body = test::lump(name, turned({x, y, 0.0}), mass);
    body.mobility = ride.mobility;
    body.orientation = ride.turn;
    body.velocity = turned({0.0, x < 0.0 ? ride.speed : -ride.speed, 0.0});
    body.shapes.assign(1, {test::sphere_of(radius)});
    return m.model.add(body);
  };
  const BodyId left = ball("left", -wheel_radius, -6.0, left_mass, 0.05);
  const BodyId grip = ball("grip", -wheel_radius, -0.3, grip_mass, ride.ball);
  const BodyId right = ball("right", wheel_radius, -1.5, right_mass, 0.05);
  m.model.colliders.resize(2);
  m.model.colliders[0].body = {0};
  m.model.colliders[1].body = grip;
  auto lies = std::make_shared<SurfaceLink>();
  lies->body = {0};
  lies->winding = ride.mirrored ? test::left : test::right;
  lies->friction = ride.friction;
  CableDef rope =
      test::cable("rope", {test::attach(left), test::attach(grip), lies, test::attach(right)});
  if (ride.mirrored) std::reverse(rope.links.begin(), rope.links.end());
  rope.wrap_friction = ride.friction;
  rope.axial_stiffness = ride.stiffness;
  if (ride.stiffness) {
    rope.pretensions = {test::g * left_mass, test::g * (left_mass + grip_mass),
                        test::g * right_mass};
    if (ride.mirrored) std::reverse(rope.pretensions.begin(), rope.pretensions.end());
  }
  m.cables.push_back(rope);
  return m;
}

/// Of the grip at its landing, above the axle [m].
double landing_height(double ball) {
  const double radius = wheel_radius + ball;
  return -std::sqrt(radius * radius - wheel_radius * wheel_radius);
}

/// Energy of the landing at the rope's speed `v`.
double landing_loss(double ball, double v) {
  const double share = wheel_radius / (wheel_radius + ball);
  const double sine2 = 1.0 - share * share;
  const double all =
      left_mass + grip_mass + right_mass + ridden_inertia / (wheel_radius * wheel_radius);
  return 0.5 * v * v * sine2 / (sine2 / all + (1.0 - sine2) / grip_mass);
}

/// Speed of the rope when the grip is at the height y < 0 below the axle, from the energy.
double speed_at(double speed, double y) {
  const double all =
      left_mass + grip_mass + right_mass + ridden_inertia / (wheel_radius * wheel_radius);
  const double pull = test::g * (right_mass - left_mass - grip_mass);
  return std::sqrt(speed * speed + 2.0 * pull * (y + 0.3) / all);
}

/// Energy that is lost by the landing, and then until the grip hangs on the other side [J].
struct Losses {
  double landing = 0.0;
  double ride = 0.0;
};

Losses losses_of(const Ride& ride) {
  Simulation s = test::start(riding(ride));
  const double start = s.world.energy().total();
  Losses losses;
  const Vector3 across = ride.turn * Vector3::UnitX();
  const Vector3 up = ride.turn * Vector3::UnitY();
  const auto place = [&] { return s.world.position({2}); };
  const auto steps_until = [&](const auto& holds) {
    for (int i = 0; i < 180 && !holds(); ++i) ASSERT_TRUE(s.world.step().ok());
    ASSERT_TRUE(holds()) << place().transpose();
  };
  steps_until([&] { return place().dot(up) > landing_height(ride.ball) + 0.005; });
  losses.landing = start - s.world.energy().total();
  steps_until([&] { return place().dot(across) > 0.0 && place().dot(up) < -0.2; });
  losses.ride = start - losses.landing - s.world.energy().total();
  EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
  EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  std::vector<CableEvent::Kind> kinds;
  for (const CableEvent& event : s.cables->events()) kinds.push_back(event.kind);
  EXPECT_EQ(kinds, (std::vector{CableEvent::Kind::touch, CableEvent::Kind::leave}));
  return losses;
}

constexpr double belt_length = 4.0 + pi;

/// A belt in a level plane over two wheels of 0.5 m, 2 m apart, with four grips; the first wheel is
/// driven. Bodies: 0 and 1 the wheels, 2 to 5 the grips.
test::Machine belt(double speed) {
  test::Machine m;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 8);
  for (const double x : {0.0, 2.0}) {
    BodyDef wheel = test::wheel(x > 0.0 ? "return" : "drive", {x, 0.0, 0.0}, wheel_radius, 5.0);
    wheel.wrappable = true;
    if (x == 0.0) {
      wheel.drive = DriveKind::speed;
      wheel.drive_times = {0.0, 1.0, 100.0};
      wheel.drive_values = {0.0, speed / wheel_radius, speed / wheel_radius};
    }
    m.model.add(wheel);
  }
  CableDef rope = test::cable("rope", {});
  const auto grip = [&](double x, double y) {
    BodyDef body = test::lump("grip " + std::to_string(m.model.bodies.size()), {x, y, 0.0}, 1.0);
    body.mobility = Mobility::planar;
    body.shapes.assign(1, {test::sphere_of(0.005)});
    rope.links.push_back(test::attach(m.model.add(body)));
  };
  const auto lies = [&](int body) {
    auto link = std::make_shared<SurfaceLink>();
    link->body = {body};
    link->winding = test::left;
    link->friction = 0.5;
    rope.links.push_back(link);
  };
  grip(0.5, -0.5), grip(1.5, -0.5), lies(1), grip(1.5, 0.5), grip(0.5, 0.5), lies(0);
  m.model.colliders.resize(6);
  for (int i = 0; i < 6; ++i) m.model.colliders[static_cast<std::size_t>(i)].body = {i};
  rope.closed = true;
  rope.axial_stiffness = 1e5;
  rope.pretension = 1e3;
  rope.wrap_friction = 0.5;
  m.cables.push_back(rope);
  return m;
}

/// Of the grips about the middle of the belt [rad].
std::vector<double> angles_of(const Simulation& s) {
  std::vector<double> angles;
  for (int i = 2; i < 6; ++i) {
    const Vector3 place = s.world.position({i}) - Vector3(1.0, 0.0, 0.0);
    angles.push_back(std::atan2(place.y(), place.x()));
  }
  return angles;
}

// The frame of the landing contains up to 0.02 s of the ride, in which the rope slips until its new
// arc is long enough to hold: about 3 % of the landing.
TEST(RidingAttachment, LosesTheEnergyOfItsLanding) {
  for (const double ball : {0.02, 0.01, 0.005}) {
    Ride ride;
    ride.ball = ball;
    ride.substeps = 64;
    const double landing = landing_loss(ball, speed_at(ride.speed, landing_height(ball)));
    EXPECT_NEAR(losses_of(ride).landing, landing, 0.05 * landing) << ball;
  }
}

// A contact on a curve takes the speed across it that each substep brings: a loss of first order in
// the substep. Two differences of losses at halved substeps have the ratio 2, and terms of second
// order are a sixteenth of the first at 16 substeps.
TEST(RidingAttachment, RidesWithALossOfFirstOrder) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    Ride ride;
    ride.integrator = integrator;
    std::vector<double> lost;
    for (const int substeps : {16, 32, 64}) {
      ride.substeps = substeps;
      lost.push_back(losses_of(ride).ride);
    }
    EXPECT_NEAR((lost[0] - lost[1]) / (lost[1] - lost[2]), 2.0, 2.0 / 16.0);
    // The limit is the slip of the rope.
    EXPECT_GT(2.0 * lost[2] - lost[1], 0.0);
    EXPECT_LT(2.0 * lost[2] - lost[1], 0.01);
  }
}

TEST(RidingAttachment, RidesWithElasticRopesAndByGaussSeidel) {
  const Losses rigid = losses_of({});
  for (const double stiffness : {1e5, 1e6}) {
    for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
      Ride ride;
      ride.stiffness = stiffness;
      ride.solver = solver;
      const Losses losses = losses_of(ride);
      EXPECT_GT(losses.landing + losses.ride, 0.0);
      EXPECT_LT(losses.landing + losses.ride, 2.0 * (rigid.landing + rigid.ride));
    }
  }
}

// Lengths of the machine are rounded differently, by 1e-15, and contacts see that.
TEST(RidingAttachment, IsTheSameMirroredTurnedAndInSpace) {
  const Losses planar = losses_of({});
  for (const bool mirrored : {false, true}) {
    for (const Quaternion& turn : {Quaternion(1.0, 0.0, 0.0, 0.0), Quaternion(0.5, 0.5, -0.5, 0.5),
                                   Quaternion(0.8, 0.0, 0.6, 0.0)}) {
      Ride ride;
      ride.mobility = Mobility::free;
      ride.mirrored = mirrored;
      ride.turn = turn;
      const Losses losses = losses_of(ride);
      EXPECT_NEAR(losses.landing, planar.landing, 1e-9);
      EXPECT_NEAR(losses.ride, planar.ride, 1e-9);
    }
  }
}

// All grips of a belt ride over both of its wheels again and again, in both directions.
TEST(RidingAttachment, CirculatesOnABelt) {
  for (const double speed : {1.0, -1.0}) {
    Simulation s = test::start(belt(speed));
    std::vector<double> turned(4, 0.0);
    std::vector<double> last = angles_of(s);
    const auto& state = s.world.state();
    while (state.time < 15.0) {
      ASSERT_TRUE(s.world.step().ok()) << state.time;
      const std::vector<double> now = angles_of(s);
      for (std::size_t i = 0; i < 4; ++i) {
        turned[i] += std::remainder(now[i] - last[i], 2.0 * pi);
      }
      last = now;
    }
    // The rope goes 15 m, less the start of 0.5 m, of the belt's 7.14 m, so each grip has gone round
    // twice. About the middle of the belt the grips turn by less than a half more or less.
    for (const double angle : turned) {
      EXPECT_NEAR(angle / (2.0 * pi), (speed > 0.0 ? 1.0 : -1.0) * 14.5 / belt_length, 0.25);
    }
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  }
}

// A loss of first order c h with the c of 16 substeps, half of it more for terms of second order, and
// less than 0.01 J by the slip of the rope.
TEST(RidingAttachment, RidesWithOneSubstepAndWith256) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    Ride ride;
    ride.integrator = integrator;
    ride.substeps = 16;
    const double measure = 16.0 * losses_of(ride).ride;
    for (const int substeps : {1, 2, 256}) {
      ride.substeps = substeps;
      EXPECT_LT(losses_of(ride).ride, 1.5 * measure / substeps + 0.01) << substeps;
    }
  }
}

/// Why a machine ends; empty if it does not within 3 s.
std::string end_of(const test::Machine& machine) {
  Simulation s = test::start(machine);
  while (s.world.state().time < 3.0) {
    const StepReport step = s.world.step();
    if (step.divergence) return step.divergence->message;
  }
  return {};
}

// Nothing keeps the attachment outside then. The cable may leave the wheel in the same substep, and the
// message names the wheel all the same.
TEST(RidingAttachment, WithoutCollidersEndsTheRunWithTheRemedy) {
  for (const double speed : {1.2, 2.0, 3.0}) {
    for (const int substeps : {1, 8, 64}) {
      Ride ride;
      ride.speed = speed;
      ride.substeps = substeps;
      test::Machine listed = riding(ride);
      listed.model.colliders.clear();
      const std::string why = end_of(listed);
      EXPECT_NE(why.find("link 1 on \"grip\", has reached the wheel of"), std::string::npos) << why;
      EXPECT_NE(why.find("\"wheel\""), std::string::npos) << why;
      EXPECT_EQ(why.find("\"right\""), std::string::npos) << why;
      EXPECT_NE(why.find("give both bodies colliders"), std::string::npos) << why;
    }
  }
  // The wheels of a belt are wrapped by places that are no links of the list.
  test::Machine found = belt(1.0);
  found.model.colliders.clear();
  EXPECT_NE(end_of(found).find("has reached the wheel of"), std::string::npos) << end_of(found);
}

TEST(RidingAttachment, GoesOnBitForBitFromASavedState) {
  Simulation s = test::start(riding({}));
  while (s.world.position({2}).y() < 0.2) ASSERT_TRUE(s.world.step().ok());
  const State saved = s.world.state();
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(s.world.step().ok());
  const std::uint64_t end = hash(s.world.state());
  Simulation other = test::start(riding({}));
  ASSERT_TRUE(other.world.restore(saved).empty());
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(hash(other.world.state()), end);
}

}  // namespace
}  // namespace sheave
