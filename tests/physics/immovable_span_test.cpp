// Spans that no body can lengthen, because joints hold both ends: what the solver makes of the
// rounding of their lengths.

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;

/// A carriage on a slanting rail with a wheel on it, which a hinge beside its axle joins to the
/// world, so that neither can move; a rope from a load of 1 kg through a rough hole to the wheel,
/// and on to the world, all of it just taut. Turned by `angle` about the origin, with gravity.
test::Machine locked_carriage(IntegratorKind integrator, double angle) {
  const Quaternion turn = rotation_by({0.0, 0.0, angle});
  test::Machine m;
  m.model.gravity = turn * test::down;
  m.model.step = test::direct_settings(integrator, 0.002, 2);
  BodyDef carriage = test::weight("carriage", turn * Vector3(3.3, 0.2, 0.0), 2.0);
  carriage.axis = turn * Vector3(-0.6, -0.8, 0.0);
  carriage.orientation = turn;
  const BodyId rail = m.model.add(carriage);
  const Vector3 axle = turn * Vector3(3.4, 0.3, 0.0);
  const BodyId wheel = m.model.add(test::sheave("wheel", rail, axle, 0.2, 1.0, 0.05));
  BodyDef load = test::lump("load", turn * Vector3(0.3, -2.0, 0.0), 1.0);
  load.mobility = Mobility::planar;
  const BodyId hanging = m.model.add(load);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = wheel;
  hinge->anchor = turn * Vector3(3.27, 0.61, 0.0);
  hinge->axis = Vector3::UnitZ();
  m.model.joints.push_back(hinge);
  auto hole = std::make_shared<PinholeLink>();
  hole->body = BodyId::world();
  hole->point = turn * Vector3(0.3, 0.1, 0.0);
  hole->friction = 0.1;
  m.cables.push_back(
      cable("rope", {attach(hanging), hole, attach(wheel, turn * Vector3(0.1, 0.05, 0.0)),
                     attach(BodyId::world(), turn * Vector3(5.1, -0.7, 0.0))}));
  return m;
}

TEST(ImmovableSpan, HasNoTensionOfRounding) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    double largest = 0.0;
    for (int i = 0; i < 40; ++i) {
      Simulation s = test::start(locked_carriage(integrator, 0.157 * i));
      for (int step = 0; step < 20; ++step) {
        ASSERT_TRUE(s.world.step().ok());
        const CableReport report = s.cable_reports()[0];
        largest = std::max(largest, report.spans[2].tension);
        // The load hangs from what is open within the cone of the hole.
        EXPECT_NEAR(report.spans[0].tension, test::g, 1e-6);
      }
    }
    EXPECT_LT(largest, 1e-2);
  }
}

}  // namespace
}  // namespace sheave
