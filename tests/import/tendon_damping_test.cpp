// The damper of a tendon resists the rate of its whole length.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {
namespace {

TEST(TendonDamping, IsThatOfTheWholeLengthWhateverTheSpans) {
  // 1 kg below a site; spans of 0.9 m and 0.3 m. With the travel q upwards
  //   q'' + 20 q' + 200 q = 200 (1.2 - 1) - 9.81.
  const std::string model = R"(<mujoco><option gravity="0 0 -9.81" timestep="0.0005"/>
    <worldbody><site name="s0"/><site name="s1" pos="0.9 0 0"/>
      <body name="m" pos="0.9 0 -0.3"><joint name="z" type="slide" axis="0 0 1"/>
        <geom type="sphere" size="0.05" mass="1"/><site name="s2"/></body></worldbody>
    <tendon><spatial name="t" stiffness="200" damping="20" springlength="1.0">
      <site site="s0"/><site site="s1"/><site site="s2"/></spatial></tendon></mujoco>)";
  const SceneResult scene = load_scene_text(model, "model.xml");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  Result<Simulation> simulation = create_simulation(*scene);
  ASSERT_TRUE(simulation);
  const double rest = 0.2 - 9.81 / 200.0;
  for (int k = 1; k <= 600; ++k) {
    ASSERT_TRUE(simulation->step().ok());
    const double t = 0.0005 * k;
    const double q = rest * (1.0 - std::exp(-10.0 * t) * (std::cos(10.0 * t) + std::sin(10.0 * t)));
    // The scheme is of second order: (h w)^2 / 12 of the motion, with h w = 0.007.
    ASSERT_NEAR(simulation->world.position(BodyId{0}).z(), -0.3 + q, 1e-5) << t;
  }
}

}  // namespace
}  // namespace sheave::test
