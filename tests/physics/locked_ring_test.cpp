// A closed rope over wheels and a hole of bodies that joints lock: nothing can pull at it.

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

BodyDef turned_wheel(std::string name, const Quaternion& turn, const Vector3& at, double radius) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::rotor;
  body.axis = turn * Vector3::UnitZ();
  body.position = turn * at;
  body.orientation = turn;
  body.mass = 1.6;
  auto shape = std::make_shared<Cylinder>();
  shape->radius = radius;
  body.shapes = {{shape}};
  return body;
}

test::Machine locked_ring(const Quaternion& turn) {
  test::Machine m;
  m.model.gravity = turn * test::down;
  m.model.step = test::direct_settings(IntegratorKind::xpbd, 0.004, 3);
  BodyDef carrier = test::lump("carrier", turn * Vector3(0.634, -0.0076, 0.0), 2.83);
  carrier.mobility = Mobility::planar;
  carrier.axis = turn * Vector3::UnitZ();
  carrier.orientation = turn;
  const BodyId carries = m.model.add(carrier);
  BodyDef mounted = turned_wheel("mounted", turn, {0.746, 0.0, 0.0}, 0.236);
  mounted.mount = carries;
  const BodyId held = m.model.add(mounted);
  const BodyId free = m.model.add(turned_wheel("free", turn, {-0.334, 0.578, 0.0}, 0.256));
  BodyDef carriage = test::weight("carriage", turn * Vector3(-0.34, -0.589, 0.0), 1.9);
  carriage.axis = turn * Vector3(-0.168, -0.986, 0.0).normalized();
  carriage.orientation = turn;
  const BodyId rail = m.model.add(carriage);
  auto fixed = std::make_shared<FixedJoint>();
  fixed->name = "fixed";
  fixed->body_b = held;
  fixed->anchor = turn * Vector3(0.884, 0.12, 0.0);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = rail;
  hinge->anchor = turn * Vector3(-0.529, -0.562, 0.0);
  hinge->axis = turn * Vector3::UnitZ();
  m.model.joints = {fixed, hinge};
  auto first = test::roll(held, test::left);
  first->friction = 0.328;
  auto second = test::roll(free, test::left);
  second->friction = 0.0634;
  auto hole = std::make_shared<PinholeLink>();
  hole->body = rail;
  hole->point = {0.119, 0.099, 0.0};
  m.cables.push_back(test::cable("rope", {first, second, hole}));
  m.cables.back().closed = true;
  return m;
}

TEST(LockedRing, HasNoTensionInAnyOrientation) {
  test::Random random(1);
  for (int i = 0; i < 60; ++i) {
    Simulation s = test::start(locked_ring(random.orientation()));
    for (int step = 0; step < 5; ++step) {
      ASSERT_TRUE(s.world.step().ok());
      const std::vector<CableReport> cables = s.cable_reports();
      // Redundant rows share the joints' load of some 100 N to 1e-7 of it, and rounding.
      for (const SpanReport& span : cables[0].spans) EXPECT_LT(span.tension, 1e-3);
    }
  }
}

}  // namespace
}  // namespace sheave
