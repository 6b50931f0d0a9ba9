// Bodies that dry friction holds where they are: the search leaves them there, whatever the directions
// of the friction rows (statics/newton_step.cpp).

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

constexpr double mu = 0.5;
constexpr double weight = 50.0;  // [N], of the box

/// A box of 5 kg on rough ground, drawn by a force at a point of it.
std::string drawn(const Vector3& force, double height) {
  // A force at `height` above the middle of the box: with its torque about the middle.
  const Vector3 torque = Vector3(0.0, height, 0.0).cross(force);
  return fmt::format(
      R"("bodies": [{{"name": "box", "mass": 5, "position": [0, 0.1, 0], "shape": {{"type": "box", "size": [0.4, 0.2, 0.3]}},
        "force": [{}, {}, {}], "torque": [{}, {}, {}]}},
      {{"name": "floor", "mobility": "static", "shape": {{"type": "half-space"}}}}],
      "colliders": [{{"body": "box", "friction": 0.3, "static_friction": {}}},
        {{"body": "floor", "friction": 0.3, "static_friction": {}}}])",
      force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z(), mu, mu);
}

struct Held {
  bool holds = false;
  Vector3 moved = Vector3::Zero();
  Vector3 support = Vector3::Zero();
};

Held held(const Vector3& force, double height) {
  Simulation s = simulation_of(drawn(force, height));
  const Equilibrium rest = find_equilibrium(s);
  Held result;
  result.holds = rest.converged;
  result.moved = s.world.position({0}) - Vector3(0.0, 0.1, 0.0);
  for (const SupportReaction& support : support_reactions(s, rest.forces)) {
    result.support += support.force;
  }
  return result;
}

TEST(FrictionAtRest, HoldsABoxUpToItsBoundInEveryDirection) {
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 24.0;
    const Vector3 way(std::cos(angle), 0.0, std::sin(angle));
    for (const double share : {0.3, 0.9, 0.98}) {
      // Drawn from below its middle to above it, as far as it does not tip.
      for (const double height : {-0.1, 0.0, 0.05}) {
        const Vector3 force = share * mu * weight * way;
        const Held box = held(force, height);
        ASSERT_TRUE(box.holds) << angle << " " << share << " " << height;
        EXPECT_LE(box.moved.norm(), 1e-9);
        EXPECT_LE((box.support - Vector3(-force.x(), weight, -force.z())).norm(), 1e-6);
      }
    }
    // Nothing holds the box beyond that.
    EXPECT_FALSE(held(1.02 * mu * weight * way, -0.1).holds) << angle;
  }
}

TEST(FrictionAtRest, StaticFrictionCountsWhereverTheSearchHasBeen) {
  // 2.4 kg draw with 0.96 of the static friction. With the coefficient of sliding, 0.3, they would draw
  // it 3 m to the wheel.
  Simulation s = simulation_of(R"("bodies": [
    {"name": "box", "mass": 5, "position": [0, 0.1, 0], "shape": {"type": "box", "size": [0.4, 0.2, 0.3]}},
    {"name": "floor", "mobility": "static", "shape": {"type": "half-space"}},
    {"name": "wheel", "mobility": "rotor", "mass": 1, "position": [3, 0, 0], "shape": {"type": "cylinder", "radius": 0.1, "length": 0.05}},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2.4, "position": [3.1, -1, 0]}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "box"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "load"}]}],
    "colliders": [{"body": "box", "friction": 0.3, "static_friction": 0.5}, {"body": "floor", "friction": 0.3, "static_friction": 0.5}])");
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_LE(std::abs(s.world.position({0}).x()), 1e-9);
  EXPECT_NEAR(testing::tension(s, 0, 0), 24.0, 1e-9);
}

TEST(FrictionAtRest, HoldsABallJointWithinItsBound) {
  // An arm of 1 kg and 1 m hangs level on a ball joint with friction; its moment is 10 N x 0.5 m.
  const auto moved = [](double friction) {
    Simulation s = simulation_of(fmt::format(
        R"("bodies": [{{"name": "arm", "mass": 1, "position": [0.3, 0, 0.4], "inertia": [0.1, 0.1, 0.1], "shape": {{"type": "sphere", "radius": 0.1}}}}],
        "joints": [{{"type": "ball", "name": "joint", "body_b": "arm", "anchor": [0, 0, 0], "friction": {}}}])",
        friction));
    const Equilibrium rest = find_equilibrium(s);
    return rest.converged ? (s.world.position({0}) - Vector3(0.3, 0.0, 0.4)).norm() : 1e9;
  };
  EXPECT_LE(moved(5.1), 1e-9);
  EXPECT_LE(moved(9.0), 1e-9);
  EXPECT_GT(moved(4.0), 0.1);
}

}  // namespace
}  // namespace sheave
