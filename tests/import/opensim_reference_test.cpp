// Bodies, lengths and moment arms of OpenSim models against a computation that shares no code with
// the import (dev/opensim-reference): frames as 4 x 4 matrices, wraps by minimisation.

#include <map>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "statics/joint_space.h"
#include "tests/import/model_files.h"
#include "tests/import/opensim_files.h"

namespace sheave {
namespace {

using nlohmann::json;

class OpenSimReference : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
    text = test::opensim_text(std::string(GetParam()) + ".osim");
    reference = test::references(std::string(GetParam()) + "-osim");
  }

  /// The scene at the coordinates of a pose.
  [[nodiscard]] Scene scene_in(const json& pose) const {
    const auto values = pose["coordinates"].get<std::map<std::string, double>>();
    return test::opensim_scene(test::with_coordinates(text, values));
  }

  std::string text;
  json reference;
};

// Some 10 products of matrices whose elements are at most 1 m, each rounded once.
TEST_P(OpenSimReference, BodiesAreInTheSamePlaces) {
  std::size_t compared = 0;
  for (const json& pose : reference["poses"]) {
    if (!pose.contains("bodies")) continue;
    const Scene scene = scene_in(pose);
    for (const auto& body : scene.model.bodies) {
      if (!pose["bodies"].contains(body.name)) continue;
      const std::vector<double> rows = test::numbers(pose["bodies"][body.name]);
      Matrix3 turn;
      Vector3 position;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) turn(i, k) = rows[static_cast<std::size_t>(4 * i + k)];
        position[i] = rows[static_cast<std::size_t>(4 * i + 3)];
      }
      EXPECT_LT((body.position - position).norm(), 1e-12) << body.name << pose["coordinates"];
      EXPECT_LT((body.orientation.toRotationMatrix() - turn).norm(), 1e-12) << body.name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 40U);
}

// Straight paths are exact but for rounding, 1e-8 with room; the references have 11 decimals. Wraps
// are minima that the reference finds to the square root of the rounding in its angles, which is
// rounding in the lengths.
TEST_P(OpenSimReference, PathsHaveTheSameLengths) {
  std::size_t compared = 0;
  std::size_t wrapped = 0;
  for (const json& pose : reference["poses"]) {
    Scene scene = scene_in(pose);
    Result<Simulation> simulation = create_simulation(scene);
    ASSERT_TRUE(simulation) << simulation.errors().front().message;
    Result<JointSpace> space = JointSpace::create(*simulation);
    ASSERT_TRUE(space) << space.errors().front().message;
    const ModalVector lengths = space->cable_arms().lengths;
    for (std::size_t i = 0; i < scene.cables.size(); ++i) {
      const std::string& name = scene.cables[i].name;
      if (!pose["lengths"].contains(name)) continue;
      const bool over = test::touches_surface(scene.cables[i]);
      EXPECT_NEAR(lengths[static_cast<Eigen::Index>(i)], pose["lengths"][name].get<double>(),
                  over ? 1e-6 : 1e-8)
          << name << " " << pose["coordinates"];
      ++compared;
      if (over) ++wrapped;
    }
  }
  EXPECT_GE(compared, 600U);
  EXPECT_GE(wrapped, 100U);
}

// Differences of fourth order with a step of 1e-4 have an error of 1e-16 of the fifth derivative,
// and lengths that are known to 1e-15 m add 1e-11 m.
TEST_P(OpenSimReference, MomentArmsAreTheDerivativesOfLengths) {
  // Other coordinates have another meaning here, or move joints that follow.
  const std::vector<std::string> own{"r_shoulder_elev", "r_elbow_flex", "swing", "flex", "deviate"};
  std::size_t compared = 0;
  for (const json& pose : reference["poses"]) {
    if (!pose.contains("arms")) continue;
    Scene scene = scene_in(pose);
    Result<Simulation> simulation = create_simulation(scene);
    ASSERT_TRUE(simulation) << simulation.errors().front().message;
    Result<JointSpace> space = JointSpace::create(*simulation);
    ASSERT_TRUE(space) << space.errors().front().message;
    const ModalMatrix arms = space->cable_arms().arms;
    for (std::size_t c = 0; c < space->coordinates().size(); ++c) {
      const std::string& coordinate = space->coordinates()[c].name;
      for (const std::string& name : own) {
        const bool is_own = coordinate == name + ".angle" || coordinate == name + ".travel" ||
                            (coordinate == "flex deviate.angle_a" && name == "flex") ||
                            (coordinate == "flex deviate.angle_b" && name == "deviate");
        if (!is_own) continue;
        for (std::size_t i = 0; i < scene.cables.size(); ++i) {
          const std::string& cable = scene.cables[i].name;
          if (!pose["arms"].contains(cable)) continue;
          const json& of = pose["arms"][cable];
          EXPECT_NEAR(arms(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)),
                      of[name].get<double>(), 1e-8)
              << cable << " at " << name << pose["coordinates"];
          ++compared;
        }
      }
    }
  }
  EXPECT_GE(compared, 100U);
}

INSTANTIATE_TEST_SUITE_P(Models, OpenSimReference, testing::Values("arm26", "joints"));

}  // namespace
}  // namespace sheave
