// What is drawn for joints, and that it goes with the bodies.

#include "render/joint_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/shapes/box.h"
#include "render/renderer.h"
#include "render/view_builder.h"
#include "render/view_survey.h"
#include "tests/support/builders.h"

namespace sheave::render {
namespace {

constexpr double unit = 0.01;

/// One joint between the world and a box of 1 x 0.1 x 0.06 m, its long side along x, in
/// weightlessness.
class JointPicture : public testing::Test {
 protected:
  World world(const std::shared_ptr<JointDef>& joint, const Vector3& velocity = Vector3::Zero()) {
    Model model;
    model.step = test::settings(0.01, 1, 20);
    BodyDef body;
    body.name = "bar";
    body.mass = 1.0;
    body.velocity = velocity;
    auto box = std::make_shared<Box>();
    box->size = {1.0, 0.1, 0.06};
    body.shapes.push_back({box});
    joint->name = "joint";
    joint->body_b = model.add(body);
    model.joints.push_back(joint);
    return test::start(model);
  }
  static DrawList draw(const World& world) {
    DrawList list;
    add_joints(make_joint_view(world, unit), world, list);
    EXPECT_TRUE(validate(list).empty());
    return list;
  }
  static std::shared_ptr<DistanceJoint> line(DistanceLimit limit) {
    auto joint = std::make_shared<DistanceJoint>();
    joint->limit = limit;
    joint->anchor_a = {0.0, 2.0, 0.0};
    return joint;
  }
  static double length(const Tube& tube) {
    double sum = 0.0;
    for (std::size_t i = 1; i < tube.points.size(); ++i) {
      sum += (tube.points[i].position - tube.points[i - 1].position).norm();
    }
    return sum;
  }
};

TEST_F(JointPicture, AHingeIsAPinThatStandsOutOnBothSides) {
  auto joint = std::make_shared<HingeJoint>();
  joint->anchor = {0.4, 0.0, 0.0};
  const DrawList list = draw(world(joint));
  ASSERT_EQ(list.solids.size(), 1U);
  const auto* pin = std::get_if<CylinderShape>(&list.solids[0].shape);
  ASSERT_NE(pin, nullptr);
  // Half the thickness across the axis is 0.05 m, so the limit by the scene's size, 2.5 units,
  // decides.
  EXPECT_DOUBLE_EQ(pin->radius, 0.025);
  EXPECT_DOUBLE_EQ(pin->length, 0.06 + 2.0 * pin->radius);
  EXPECT_LT((list.solids[0].position - joint->anchor).norm(), 1e-12);
}

TEST_F(JointPicture, APinThroughASlenderBodyIsThinnerThanIt) {
  auto joint = std::make_shared<HingeJoint>();
  joint->axis = Vector3::UnitY();
  const DrawList list = draw(world(joint));
  // Across y the bar is 0.06 m thick.
  EXPECT_NEAR(std::get<CylinderShape>(list.solids.at(0).shape).radius, 0.6 * 0.03, 1e-12);
}

TEST_F(JointPicture, DistantBodiesDoNotLengthenAPin) {
  auto joint = std::make_shared<HingeJoint>();
  joint->anchor = {0.0, 0.0, 5.0};
  const DrawList list = draw(world(joint));
  EXPECT_LT(std::get<CylinderShape>(list.solids.at(0).shape).length, 0.11);
}

TEST_F(JointPicture, ABallAndACross) {
  auto ball = std::make_shared<BallJoint>();
  ball->anchor = {0.5, 0.0, 0.0};
  const DrawList list = draw(world(ball));
  ASSERT_EQ(list.solids.size(), 1U);
  EXPECT_NEAR(std::get<SphereShape>(list.solids[0].shape).radius, 0.03, 1e-12) << "3 units at most";
  EXPECT_EQ(draw(world(std::make_shared<UniversalJoint>())).solids.size(), 2U);
}

TEST_F(JointPicture, AWeldIsNotDrawn) {
  const DrawList list = draw(world(std::make_shared<FixedJoint>()));
  EXPECT_TRUE(list.solids.empty());
  EXPECT_TRUE(list.tubes.empty());
}

TEST_F(JointPicture, ARodReachesFromAnchorToAnchor) {
  const DrawList list = draw(world(line(DistanceLimit::exactly)));
  ASSERT_EQ(list.tubes.size(), 1U);
  EXPECT_EQ(list.tubes[0].points.front().position, Vector3(0.0, 2.0, 0.0));
  EXPECT_EQ(list.tubes[0].points.back().position, Vector3(0.0, 0.0, 0.0));
  EXPECT_EQ(list.tubes[0].radius, unit);
}

TEST_F(JointPicture, ASlackStringHangs) {
  auto joint = line(DistanceLimit::at_most);
  joint->length = 2.5;
  const DrawList slack = draw(world(joint));
  ASSERT_EQ(slack.tubes.size(), 1U);
  // 24 points on the catenary: chords are a little shorter than arcs.
  EXPECT_NEAR(length(slack.tubes[0]), 2.5, 0.02);
  EXPECT_LE(length(slack.tubes[0]), 2.5);
  joint->length = 2.0;
  EXPECT_NEAR(length(draw(world(joint)).tubes.at(0)), 2.0, 1e-12);
}

TEST_F(JointPicture, ASpringStretchesWithItsEnds) {
  auto joint = line(DistanceLimit::exactly);
  joint->compliance = 1.0;
  World moving = world(joint, {0.0, -1.0, 0.0});
  const JointView view = make_joint_view(moving, unit);
  DrawList before;
  add_joints(view, moving, before);
  test::run(moving, 0.5);
  DrawList after;
  add_joints(view, moving, after);
  ASSERT_EQ(before.tubes.size(), 1U);
  EXPECT_GT(before.tubes[0].points.size(), 100U) << "coils";
  EXPECT_EQ(before.tubes[0].points.size(), after.tubes.at(0).points.size()) << "as many as before";
  EXPECT_EQ(before.tubes[0].radius, after.tubes[0].radius);
  EXPECT_LT((after.tubes[0].points.back().position - moving.position({0})).norm(), 1e-12);
  EXPECT_LT(after.tubes[0].points.back().position.y(), -0.3);
}

TEST_F(JointPicture, AnActuatorIsATelescope) {
  auto joint = line(DistanceLimit::none);
  joint->damping = 1.0;
  World moving = world(joint, {0.0, -1.0, 0.0});
  const JointView view = make_joint_view(moving, unit);
  DrawList before;
  add_joints(view, moving, before);
  ASSERT_EQ(before.tubes.size(), 2U);
  EXPECT_GT(before.tubes[0].radius, before.tubes[1].radius) << "a rod in a sleeve";
  test::run(moving, 0.2);
  DrawList after;
  add_joints(view, moving, after);
  EXPECT_NEAR(length(after.tubes[0]), length(before.tubes[0]), 1e-12) << "the sleeve stays";
  EXPECT_GT(length(after.tubes[1]), length(before.tubes[1]) + 0.1) << "the rod comes out";
}

TEST_F(JointPicture, ABumperEndsAtItsLength) {
  auto joint = line(DistanceLimit::at_least);
  joint->length = 1.5;
  const DrawList list = draw(world(joint));
  EXPECT_NEAR(length(list.tubes.at(1)), 1.5, 1e-12);
}

TEST_F(JointPicture, ARailReachesAsFarAsTheBodyCanTravel) {
  auto joint = std::make_shared<SliderJoint>();
  joint->axis = Vector3::UnitX();
  joint->travel.lower = -0.5;
  joint->travel.upper = 2.0;
  const DrawList list = draw(world(joint));
  ASSERT_EQ(list.tubes.size(), 1U);
  EXPECT_NEAR(list.tubes[0].points[0].position.x(), -0.5 - 0.5, 1e-12);
  EXPECT_NEAR(list.tubes[0].points[1].position.x(), 2.0 + 0.5, 1e-12);
}

TEST_F(JointPicture, ARailWithoutStopsReachesAsFarAsTheRun) {
  auto joint = std::make_shared<SliderJoint>();
  joint->axis = Vector3::UnitX();
  joint->travel.lower = -0.25;
  World moving = world(joint, {2.0, 0.0, 0.0});
  std::vector<JointTravel> travels;
  extend_travels(moving, travels);
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(moving.step().ok());
    extend_travels(moving, travels);
  }
  ASSERT_EQ(travels.size(), 1U);
  EXPECT_NEAR(travels[0].lower, 0.0, 1e-9);
  EXPECT_NEAR(travels[0].upper, 1.0, 1e-9);  // 2 m/s for 0.5 s
  const World start = world(joint);
  DrawList list;
  add_joints(make_joint_view(start, unit, travels), start, list);
  ASSERT_EQ(list.tubes.size(), 1U);
  // The stop on one side; the end of the way, and four units more, on the other.
  EXPECT_NEAR(list.tubes[0].points[0].position.x(), -0.25 - 0.5, 1e-12);
  EXPECT_NEAR(list.tubes[0].points[1].position.x(), 1.0 + 4.0 * unit + 0.5, 1e-9);
}

TEST_F(JointPicture, TheRailBelongsToTheBodyThatStands) {
  // The bar is body_a and moves along -x against the world, which its own travel counts as
  // positive.
  Model model;
  BodyDef body;
  body.name = "bar";
  body.mass = 1.0;
  body.velocity = {-1.0, 0.0, 0.0};
  auto box = std::make_shared<Box>();
  box->size = {1.0, 0.1, 0.06};
  body.shapes.push_back({box});
  auto joint = std::make_shared<SliderJoint>();
  joint->name = "joint";
  joint->body_a = model.add(body);
  joint->body_b = BodyId::world();
  joint->axis = Vector3::UnitX();
  joint->travel.lower = 0.0;
  joint->travel.upper = 2.0;
  model.joints.push_back(joint);
  World moving = test::start(model);
  const JointView view = make_joint_view(moving, unit);
  test::run(moving, 1.0);
  EXPECT_LT(moving.position({0}).x(), -0.99);
  DrawList list;
  add_joints(view, moving, list);
  ASSERT_EQ(list.tubes.size(), 1U);
  EXPECT_NEAR(list.tubes[0].points[0].position.x(), -2.0 - 0.5, 1e-12);
  EXPECT_NEAR(list.tubes[0].points[1].position.x(), 0.5, 1e-12);
}

TEST_F(JointPicture, ABrokenJointIsGone) {
  auto joint = line(DistanceLimit::at_most);
  joint->breaking_force = 1.0;
  World breaking = world(joint, {0.0, -5.0, 0.0});
  const JointView view = make_joint_view(breaking, unit);
  DrawList before;
  add_joints(view, breaking, before);
  EXPECT_FALSE(before.tubes.empty());
  test::run(breaking, 0.1);
  DrawList after;
  add_joints(view, breaking, after);
  EXPECT_TRUE(after.tubes.empty());
  EXPECT_TRUE(after.solids.empty());
}

TEST_F(JointPicture, IsPartOfTheViewAndOfItsFrame) {
  const World still = world(line(DistanceLimit::exactly));
  const DrawList list = ViewBuilder(still, {}).build(still, {});
  EXPECT_EQ(list.tubes.size(), 1U);
  ViewSurvey survey;
  survey.add(still, {});
  EXPECT_GE(survey.bounds().max().y(), 2.0) << "the anchor is above everything else";
}

TEST_F(JointPicture, ChangesNothing) {
  World moving = world(line(DistanceLimit::none), {0.0, -1.0, 0.0});
  const std::uint64_t before = hash(moving.state());
  EXPECT_FALSE(draw(moving).tubes.empty());
  EXPECT_EQ(hash(moving.state()), before);
}

TEST(MotionPlaneOfHinges, IsUsedWithoutAnotherPlane) {
  Model model;
  model.add(test::lump("arm", Vector3::Zero(), 1.0));
  EXPECT_FALSE(motion_plane(model, {}));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->body_b = BodyId{0};
  hinge->axis = {0.0, -2.0, 0.0};
  model.joints.push_back(hinge);
  ASSERT_TRUE(motion_plane(model, {}));
  EXPECT_EQ(*motion_plane(model, {}), Vector3::UnitY());
}

}  // namespace
}  // namespace sheave::render
