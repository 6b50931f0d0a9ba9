// What machines do does not depend on what stands beside them without touching them; and a damped
// rod on a body that tumbles is what the certificate takes it for.

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

/// A box that lands on a slope and stays there, with a plate on a rail that holds it more than once
/// beside it, or without.
std::vector<ContactReport> landed(bool beside) {
  test::Heap heap(SolverKind::direct, IntegratorKind::rattle);
  heap.model.step = test::direct_settings(IntegratorKind::rattle, 0.0024);
  heap.incline(0.39);
  heap.surface.friction = 0.69;
  heap.floor();
  heap.put(test::box({0.3, 0.3, 0.3}), {0.0, 0.1515, 0.0}, 1.46);
  heap.last().velocity = {0.472, -1.17, 0.0};
  if (beside) {
    BodyDef plate = test::lump("plate", {5.0, 5.0, 0.0}, 0.57);
    plate.mobility = Mobility::planar;
    auto rail = std::make_shared<CylindricalJoint>();
    rail->name = "rail";
    rail->body_b = heap.model.add(plate);
    rail->anchor = {4.8, 5.1, 0.0};
    rail->axis = {-0.698, 0.846, 0.0};
    heap.model.joints.push_back(rail);
  }
  World world = heap.start();
  EXPECT_TRUE(world.step().ok());
  return world.contacts();
}

// Four corners leave open which of them rubs how much; what settles that are the corners alone.
TEST(Apart, RedundantJointsElsewhereDoNotChangeForces) {
  const std::vector<ContactReport> alone = landed(false);
  const std::vector<ContactReport> together = landed(true);
  ASSERT_EQ(alone.size(), together.size());
  ASSERT_GE(alone.size(), 4U);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    // Row::softness gives some 1e-7 of some 200 N.
    EXPECT_NEAR(alone[i].normal_force, together[i].normal_force, 1e-4) << i;
    EXPECT_LT((alone[i].friction_force - together[i].friction_force).norm(), 1e-4) << i;
  }
}

// The damper works against what a unit of its force moves, with the turn as the integrator counts
// it: free rotation and correction, added. Their composition is another vector, by a tenth of the
// turn here, of which the damper would make a tenth of the rod's stretch.
TEST(DampedRod, OfATumblingBodyIsCertified) {
  for (const DistanceLimit limit : {DistanceLimit::exactly, DistanceLimit::at_most}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::direct_settings(IntegratorKind::xpbd, 0.013);
    BodyDef box = test::lump("box", Vector3::Zero(), 1.32);
    box.inertia = Vector3(0.02, 0.05, 0.06);
    box.angular_velocity = {9.0, -7.0, 6.0};
    auto rod = std::make_shared<DistanceJoint>();
    rod->name = "rod";
    rod->body_b = m.model.add(box);
    rod->anchor_a = {0.94, -0.22, 0.0};
    rod->anchor_b = {0.4, 0.11, 0.2};
    rod->limit = limit;
    rod->compliance = 0.0062;
    rod->damping = 29.0;
    m.model.joints.push_back(rod);
    Simulation s = test::start(m);
    for (int step = 0; step < 60; ++step) {
      ASSERT_TRUE(s.world.step().ok());
      const auto certificate = s.certificate();
      ASSERT_TRUE(certificate.has_value());
      for (const CertificateItem& item : certificate->items) {
        // Rounds end at 1e-10 of the size; what the damper takes is known to the second order.
        const bool lock = item.kind == CertificateItem::Kind::joint;
        EXPECT_LT(item.relative, lock ? 1e-7 : 0.01) << item.sentence();
      }
    }
  }
}

}  // namespace
}  // namespace sheave
