// Every joint row and every contact row against finite differences.
//
// Tolerance. Row terms are derivatives at the substep's current positions, so differences must
// agree to their own accuracy: five-point differences with step 1e-3 leave about h^4/30 = 3e-14 of
// truncation and eps/h = 2e-13 of rounding, 1e-10 with a margin; the requirement is 1e-6.
//
// The exception are rows that see a mounted rotor whose carrier has turned by a finite angle T
// during the substep. The rotor's spin is a quasi-coordinate (its rate is a.w, and no function of
// the pose has a.w as its rate), so Row::value there depends on the path by O(T^2) and its
// differences by O(T), while the terms are exact for rates. That is checked as an order in T.

#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/math/turn_between.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"
#include "tests/support/gradient_check.h"

namespace sheave {
namespace {

constexpr double tolerance = 1e-9;

Quaternion general_orientation(double angle) {
  return Quaternion(rotation_by(angle * Vector3(0.4, -0.7, 0.3)));
}

/// Bodies in general position: 0 and 1 free, 2 a rotor mounted on 0, 3 a rotor mounted on 1, 4 a
/// rotor on a fixed axle, 5 planar, 6 a slider.
Model general_bodies() {
  Model model;
  BodyDef a = test::lump("a", {0.1, 0.2, -0.1}, 2.0);
  a.orientation = general_orientation(0.8);
  a.angular_velocity = {0.3, -0.4, 0.5};
  BodyDef b = test::lump("b", {1.2, -0.3, 0.4}, 1.0);
  b.orientation = general_orientation(-1.3);
  b.velocity = {-0.2, 0.1, 0.7};
  model.add(a);
  model.add(b);
  BodyDef rotor_a = test::sheave("rotor a", {0}, {0.5, 0.6, -0.2}, 0.2, 0.5, 0.02);
  rotor_a.axis = Vector3(1.0, 2.0, -0.5);
  rotor_a.orientation = turn_between(Vector3::UnitZ(), rotor_a.axis->normalized());
  BodyDef rotor_b = test::sheave("rotor b", {1}, {1.0, 0.4, 0.7}, 0.2, 0.5, 0.02);
  rotor_b.axis = Vector3(-0.3, 0.6, 2.0);
  rotor_b.orientation = turn_between(Vector3::UnitZ(), rotor_b.axis->normalized());
  model.add(rotor_a);
  model.add(rotor_b);
  BodyDef rotor = test::wheel("rotor", {-0.4, 0.3, 0.2}, 0.3, 0.04);
  rotor.axis = Vector3(0.2, -1.0, 0.4);
  rotor.orientation = turn_between(Vector3::UnitZ(), rotor.axis->normalized());
  model.add(rotor);
  BodyDef flat = test::lump("flat", {0.3, -0.8, 0.1}, 1.5);
  flat.mobility = Mobility::planar;
  flat.axis = Vector3(0.5, 0.2, 1.0);
  model.add(flat);
  BodyDef slider = test::weight("slider", {-0.6, -0.5, 0.3}, 1.0);
  slider.axis = Vector3(0.3, 1.0, -0.6);
  model.add(slider);
  return model;
}

/// What makes a coordinate's gradient show: a spring, whose row has the coordinate as its value.
JointCoordinate with_spring() {
  JointCoordinate coordinate;
  coordinate.stiffness = 2.0;
  coordinate.rest = 0.1;
  return coordinate;
}

const Vector3 joint_place{0.45, 0.15, 0.25};
const Vector3 joint_direction{0.6, -0.3, 1.0};

void configure(DistanceJoint& joint) {
  joint.anchor_a = joint_place;
  joint.anchor_b = joint_place + Vector3(0.6, -0.2, 0.9);
  joint.extension = with_spring();
}
void configure(BallJoint& joint) {
  joint.anchor = joint_place;
  joint.axis = joint_direction;
  joint.swing_limit = 0.2;
  joint.twist = with_spring();
}
void configure(HingeJoint& joint) {
  joint.anchor = joint_place;
  joint.axis = joint_direction;
  joint.angle = with_spring();
}
void configure(SliderJoint& joint) {
  joint.anchor = joint_place;
  joint.axis = joint_direction;
  joint.travel = with_spring();
}
void configure(CylindricalJoint& joint) {
  joint.anchor = joint_place;
  joint.axis = joint_direction;
  joint.travel = with_spring();
  joint.angle = with_spring();
}
void configure(UniversalJoint& joint) {
  joint.anchor = joint_place;
  joint.axis_a = joint_direction;
  joint.axis_b = joint_direction.cross(Vector3(0.1, 0.7, 0.4));
  joint.angle_a = with_spring();
  joint.angle_b = with_spring();
}
void configure(PlaneJoint& joint) {
  joint.anchor = joint_place;
  joint.normal = joint_direction;
  joint.angle = with_spring();
}
void configure(FixedJoint& joint) { joint.anchor = joint_place; }
void configure(GearJoint& joint) {
  joint.axis_a = joint_direction;
  joint.axis_b = Vector3(-0.2, 0.9, 0.4);
  joint.ratio = -1.7;
}
void configure(RackJoint& joint) {
  joint.anchor = joint_place;
  joint.axis = joint_direction;
  joint.direction = Vector3(-0.2, 0.9, 0.4);
  joint.radius = 0.6;
}

template <class Joint>
std::shared_ptr<Joint> make_joint(const std::string& name, BodyId a, BodyId b) {
  auto joint = std::make_shared<Joint>();
  joint->name = name;
  joint->body_a = a;
  joint->body_b = b;
  configure(*joint);
  return joint;
}

/// One joint for each interesting pair of bodies. With `mounted`, pairs with mounted rotors only,
/// otherwise pairs without.
template <class Joint>
void add_joints(Model& model, bool mounted) {
  const BodyId world = BodyId::world();
  const std::vector<std::pair<BodyId, BodyId>> plain{
      {{0}, {1}}, {world, {0}}, {{1}, world}, {{4}, {0}}, {{5}, {1}}, {{6}, {0}}, {{5}, {6}}};
  const std::vector<std::pair<BodyId, BodyId>> rotors{{{2}, {3}}, {{2}, {1}}, {world, {2}},
                                                      {{2}, {0}}, {{4}, {3}}, {{3}, {5}}};
  for (const auto& [a, b] : mounted ? rotors : plain) {
    // Gears and racks turn a body against the world.
    constexpr bool couples = std::is_same_v<Joint, GearJoint> || std::is_same_v<Joint, RackJoint>;
    if (couples && (a == world || b == world)) continue;
    auto joint = make_joint<Joint>("joint" + std::to_string(model.joints.size()), a, b);
    // Axes that are parallel, as at the start, swing apart with a kink.
    if constexpr (std::is_same_v<Joint, BallJoint>) {
      if (mounted) joint->swing_limit.reset();
    }
    model.joints.push_back(joint);
  }
}

test::GradientCheck check(const Model& model, double distance, double angle) {
  World world = test::start(model);
  Substep substep(world.bodies(), world.state(), 0.01, 1);
  ConstraintBatch& batch = *world.features()[0];
  batch.begin(substep, world.feature_state(0));
  test::displace(substep, distance, angle);
  return test::check_gradients(substep, batch);
}

template <class Joint>
class JointGradient : public ::testing::Test {};
using JointTypes =
    ::testing::Types<DistanceJoint, BallJoint, HingeJoint, SliderJoint, CylindricalJoint,
                     UniversalJoint, PlaneJoint, FixedJoint, GearJoint, RackJoint>;
TYPED_TEST_SUITE(JointGradient, JointTypes);

TYPED_TEST(JointGradient, IsExactAfterLargeMotionsOfTheSubstep) {
  Model model = general_bodies();
  add_joints<TypeParam>(model, false);
  const test::GradientCheck result = check(model, 0.2, 0.3);
  EXPECT_GT(result.compared, 50);
  EXPECT_GT(result.largest, 0.5);
  EXPECT_LT(result.error, tolerance) << result.worst;
}

TYPED_TEST(JointGradient, IsExactForMountedRotorsAtTheStart) {
  Model model = general_bodies();
  add_joints<TypeParam>(model, true);
  // Translations do not disturb the rotor's coordinate, so the anchors are apart.
  const test::GradientCheck result = check(model, 0.2, 0.0);
  EXPECT_GT(result.compared, 50);
  EXPECT_GT(result.largest, 0.5);
  EXPECT_LT(result.error, tolerance) << result.worst;
}

TYPED_TEST(JointGradient, OfMountedRotorsErrsInProportionToTheTurnOfTheSubstep) {
  Model model = general_bodies();
  add_joints<TypeParam>(model, true);
  const double coarse = check(model, 0.2, 1e-2).error;
  const double fine = check(model, 0.2, 1e-3).error;
  EXPECT_LT(coarse, 2e-2);
  EXPECT_LT(fine, 2e-3);
}

TEST(JointGradient, OfFrictionIsExactAtTheStart) {
  // Its coordinates are sums of changes, which have a gradient as rates have one.
  Model model = general_bodies();
  model.bodies[0].velocity = {0.4, 0.3, -0.6};
  auto ball = make_joint<BallJoint>("ball", {0}, {1});
  ball->friction = 1.0;
  ball->swing_limit.reset();  // a kink at the start
  model.joints.push_back(ball);
  const test::GradientCheck of_ball = check(model, 0.0, 0.0);
  EXPECT_GT(of_ball.compared, 60);
  EXPECT_LT(of_ball.error, tolerance) << of_ball.worst;
  auto plane = make_joint<PlaneJoint>("plane", {0}, {1});
  plane->friction = 1.0;
  model.joints = {plane};
  const test::GradientCheck of_plane = check(model, 0.0, 0.0);
  EXPECT_GT(of_plane.compared, 60);
  // The lever arm moves with the body, and its change times the motion of 1e-3 is of second order:
  // it cancels in symmetric differences but for rounding.
  EXPECT_LT(of_plane.error, tolerance) << of_plane.worst;
}

TEST(JointGradient, OfAGearInACarrierIsExact) {
  Model model = general_bodies();
  auto gear = make_joint<GearJoint>("gear", {0}, {1});
  gear->carrier = {5};
  model.joints = {gear};
  const test::GradientCheck of_gear = check(model, 0.2, 0.3);
  EXPECT_GT(of_gear.compared, 10);
  EXPECT_LT(of_gear.error, tolerance) << of_gear.worst;
  auto rack = make_joint<RackJoint>("rack", {1}, {6});
  rack->carrier = {0};
  model.joints = {rack};
  const test::GradientCheck of_rack = check(model, 0.2, 0.3);
  EXPECT_GT(of_rack.compared, 10);
  EXPECT_LT(of_rack.error, tolerance) << of_rack.worst;
}

TEST(GroundGradient, IsExactForEveryContactPoint) {
  Model model = general_bodies();
  model.ground.emplace();
  model.ground->point = {0.1, -0.4, 0.0};
  model.ground->normal = Vector3(0.2, 1.0, -0.1);
  for (const int i : {0, 1, 5, 6}) {
    auto box = std::make_shared<Box>();
    box->size = {0.4, 0.3, 0.5};
    model.bodies[static_cast<std::size_t>(i)].shapes = {{box, {0.05, 0.02, -0.03}}};
  }
  const test::GradientCheck result = check(model, 0.2, 0.0);
  EXPECT_GT(result.compared, 200);
  EXPECT_GT(result.largest, 0.5);
  EXPECT_LT(result.error, tolerance) << result.worst;
}

TEST(GroundGradient, IsExactAfterLargeMotionsOfBodiesThatAreNotMounted) {
  Model model = general_bodies();
  model.bodies.erase(model.bodies.begin() + 2, model.bodies.begin() + 4);
  model.ground.emplace();
  model.ground->normal = Vector3(0.2, 1.0, -0.1);
  auto box = std::make_shared<Box>();
  model.bodies[0].shapes = {{box, {0.05, 0.02, -0.03}}};
  model.bodies[1].shapes = {{box}};
  const test::GradientCheck result = check(model, 0.3, 0.4);
  EXPECT_LT(result.error, tolerance) << result.worst;
}

}  // namespace
}  // namespace sheave
