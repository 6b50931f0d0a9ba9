// Places relative to bodies, and turns in degrees.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave {
namespace {

using testing::HasSubstr;

SceneResult placed_scene(const std::string& bodies, const std::string& joints = "") {
  return load_scene_text(R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
"bodies": [)" + bodies + "], \"joints\": [" +
                             joints + "]}",
                         "scene.json");
}

/// Rounding of a few products of numbers below 10.
constexpr double rounding = 1e-14;

const std::string post = R"({"name": "post", "mobility": "static", "position": [1, 2, 0],
 "rotation": {"axis": [0, 0, 2], "degrees": 90}})";

TEST(ScenePlacement, RotationIsATurnInDegrees) {
  const SceneResult scene = placed_scene(post);
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  const Quaternion wanted(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5));
  EXPECT_LT(scene->model.bodies[0].orientation.angularDistance(wanted), rounding);
}

TEST(ScenePlacement, FramesFollowEachOther) {
  // "tip" is told before what it is relative to.
  const SceneResult scene = placed_scene(
      R"({"name": "tip", "relative_to": "arm", "position": [2, 0, 0], "mobility": "slider",
          "axis": [1, 0, 0], "mass": 1, "shape": {"type": "sphere", "radius": 0.1}},
         {"name": "arm", "relative_to": "post", "position": [3, 0, 0], "mass": 1,
          "rotation": {"degrees": 90}, "shape": {"type": "sphere", "radius": 0.1}},)" +
      post);
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  // The post looks up, the arm to the left.
  EXPECT_LT((scene->model.bodies[1].position - Vector3(1.0, 5.0, 0.0)).norm(), rounding);
  EXPECT_LT((scene->model.bodies[0].position - Vector3(-1.0, 5.0, 0.0)).norm(), rounding);
  EXPECT_LT((*scene->model.bodies[0].axis - Vector3(-1.0, 0.0, 0.0)).norm(), rounding);
  const SceneResult again = load_scene_text(write_scene(*scene), "again.json");
  ASSERT_TRUE(again) << to_string(again.errors.front());
  EXPECT_EQ(write_scene(*again), write_scene(*scene));
  EXPECT_EQ(again->model.bodies[0].position, scene->model.bodies[0].position);
}

TEST(ScenePlacement, JointsHavePointsAndDirectionsOfABody) {
  const SceneResult scene = placed_scene(
      post + R"(, {"name": "door", "relative_to": "post", "position": [1, 0, 0], "mass": 1,
                         "shape": {"type": "sphere", "radius": 0.1}})",
      R"({"type": "hinge", "name": "pin", "relative_to": "post", "body_a": "post",
                 "body_b": "door", "anchor": [0.5, 0, 0], "axis": [1, 0, 0]})");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  const auto* hinge = static_cast<const HingeJoint*>(scene->model.joints[0]->settings());
  EXPECT_LT((hinge->anchor - Vector3(1.0, 2.5, 0.0)).norm(), rounding);
  EXPECT_LT((hinge->axis - Vector3(0.0, 1.0, 0.0)).norm(), rounding);
}

TEST(ScenePlacement, ShapesTurnToo) {
  const SceneResult scene =
      placed_scene(R"({"name": "a", "mass": 1, "shape": {"type": "box", "size": [1, 2, 3],
                "rotation": {"axis": [1, 0, 0], "degrees": 180}}})");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  const Quaternion wanted(0.0, 1.0, 0.0, 0.0);
  EXPECT_LT(scene->model.bodies[0].shapes[0].orientation.angularDistance(wanted), rounding);
}

TEST(ScenePlacement, FaultsAreLocated) {
  const std::string ball = R"("mass": 1, "shape": {"type": "sphere", "radius": 0.1}})";
  const auto refused = [&](const std::string& bodies, const char* pointer, const char* message) {
    const SceneResult scene = placed_scene(bodies);
    ASSERT_FALSE(scene) << bodies;
    EXPECT_EQ(scene.errors.front().pointer, pointer) << bodies;
    EXPECT_THAT(to_string(scene.errors.front()), HasSubstr(message));
    EXPECT_GT(scene.errors.front().line, 0);
  };
  refused(R"({"name": "a", "relative_to": "b", )" + ball, "/bodies/0/relative_to", "b");
  refused(R"({"name": "a", "relative_to": "a", )" + ball, "/bodies/0/relative_to",
          "in a circle: \"a\" to \"a\"");
  refused(R"({"name": "a", "relative_to": "b", )" + ball +
              R"(, {"name": "b", "relative_to": "c", )" + ball +
              R"(, {"name": "c", "relative_to": "a", )" + ball,
          "/bodies/2/relative_to", "in a circle: \"a\" to \"b\" to \"c\" to \"a\"");
  refused(R"({"name": "a", "rotation": {"axis": [0, 0, 0], "degrees": 3}, )" + ball,
          "/bodies/0/rotation/axis", "length 0");
  refused(R"({"name": "a", "rotation": {"axis": [0, 0, 1]}, )" + ball, "/bodies/0/rotation/degrees",
          "required key is missing");
  refused(R"({"name": "a", "orientation": [1, 0, 0, 0], "rotation": {"degrees": 3}, )" + ball,
          "/bodies/0/rotation", "exclude each other");
  refused(R"({"name": "a", "rotation": 90, )" + ball, "/bodies/0/rotation", "must be an object");
}

}  // namespace
}  // namespace sheave
