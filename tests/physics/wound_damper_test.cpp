// A damped rope of a material from a fixed point to a drum that winds it up at a constant speed.
//
// The span keeps its length l, so what comes onto the drum stretches what is left, L de/dt = v, as
// if an end were drawn away at that speed: with L = l / (1 + e)
//
//   1 + e(t) = (1 + e0) e^(v t / l),    T = EA e + b v,
//
// the damper's part being constant however much of the span is wound up in a substep.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::wound_damper {
namespace {

class WoundDamper : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, WoundDamper, testing::ValuesIn(test::combinations),
                         test::combination_name);

constexpr double radius = 0.25;
constexpr double length = 2.0;
constexpr double speed = 2.0;
constexpr double strain = 0.05;
constexpr double stiffness = 1000.0;
constexpr double damping = 100.0;

TEST_P(WoundDamper, HasTheForceOfTheRimSpeed) {
  constexpr double h = 0.1;
  test::Machine m;
  m.model.step = step_settings(h, 50);
  BodyDef drum = test::wheel("drum", Vector3::Zero(), radius, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_values = {-speed / radius};
  drum.angular_velocity = {0, 0, -speed / radius};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = m.model.add(drum);
  spool->winding = test::left;
  spool->stored_length = 1.0;
  m.cables.push_back(
      test::cable("rope", {spool, test::attach(BodyId::world(), {-radius, -length, 0.0})}));
  m.cables[0].axial_stiffness = stiffness;
  m.cables[0].damping = damping;
  m.cables[0].rest_lengths = {length / (1.0 + strain)};
  Simulation s = test::start(m);
  double before = strain;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const std::vector<CableReport> reports = s.cable_reports();
    const SpanReport& span = reports[0].spans[0];
    const double now = span.length / span.rest_length - 1.0;
    const double acts = GetParam().rattle() ? 0.5 * (before + now) : now;
    EXPECT_NEAR(span.tension, stiffness * acts + damping * speed, 1e-9 * stiffness);
    before = now;
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate.has_value());
    // With the trapezoidal rule 1e-4 of the energy is off.
    EXPECT_TRUE(certificate->clean(1e-3)) << certificate->worst()->sentence();
  }
  // The trapezoidal rule is off by (v h / l)^2 / 12 of the exponent.
  const double turns = speed * 5 * h / length;
  EXPECT_NEAR(1.0 + before, (1.0 + strain) * std::exp(turns),
              (1.0 + before) * turns * std::pow(speed * h / length, 2));
}

}  // namespace
}  // namespace sheave::wound_damper
