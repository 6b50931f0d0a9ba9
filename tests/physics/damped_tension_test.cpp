// The tension of a damped cable is that of its spring and its damper at an instant
// (cable/damped_tension.h).
//
// A hand at the speed v draws a body of the mass m by a cable with the compliance a and the damping
// b. The stretch s = v t - x obeys m s'' + b s' + s / a = 0 with s(0) = 0 and s'(0) = v, so
//   s = v / w e^(-z t) sin w t,   z = b / 2 m,   w^2 = 1 / a m - z^2,   T = s / a + b s'.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

constexpr double drawn_speed = 2.0;        // [m/s]
constexpr double drawn_compliance = 0.01;  // [m/N]
constexpr double drawn_damping = 3.0;      // [N s/m]
constexpr double drawn_rate = drawn_damping / 2.0;
const double drawn_pitch = std::sqrt(1.0 / drawn_compliance - drawn_rate * drawn_rate);

double drawn_stretch(double t) {
  return drawn_speed / drawn_pitch * std::exp(-drawn_rate * t) * std::sin(drawn_pitch * t);
}

double drawn_stretching(double t) {
  return drawn_speed * std::exp(-drawn_rate * t) * std::cos(drawn_pitch * t) -
         drawn_rate * drawn_stretch(t);
}

double drawn_tension(double t) {
  return drawn_stretch(t) / drawn_compliance + drawn_damping * drawn_stretching(t);
}

/// Body 0 of 1 kg, drawn by body 1. `mirrored`: the cable is counted from the hand.
Simulation drawn_body(IntegratorKind integrator, double h, double breaking, bool mirrored = false) {
  test::Machine m;
  m.model.step = test::direct_settings(integrator, h);
  BodyDef body = test::lump("body", Vector3::Zero(), 1.0);
  const BodyId drawn = m.model.add(body);
  BodyDef hand = test::lump("hand", {1.0, 0.0, 0.0}, 1.0);
  hand.mobility = Mobility::kinematic;
  hand.velocity = {drawn_speed, 0.0, 0.0};
  const BodyId by = m.model.add(hand);
  m.cables.push_back(mirrored ? test::cable("rope", {test::attach(by), test::attach(drawn)})
                              : test::cable("rope", {test::attach(drawn), test::attach(by)}));
  m.cables[0].compliance = drawn_compliance;
  m.cables[0].damping = drawn_damping;
  if (breaking > 0.0) m.cables[0].breaking_tension = breaking;
  return test::start(m);
}

void run_until(Simulation& s, double time) {
  const double dt = s.world.model().step.dt;
  while (s.world.state().time < time - 0.5 * dt) ASSERT_TRUE(s.world.step().ok());
}

/// Error of the tension in 0.1 s [N].
double tension_error(IntegratorKind integrator, double h, bool mirrored) {
  Simulation s = drawn_body(integrator, h, 0.0, mirrored);
  run_until(s, 0.1);
  const SpanReport span = s.cable_reports()[0].spans[0];
  EXPECT_NEAR(span.start_force.norm(), span.tension, 1e-12);
  return span.tension - drawn_tension(0.1);
}

// Under `rattle` the state is of second order, and so is its tension. (The mean over the last
// substep was off by T' h / 2: 0.11 N with the first step.)
TEST(DampedTension, IsThatOfTheInstant) {
  for (const bool mirrored : {false, true}) {
    const double coarse = tension_error(IntegratorKind::rattle, 0.01, mirrored);
    const double fine = tension_error(IntegratorKind::rattle, 0.005, mirrored);
    EXPECT_LT(std::abs(coarse), 0.03);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4);
    EXPECT_NEAR(tension_error(IntegratorKind::xpbd, 0.0005, mirrored) /
                    tension_error(IntegratorKind::xpbd, 0.00025, mirrored),
                2.0, 0.2);
  }
}

// A slack cable has no tension, whatever its damper: the hand comes back at 2 m/s.
TEST(DampedTension, OfSlackCableIsNothing) {
  Simulation s = drawn_body(IntegratorKind::rattle, 0.005, 0.0);
  run_until(s, 0.45);
  ASSERT_LT(drawn_stretch(0.35), 0.0);
  EXPECT_EQ(s.cable_reports()[0].spans[0].tension, 0.0);
}

// It breaks at the instant t at which T = 14 N, and the body goes on at v - s'. Of second order.
TEST(DampedTension, BreaksTheCableAtItsInstant) {
  double low = 0.0;
  double high = 0.1;
  ASSERT_GT(drawn_tension(high), 14.0);
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (drawn_tension(middle) > 14.0 ? high : low) = middle;
  }
  const double x =
      drawn_speed * low - drawn_stretch(low) + (drawn_speed - drawn_stretching(low)) * (0.5 - low);
  double errors[2];
  double* error = errors;
  for (const double h : {0.01, 0.0025}) {
    Simulation s = drawn_body(IntegratorKind::rattle, h, 14.0);
    run_until(s, 0.5);
    ASSERT_EQ(s.cables->events().size(), 1U);
    EXPECT_NEAR(s.cables->events()[0].time, low, 10.0 * h * h);
    *error++ = s.world.position(BodyId{0}).x() - x;
  }
  EXPECT_LT(std::abs(errors[0]), 0.002);
  EXPECT_GT(std::abs(errors[0] / errors[1]), 10.0);
}

}  // namespace
}  // namespace sheave
