// The estimate of the step's error of runs in which a rigid rope or a joint breaks.

#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/joints/distance.h"
#include "measure/error_estimate.h"
#include "scenes/scene.h"
#include "tests/measure/estimated_run.h"
#include "tests/support/builders.h"

namespace sheave::measure {
namespace {

using test::estimated;
using test::Estimated;
using test::g;
using test::scene_of;

/// A bob of 1 kg on 1 m of a rigid rope or a rigid rod that breaks at 15 N, from rest at 1 rad to the
/// vertical.
Scene breaking_pendulum(bool rod, int substeps) {
  test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
  if (rod) {
    auto joint = std::make_shared<DistanceJoint>();
    joint->name = "rod";
    joint->body_b = BodyId{0};
    joint->anchor_b = m.model.bodies[0].position;
    joint->breaking_force = 15.0;
    m.model.joints.push_back(joint);
    m.cables.clear();
  } else {
    m.cables[0].breaking_tension = 15.0;
  }
  Scene scene = scene_of(m, IntegratorKind::rattle, substeps);
  scene.duration = 1.0;
  return scene;
}

TEST(ErrorEstimateOfBreaks, ABreakAtItsInstantIsNoSuddenEvent) {
  // T = m g (3 cos a - 2 cos a0) is 15 N at cos a = (15 N / m g + 2 cos a0) / 3. The speed there is
  // sqrt(2 g l (cos a - cos a0)), along the tangent of the circle. The rest is a parabola.
  const double cosine = (15.0 / g + 2.0 * std::cos(1.0)) / 3.0;
  const double angle = std::acos(cosine);
  const double speed = std::sqrt(2.0 * g * (cosine - std::cos(1.0)));
  // With sin(a / 2) = k sin p and k = sin(a0 / 2) the time is (K(k) - F(p, k)) / sqrt(g / l).
  const double k = std::sin(0.5);
  const double phase = std::asin(std::sin(0.5 * angle) / k);
  const double left = 1.0 - (std::comp_ellint_1(k) - std::ellint_1(k, phase)) / std::sqrt(g);
  const Vector3 broken(std::sin(angle), -cosine, 0.0);
  const Vector3 velocity(-speed * cosine, -speed * std::sin(angle), 0.0);
  const Vector3 end = broken + left * velocity - Vector3(0.0, 0.5 * g * left * left, 0.0);
  for (const bool rod : {false, true}) {
    for (const int substeps : {1, 4, 16}) {
      SCOPED_TRACE(fmt::format("{} {}", rod, substeps));
      const Estimated run = estimated(breaking_pendulum(rod, substeps));
      EXPECT_EQ(run.estimate.changes.sudden, 0U);
      EXPECT_EQ(run.estimate.position.unseen, 0.0);
      EXPECT_EQ(run.estimate.changes.events, 1U);
      // The swing is of second order, and the instant, too. The estimate is the error within a third.
      const double error = (run.frames.back().poses[0].position - end).norm();
      const double told = run.estimate.bodies.at(0).position.error();
      EXPECT_GE(told, error / 1.5);
      EXPECT_LE(told, 2.0 * error + 1e-9);
      // A sudden event would have told a quarter of a substep times 2.9 m/s, an error of first order.
      EXPECT_LT(told, 0.1 * 0.25 * 2.9 / 60.0 / (substeps * substeps));
    }
  }
}

TEST(ErrorEstimateOfBreaks, ABreakWithoutAKnownInstantIsSudden) {
  // A hand draws a load on a rail straight to the limit of reach, where the tension has no bound. At
  // 1 kN the short motions still have a solution, at 10 MN they have none.
  for (const bool beyond : {false, true}) {
    SceneResult loaded =
        load_scene(std::string(SHEAVE_SOURCE_DIR) + "/tests/faults/breaks-beyond-reach.json");
    ASSERT_TRUE(loaded) << to_string(loaded.errors.front());
    loaded.scene->cables[0].breaking_tension = beyond ? 1e7 : 1e3;
    EXPECT_EQ(estimated(*loaded.scene).estimate.changes.sudden, beyond ? 1U : 0U);
  }
}

}  // namespace
}  // namespace sheave::measure
