// Machines put into poses by the coordinates of their joints.

#include "statics/place_joints.h"

#include <cmath>

#include "tests/statics/robot_scenes.h"

namespace sheave {
namespace {

using testing::four_bar;
using testing::names;
using testing::place;
using testing::positions;
using testing::rates;
using testing::robot;
using testing::turn;
using testing::two_links;

/// Newton's method ends where a correction is below 1e-12 of the scene's size; at most a tenth is left.
constexpr double settled = 1e-12;

TEST(PlaceJoints, BodiesFollowByForwardKinematics) {
  LiveWorld world = robot(two_links("free"));
  place(world, {{"shoulder", 2.9}, {"elbow", -1.2}});
  const Vector3 tip = *world.point(*world.body("lower"), Vector3(0.5, 0, 0));
  const Vector3 wanted(std::cos(2.9) + 0.8 * std::cos(1.7), std::sin(2.9) + 0.8 * std::sin(1.7), 0);
  EXPECT_LT((tip - wanted).norm(), settled);
}

TEST(PlaceJoints, AnglesCountWholeTurns) {
  LiveWorld world = robot(two_links("planar"));
  place(world, {{"shoulder", 20.0}});
  EXPECT_NEAR(positions(world)[0], 20.0, settled);
  place(world, {{"shoulder", -9.0}});
  EXPECT_NEAR(positions(world)[0], -9.0, settled);
}

TEST(PlaceJoints, OtherCoordinatesAndAllRatesStay) {
  LiveWorld world = robot(two_links("free"));
  place(world, {{"elbow", 0.8}});
  turn(world, {{"shoulder", 1.5}, {"elbow", -0.7}});
  place(world, {{"shoulder", 1.0}});
  EXPECT_NEAR(positions(world)[1], 0.8, settled);
  EXPECT_NEAR(rates(world)[0], 1.5, 1e-12);
  EXPECT_NEAR(rates(world)[1], -0.7, 1e-12);
}

TEST(PlaceJoints, LoopsAreClosed) {
  LiveWorld world = robot(four_bar);
  place(world, {{"a", -1.1}});
  const Vector3 crank = *world.point(*world.body("crank"), Vector3(0, 0.2, 0));
  const Vector3 rocker = *world.point(*world.body("rocker"), Vector3(0, 0.5, 0));
  EXPECT_NEAR((crank - rocker).norm(), std::sqrt(1.36), settled);
  EXPECT_NEAR((rocker - Vector3(1, 0, 0)).norm(), 1.0, settled);
  EXPECT_NEAR((crank - Vector3(0.4 * std::sin(1.1), 0.4 * std::cos(1.1), 0)).norm(), 0.0, settled);
}

TEST(PlaceJoints, AJointThatDependsOnOthersCanBeNamed) {
  LiveWorld world = robot(four_bar);
  place(world, {{"d", -0.2}});
  const Vector3 rocker = *world.point(*world.body("rocker"), Vector3(0, 0.5, 0));
  EXPECT_LT((rocker - Vector3(1.0 + std::sin(0.2), std::cos(0.2), 0)).norm(), settled);
}

TEST(PlaceJoints, LoopsThatCannotCloseAreToldWithTheResidual) {
  LiveWorld world = robot(four_bar);
  const std::uint64_t before = hash(world.state());
  // The crank reaches 0.4 m and the coupler 1.166 m, so the rocker cannot turn by 1.5 rad.
  for (const std::vector<CoordinateTarget>& targets :
       {std::vector<CoordinateTarget>{{"d", -1.5}}, {{"a", 0.5}, {"d", 0.4}}}) {
    const Result<Placement> placed = place_joints(world, targets, Keep::length);
    ASSERT_FALSE(placed);
    const std::string& message = placed.errors().front().message;
    EXPECT_NE(message.find("cannot be closed: a residual of"), std::string::npos) << message;
    EXPECT_EQ(hash(world.state()), before);
  }
}

TEST(PlaceJoints, WrongNamesAndValuesAreRefused) {
  LiveWorld world = robot(two_links("planar"));
  const auto message = [&](const std::vector<CoordinateTarget>& targets) {
    const Result<Placement> placed = place_joints(world, targets, Keep::length);
    return placed ? std::string() : placed.errors().front().message;
  };
  EXPECT_EQ(
      message({{"knee", 1.0}}).find("there is no coordinate \"knee\"; there are: shoulder.angle"),
      0U);
  EXPECT_NE(message({{"elbow", std::nan("")}}).find("must be a number within 1000 rad of 0"),
            std::string::npos);
  EXPECT_NE(message({{"elbow", 1e6}}).find("was 1e+06"), std::string::npos);
  EXPECT_NE(message({{"elbow", 1.0}, {"elbow.angle", 1.0}}).find("has two values"),
            std::string::npos);
  EXPECT_FALSE(set_joint_rates(world, {{"knee", 1.0}}).empty());
  EXPECT_FALSE(set_joint_rates(world, {{"elbow", std::nan("")}}).empty());
}

/// A weight on an arm of 1 m, on a rope from a point above.
std::string hung_arm(const std::string& rope) {
  return R"("step": {"dt": 1e-5, "substeps": 1}, "bodies": [{"name": "arm", "mobility": "planar", "mass": 2, "inertia": [1, 1, 0.2], "position": [1, 0, 0]}],
    "joints": [{"type": "hinge", "name": "pin", "body_b": "arm", "anchor": [0, 0, 0], "axis": [0, 0, 1]}],
    "cables": [{"name": "rope", )" +
         rope + R"("links": [{"type": "attachment", "body": "world", "point": [0, 2, 0]},
      {"type": "attachment", "body": "arm"}]}])";
}

TEST(PlaceJoints, CablesKeepTheirLengthOrTheirTension) {
  const double longer = std::sqrt(1.0 + 4.0 + 4.0 * std::sin(0.3)) - std::sqrt(5.0);
  LiveWorld kept = robot(hung_arm(R"("compliance": 1e-4, )"));
  const CableHandle rope = *kept.cable("rope");
  place(kept, {{"pin", -0.3}}, Keep::length);
  EXPECT_NEAR(*kept.rest_length(rope, 0), std::sqrt(5.0), 1e-10);
  ASSERT_TRUE(kept.step().ok());
  EXPECT_GT(*kept.tension(rope, 0), 0.9 * longer / 1e-4);

  LiveWorld made = robot(hung_arm(""));
  const Result<Placement> placed = place_joints(made, {{"pin", -0.3}}, Keep::tension);
  ASSERT_TRUE(placed);
  ASSERT_EQ(placed->cables.size(), 1U);
  EXPECT_NEAR(placed->cables[0].added, longer, 1e-10);
  EXPECT_NEAR(*made.rest_length(*made.cable("rope"), 0), std::sqrt(5.0) + longer, 1e-10);

  // A rigid rope that is too short is told, and nothing changes.
  LiveWorld rigid = robot(hung_arm(""));
  const std::uint64_t before = hash(rigid.state());
  const Result<Placement> refused = place_joints(rigid, {{"pin", -0.3}}, Keep::length);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.errors().front().message.find("too short"), std::string::npos);
  EXPECT_EQ(hash(rigid.state()), before);
}

TEST(PlaceJoints, FloatingBasesTurnToTheirRotationVectors) {
  LiveWorld world = robot(R"("bodies": [
    {"name": "base", "mass": 2, "inertia": [0.1, 0.2, 0.3]},
    {"name": "arm", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0.5, 0, 0]}],
    "joints": [{"type": "hinge", "name": "pin", "body_a": "base", "body_b": "arm", "anchor": [0, 0, 0], "axis": [0, 0, 1]}])",
                          "[0,0,0]");
  EXPECT_EQ(names(world).size(), 7U);
  place(world, {{"base.x", 0.4}, {"base.turn_x", 0.9}, {"base.turn_y", -1.3}, {"pin", 0.5}});
  const Vector3 vector(0.9, -1.3, 0.0);
  const BodyPose base = *world.pose(*world.body("base"));
  EXPECT_NEAR(base.position.x(), 0.4, settled);
  EXPECT_LT((base.orientation * rotation_by(vector).conjugate()).vec().norm(), settled);
  const BodyPose arm = *world.pose(*world.body("arm"));
  const Quaternion wanted = rotation_by(vector) * rotation_by(Vector3(0, 0, 0.5));
  EXPECT_LT((arm.orientation * wanted.conjugate()).vec().norm(), settled);
}

}  // namespace
}  // namespace sheave
