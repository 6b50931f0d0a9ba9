#pragma once
// A force that grows with time, for tests.

#include <gtest/gtest.h>

#include "engine/instants.h"
#include "engine/world.h"

namespace sheave::test {

/// Draws a body with c t at its centre, in each part of the motion with the mean.
class GrowingForce final : public StepActor {
 public:
  /// `slope`: c [N/s].
  GrowingForce(World& world, BodyId body, const Vector3& slope)
      : world_(world), body_(body), slope_(slope) {}
  void act(bool begins) override {
    const StepSettings& step = world_.model().step;
    const double now = world_.state().time;
    if (begins) end_ = now + step.dt / step.substeps;
    force_.force = 0.5 * (now + end_) * slope_;
    EXPECT_TRUE(world_.set_force(body_, force_).empty());
  }
  void set_loads_now(Controls& controls) override {
    ForceControl now = *controls.forces.find(body_.index);
    now.force = world_.state().time * slope_;
    controls.forces.put(body_.index, 1, now);
  }

 private:
  World& world_;
  BodyId body_;
  Vector3 slope_;
  double end_ = 0.0;  // of the substep
  PointForce force_;
};

}  // namespace sheave::test
