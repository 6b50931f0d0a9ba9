// Substeps in which Newton's rounds from the prediction do not converge at first, so that
// corrections are added up: what acts at their end must be what has moved the bodies.

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;

std::shared_ptr<PinholeLink> ring_on(BodyId body, const Vector3& point, double friction) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  link->friction = friction;
  return link;
}

const Vector3 crank_axle{0.0, -0.4, 0.0};
const Vector3 rough_hole{1.5, 0.285, 0.0};
constexpr double crank_inertia = 0.004;

/// A rope from the rim of a light crank through a rough hole to a carriage on a slope, through a
/// ring on a body that hangs from it, and on to the world. As the body swings up and down the crank
/// whips round.
test::Machine crank_and_sling() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::xpbd, 0.012);
  const BodyId crank = m.model.add(test::wheel("crank", crank_axle, 0.08, crank_inertia));
  BodyDef carriage = test::weight("carriage", {4.05, -0.36, 0.0}, 0.75);
  carriage.axis = Vector3(0.728, 0.685, 0.0).normalized();
  const BodyId rail = m.model.add(carriage);
  const BodyId hanging = m.model.add(test::lump("hanging", {6.75, -0.27, 0.0}, 2.1));
  m.cables.push_back(test::cable(
      "rope", {attach(crank, {0.0, -0.08, 0.0}), ring_on(BodyId::world(), rough_hole, 0.5676),
               ring_on(rail, Vector3::Zero(), 0.0), ring_on(hanging, Vector3::Zero(), 0.0),
               attach(BodyId::world(), {8.15, 0.2, 0.0})}));
  return m;
}

TEST(AddedUp, TheTensionHasTheTorqueThatTurnsTheCrank) {
  Simulation s = test::start(crank_and_sling());
  double largest = 0.0;
  for (int step = 0; step < 100; ++step) {
    const double before = s.world.state().bodies[0].angular_velocity.z();
    ASSERT_TRUE(s.world.step().ok());
    const BodyState& crank = s.world.state().bodies[0];
    // By implicit Euler the force acts along the direction at the end of the substep.
    const Vector3 arm = crank.orientation * Vector3(0.0, -0.08, 0.0);
    const Vector3 pull = (rough_hole - crank_axle - arm).normalized();
    const double torque = s.cable_reports()[0].spans[0].tension * arm.cross(pull).z();
    const double change = crank_inertia * (crank.angular_velocity.z() - before) / 0.012;
    // Rounds end where bodies are within 1e-9 of the scene's 8 m, which turns the crank by 1e-7,
    // and 0.004 x 1e-7 / 0.012^2 is 3e-6 N m. Where they do not converge a thousandth of the forces
    // may be off.
    EXPECT_NEAR(change, torque, 3e-6 + 1e-3 * 0.08 * s.cable_reports()[0].spans[0].tension);
    largest = std::max(largest, std::abs(torque));
  }
  EXPECT_GT(largest, 0.5) << "it whips";
}

}  // namespace
}  // namespace sheave
