// Spans that no body can lengthen, because joints hold both ends: what the solver makes of the
// rounding of their lengths.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/shapes/half_space.h"
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

/// A rope from a body that a slider across its plane locks, through a rough hole and a ring on a
/// falling body to the world, so that its tension grows; and a box at rest on a rough floor.
test::Machine locked_end_beside_a_box() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.013);
  BodyDef end = test::lump("end", Vector3::Zero(), 0.24);
  end.mobility = Mobility::planar;
  const BodyId locked = m.model.add(end);
  auto slider = std::make_shared<SliderJoint>();
  slider->name = "slider";
  slider->body_b = locked;
  slider->axis = Vector3(0.39, 0.81, 0.66).normalized();
  m.model.joints.push_back(slider);
  const BodyId falling = m.model.add(test::lump("falling", {2.7, 0.0, 0.0}, 1.3));
  auto plane = std::make_shared<HalfSpace>();
  BodyDef floor;
  floor.name = "floor";
  floor.mobility = Mobility::fixed;
  floor.position = {0.0, -2.0, 0.0};
  floor.shapes = {{plane}};
  BodyDef box = test::lump("box", {-2.0, -1.85, 0.0}, 1.8);
  for (const BodyDef& body : {floor, box}) {
    ColliderDef collider;
    collider.body = m.model.add(body);
    collider.friction = 0.5;
    m.model.colliders.push_back(collider);
  }
  auto hole = std::make_shared<PinholeLink>();
  hole->body = BodyId::world();
  hole->point = {1.24, -0.233, 0.0};
  hole->friction = 0.538;
  auto ring = std::make_shared<PinholeLink>();
  ring->body = falling;
  ring->point = {0.168, 0.0, 0.0};
  m.cables.push_back(test::cable(
      "rope", {attach(locked), hole, ring, attach(BodyId::world(), {6.82, -0.16, 0.0})}));
  return m;
}

TEST(ImmovableSpan, HasTheTensionThatItsHoleAllows) {
  Simulation s = test::start(locked_end_beside_a_box());
  const Vector3 hole(1.24, -0.233, 0.0);
  const auto turn = [&] {
    const BodyState& falling = s.world.state().bodies[1];
    const Vector3 ring = falling.position + falling.orientation * Vector3(0.168, 0.0, 0.0);
    const Vector3 in = hole.normalized();
    return std::acos(std::clamp(in.dot((ring - hole).normalized()), -1.0, 1.0));
  };
  double largest = 0.0;
  for (int step = 0; step < 30; ++step) {
    const double before = turn();
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    // The angle is another one in each half of the substep.
    const double most = std::exp(0.538 * std::max(before, turn()));
    EXPECT_LE(report.spans[1].tension, report.spans[0].tension * most * (1.0 + 1e-6) + 1e-6);
    largest = std::max(largest, report.spans[1].tension);
  }
  EXPECT_GT(largest, 100.0) << "it grows";
}

TEST(ImmovableSpan, RoundingCausesNoTension) {
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
