// Bodies that keep a plane have fewer rows; what they do is what free bodies do that nothing pushes
// out of it.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/constraint_batch.h"
#include "engine/contacts/planar_contact.h"
#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::Heap;

// A tilted plane, so that nothing lies along an axis of the world by chance.
const Quaternion tilted = rotation_by({0.3, -0.5, 0.2});

/// A box that falls askew onto a floor and slides on it, in the plane z = 0.
Heap sliding_box(Mobility mobility, const test::Method& method) {
  Heap heap(method.solver, method.integrator);
  heap.surface.friction = 0.3;
  heap.floor();
  heap.put(test::box({0.6, 0.4, 0.5}), {0.0, 0.2, 0.0}, 2.0);
  heap.last().mobility = mobility;
  heap.last().velocity = {2.0, 0.0, 0.0};
  return heap;
}

TEST(PlanarMotion, ABoxSlidesOnTwoPointsAsItDoesOnFour) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    World planar = sliding_box(Mobility::planar, method).start();
    World free = sliding_box(Mobility::free, method).start();
    for (int i = 0; i < 30; ++i) {
      ASSERT_TRUE(planar.step().ok());
      ASSERT_TRUE(free.step().ok());
      double force = 0.0;
      for (const ContactReport& contact : planar.contacts()) force += contact.normal_force;
      // What softness lets the box sink is 1e-9 of its fall in a substep; the force ends that fall.
      if (method.integrator == IntegratorKind::xpbd) {
        ASSERT_NEAR(force, 2.0 * test::g, 1e-4) << i;
      }
    }
    EXPECT_EQ(planar.contacts().size(), 2U);
    EXPECT_EQ(free.contacts().size(), 4U);
    // v = v0 - mu g t; both share friction by the last substep's normal forces, which tip the free
    // box alike.
    EXPECT_NEAR(planar.velocity({1}).x(), 2.0 - 0.3 * test::g * 0.5, 1e-3);
    EXPECT_NEAR(planar.velocity({1}).x(), free.velocity({1}).x(), 1e-3);
  }
}

TEST(PlanarMotion, PointsInLineAcrossThePlaneBecomeOne) {
  Manifold manifold;
  manifold.normal = Vector3::UnitY();
  const auto point = [](double x, double z) {
    ContactPoint made;
    made.core_a = {x, 0.0, z};
    made.core_b = {x, -0.1, z};
    return made;
  };
  manifold.points = {point(1.0, 0.5), point(2.0, 0.5), point(1.0, -0.3), point(2.0, -0.5)};
  const Manifold all = manifold;
  merge_behind(Vector3::UnitZ(), 1.0, manifold);
  ASSERT_EQ(manifold.points.size(), 2U);
  EXPECT_LT((manifold.points[0].core_a - Vector3(1.0, 0.0, 0.1)).norm(), 1e-15);
  EXPECT_LT((manifold.points[0].core_b - Vector3(1.0, -0.1, 0.1)).norm(), 1e-15);
  EXPECT_EQ(manifold.points[1].core_a, Vector3(2.0, 0.0, 0.0));
  // Seen along x two and two lie behind one another, but at different z.
  manifold = all;
  merge_behind(Vector3::UnitX(), 1.0, manifold);
  EXPECT_EQ(manifold.points.size(), 3U);
  // Out of the plane no contact can do anything, so nothing is worth merging.
  manifold = all;
  merge_behind(Vector3::UnitY(), 1.0, manifold);
  EXPECT_EQ(manifold.points.size(), 4U);
}

TEST(PlanarMotion, PlaneOfMotionIsSharedByBothBodies) {
  Model model;
  const auto add = [&](Mobility mobility, const Vector3& axis) {
    BodyDef body = test::lump("body " + std::to_string(model.bodies.size()), Vector3::Zero(), 1.0);
    body.mobility = mobility;
    if (mobility == Mobility::planar) body.axis = axis;
    return model.add(body).index;
  };
  const int level = add(Mobility::planar, Vector3::UnitZ());
  const int opposite = add(Mobility::planar, -Vector3::UnitZ());
  const int upright = add(Mobility::planar, Vector3::UnitX());
  const int loose = add(Mobility::free, Vector3::UnitZ());
  const World world = test::start(model);
  const BodySet& bodies = world.bodies();
  EXPECT_TRUE(plane_of_motion(bodies, level, opposite));
  EXPECT_TRUE(plane_of_motion(bodies, level, bodies.count()));
  EXPECT_FALSE(plane_of_motion(bodies, level, upright));
  EXPECT_FALSE(plane_of_motion(bodies, level, loose));
  EXPECT_FALSE(plane_of_motion(bodies, loose, bodies.count()));
}

/// A double pendulum of hinged bars in a tilted plane.
World double_pendulum(Mobility mobility, const test::Method& method) {
  Model model;
  const Vector3 normal = tilted * Vector3::UnitZ();
  model.gravity = tilted * Vector3(0.0, -test::g, 0.0);
  model.step = test::settings(0.005, 1, method.solver == SolverKind::direct ? 20 : 300);
  model.step.solver = method.solver;
  model.step.integrator = method.integrator;
  BodyId last = BodyId::world();
  for (int i = 0; i < 2; ++i) {
    BodyDef bar = test::lump("bar " + std::to_string(i), tilted * Vector3(0.5 + i, 0.0, 0.0), 1.0);
    bar.inertia = Vector3::Constant(0.1);  // about a tilted axis, too
    bar.mobility = mobility;
    if (mobility == Mobility::planar) bar.axis = normal;
    const BodyId id = model.add(bar);
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "hinge " + std::to_string(i);
    hinge->body_a = last;
    hinge->body_b = id;
    hinge->anchor = tilted * Vector3(1.0 * i, 0.0, 0.0);
    hinge->axis = normal;
    model.joints.push_back(hinge);
    last = id;
  }
  return test::start(model);
}

TEST(PlanarMotion, AHingeNeedsTwoRowsInAPlane) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    // The sum of what sweeps of xpbd do along gradients that turn meanwhile depends on the rows'
    // order, to first order in h.
    if (method.solver == SolverKind::gauss_seidel && method.integrator == IntegratorKind::xpbd) {
      continue;
    }
    World planar = double_pendulum(Mobility::planar, method);
    World free = double_pendulum(Mobility::free, method);
    EXPECT_EQ(planar.features()[0]->row_count(), 4);
    EXPECT_EQ(free.features()[0]->row_count(), 10);
    test::run(planar, 1.0);
    test::run(free, 1.0);
    // The solvers leave 1e-10 of the scene and, with sweeps, what 300 of them do; the motion is not
    // chaotic yet.
    const double left = method.solver == SolverKind::direct ? 1e-7 : 1e-4;
    for (const int i : {0, 1}) {
      EXPECT_NEAR((planar.position({i}) - free.position({i})).norm(), 0.0, left) << i;
    }
    // What holds the upper bar, too: the forces of two rows along directions of the plane.
    const Vector3 force = joint_reports(free)[0].force;
    EXPECT_NEAR((joint_reports(planar)[0].force - force).norm(), 0.0, 1e3 * left * force.norm());
  }
}

}  // namespace
}  // namespace sheave
