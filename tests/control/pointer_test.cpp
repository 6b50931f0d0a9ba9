// A pointer that drags the end of a rope through a block and tackle, at 60 Hz, for a minute, with
// jerks of 10 m per frame.

#include <random>

#include <gtest/gtest.h>

#include "cable/live_world.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;

/// A tackle of four strands whose load hangs 12 m below it; its rope ends on `end`.
test::Machine tackle_with(const BodyDef& end) {
  test::Tackle tackle;
  tackle.strands = 4;
  test::Machine machine = tackle.machine();
  machine.model.bodies[test::Tackle::weight.index] = end;
  machine.model.bodies[test::Tackle::weight.index].position =
      tackle.machine().model.bodies[test::Tackle::weight.index].position;
  for (BodyDef& body : machine.model.bodies) {
    if (body.name == "block" || body.name.starts_with("lower")) body.position.y() -= 12.0;
  }
  machine.model.bodies[test::Tackle::weight.index].position.y() -= 4.0;
  machine.model.step = StepSettings{};
  machine.model.step.dt = 1.0 / 60.0;
  return machine;
}

/// Where the pointer is, frame by frame: a random walk about `home`, with jerks of 10 m.
class Pointer {
 public:
  /// Every 90 frames it jumps by `jump` [m].
  explicit Pointer(const Vector3& home, double jump = 10.0) : home_(home), at_(home), jump_(jump) {}
  Vector3 next() {
    std::normal_distribution<double> normal;
    ++frame_;
    if (frame_ % 90 == 0) {
      Vector3 way{normal(random_), normal(random_), normal(random_)};
      at_ += jump_ * way.normalized();
    } else {
      at_ += 0.05 * Vector3{normal(random_), normal(random_), normal(random_)};
      at_ += 0.05 * (home_ - at_);
    }
    return at_;
  }
  void go_home() { at_ = home_; }

 private:
  Vector3 home_;
  Vector3 at_;
  double jump_;
  int frame_ = 0;
  std::mt19937 random_{7};
};

// By a grip of 0.5 kg, pulled towards the pointer by a spring and a damper that has no more than
// 150 N.
TEST(Pointer, DragsARopeByAGripThroughATackle) {
  BodyDef grip = test::lump("grip", Vector3::Zero(), 0.5);
  LiveWorld world = [&] {
    const test::Machine machine = tackle_with(grip);
    Result<LiveWorld> made = LiveWorld::create(machine.model, machine.cables);
    EXPECT_TRUE(made.ok()) << test::text(made.errors());
    return std::move(*made);
  }();
  const BodyHandle handle = *world.body("grip");
  Pointer pointer(world.pose(handle)->position);
  const double start = world.energy().total();
  double most = 0.0;
  double stretch = 0.0;
  double work = 0.0;
  for (int frame = 0; frame < 3600; ++frame) {
    const Vector3 goal = pointer.next();
    // Before every substep, for a stiff spring on a light grip.
    const LiveReport report = world.step({}, [&] {
      const BodyPose pose = *world.pose(handle);
      Vector3 force = 200.0 * (goal - pose.position) - 15.0 * pose.velocity;
      constexpr double strongest = 150.0;
      if (force.norm() > strongest) force *= strongest / force.norm();
      EXPECT_TRUE(world.set_force(handle, {.force = force}).empty());
    });
    ASSERT_TRUE(report.ok()) << frame << ": " << report.divergence->message;
    work += report.statistics.external_work;
    const Energy energy = world.energy();
    ASSERT_TRUE(std::isfinite(energy.total())) << frame;
    most = std::max(most, energy.kinetic);
    // What the pointer has put in is all that there is.
    ASSERT_LT(energy.total(), start + work + 0.02 * (most + 100.0)) << frame;
    for (const CableReport& rope : world.simulation().cable_reports()) {
      stretch = std::max(stretch, rope.max_stretch);
    }
  }
  EXPECT_LT(most, 1e5);
  EXPECT_LT(stretch, 1e-8);
}

// By the end itself, which goes where the pointer is, whatever that takes: the rope never gets
// longer. Where the pointer draws a block to its beam, the run ends by name, and begins again.
TEST(Pointer, DragsTheEndOfARopeThroughATackle) {
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  const auto make = [&] {
    const test::Machine machine = tackle_with(hand);
    Result<LiveWorld> made = LiveWorld::create(machine.model, machine.cables);
    EXPECT_TRUE(made.ok()) << test::text(made.errors());
    return std::move(*made);
  };
  LiveWorld world = make();
  BodyHandle handle = *world.body("hand");
  Pointer pointer(world.pose(handle)->position, 2.0);
  double most = 0.0;
  double stretch = 0.0;
  double fastest = 0.0;
  int ends = 0;
  Vector3 before = world.pose(handle)->position;
  for (int frame = 0; frame < 3600; ++frame) {
    const Vector3 goal = pointer.next();
    fastest = std::max(fastest, 60.0 * (goal - before).norm());
    before = goal;
    ASSERT_TRUE(world.set_motion(handle, {.position = goal}).empty());
    const LiveReport report = world.step();
    if (!report.ok()) {
      const std::string& why = report.divergence->message;
      ASSERT_NE(why.find("has reached the wheel"), std::string::npos) << frame << ": " << why;
      ++ends;
      world = make();
      handle = *world.body("hand");
      pointer.go_home();
      before = world.pose(handle)->position;
      continue;
    }
    const Energy energy = world.energy();
    ASSERT_TRUE(std::isfinite(energy.total())) << frame;
    most = std::max(most, energy.kinetic);
    for (const CableReport& rope : world.simulation().cable_reports()) {
      stretch = std::max(stretch, rope.max_stretch);
    }
  }
  // However the strands lie, nothing goes faster than the rope, and that no faster than the pointer
  // has ever gone: the block with its sheaves, 8 kg, and the rims of four wheels, 0.1 kg each.
  EXPECT_LT(most, 0.5 * (8.0 + 4.0 * 0.1) * fastest * fastest) << stretch;
  EXPECT_LT(stretch, 1e-8) << most;
  // Of 40 jumps, half or less draw the block to the beam.
  EXPECT_LE(ends, 20);
}

}  // namespace
}  // namespace sheave
