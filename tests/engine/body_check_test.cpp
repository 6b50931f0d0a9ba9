// Every fault of a body, a joint and the settings: the right path, a message, and no other fault.

#include "engine/body_check.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "engine/shapes/box.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Bodies: 0 free, 1 rotor, 2 slider, 3 planar, 4 static, 5 kinematic, 6 rotor mounted on 0.
Model good_model() {
  Model model;
  model.add(test::lump("free", Vector3::Zero(), 1.0));
  model.add(test::wheel("rotor", {1.0, 0.0, 0.0}, 0.2, 0.1));
  model.add(test::weight("slider", {2.0, 0.0, 0.0}, 1.0));
  BodyDef planar = test::lump("planar", {3.0, 0.0, 0.0}, 1.0);
  planar.mobility = Mobility::planar;
  model.add(planar);
  BodyDef fixed;
  fixed.name = "fixed";
  fixed.mobility = Mobility::fixed;
  model.add(fixed);
  BodyDef kinematic = fixed;
  kinematic.name = "kinematic";
  kinematic.mobility = Mobility::kinematic;
  model.add(kinematic);
  model.add(test::sheave("mounted", {0}, {0.0, 0.5, 0.0}, 0.1, 0.2, 0.01));
  return model;
}

void expect_fault(const std::string& path, const std::function<void(Model&)>& spoil) {
  Model model = good_model();
  spoil(model);
  const Errors errors = check_bodies(model);
  ASSERT_EQ(errors.size(), 1u) << path << "\n" << test::text(errors);
  EXPECT_EQ(errors[0].path, path) << errors[0].message;
  EXPECT_GT(errors[0].message.size(), 10u);
  EXPECT_FALSE(World::create(model).ok());
}

TEST(BodyCheck, AcceptsAGoodModel) { EXPECT_EQ(test::text(check_bodies(good_model())), ""); }

TEST(BodyCheck, RefusesWrongNames) {
  expect_fault("/bodies/0/name", [](Model& m) { m.bodies[0].name = ""; });
  expect_fault("/bodies/0/name", [](Model& m) { m.bodies[0].name = "world"; });
  expect_fault("/bodies/3/name", [](Model& m) { m.bodies[3].name = "rotor"; });
}

TEST(BodyCheck, RefusesWrongMassAndInertia) {
  for (const double mass : {0.0, -1.0, nan_value, infinite, -infinite}) {
    expect_fault("/bodies/0/mass", [&](Model& m) { m.bodies[0].mass = mass; });
    expect_fault("/bodies/1/inertia/2", [&](Model& m) { m.bodies[1].inertia->z() = mass; });
    expect_fault("/bodies/0/density", [&](Model& m) {
      m.bodies[0].mass.reset();
      m.bodies[0].density = mass;
    });
  }
  expect_fault("/bodies/0", [](Model& m) { m.bodies[0].mass.reset(); });
  expect_fault("/bodies/0/density", [](Model& m) { m.bodies[0].density = 1000.0; });
  expect_fault("/bodies/2/density", [](Model& m) {
    m.bodies[2].mass.reset();
    m.bodies[2].density = 1000.0;  // no shape
  });
  expect_fault("/bodies/0", [](Model& m) {
    m.bodies[0].inertia.reset();
    m.bodies[0].shapes.clear();
  });
  expect_fault("/bodies/0/inertia", [](Model& m) { m.bodies[0].inertia = Vector3(1.0, 1.0, 2.1); });
  expect_fault("/bodies/0/inertia", [](Model& m) { m.bodies[0].inertia = Vector3(2.1, 1.0, 1.0); });
  expect_fault("/bodies/0/inertia", [](Model& m) { m.bodies[0].inertia = Vector3(1.0, 2.1, 1.0); });
}

TEST(BodyCheck, AFlatBodyIsAllowed) {
  Model model = good_model();
  model.bodies[0].inertia = Vector3(1.0, 1.0, 2.0);  // a thin disc
  EXPECT_TRUE(check_bodies(model).empty());
}

TEST(BodyCheck, RefusesWrongAxes) {
  for (const int i : {0, 4}) {
    expect_fault("/bodies/" + std::to_string(i) + "/axis",
                 [&](Model& m) { m.bodies[static_cast<std::size_t>(i)].axis = Vector3::UnitX(); });
  }
  // A kinematic body with an axis keeps the plane across it.
  const auto keep_plane = [](Model& m) -> BodyDef& {
    m.bodies[5].axis = Vector3::UnitZ();
    return m.bodies[5];
  };
  Model model = good_model();
  keep_plane(model).velocity = {1.0, 2.0, 0.0};
  model.bodies[5].angular_velocity = {0.0, 0.0, 3.0};
  EXPECT_EQ(test::text(check_bodies(model)), "");
  expect_fault("/bodies/5/velocity", [&](Model& m) { keep_plane(m).velocity = {0.0, 0.0, 1.0}; });
  expect_fault("/bodies/5/oscillation", [&](Model& m) {
    keep_plane(m).oscillation = {0.0, 0.0, 1.0};
  });
  expect_fault("/bodies/5/angular_velocity", [&](Model& m) {
    keep_plane(m).angular_velocity = {0.0, 1.0, 1.0};
  });
  expect_fault("/bodies/2", [](Model& m) { m.bodies[2].axis.reset(); });
  expect_fault("/bodies/2/axis", [](Model& m) { m.bodies[2].axis = Vector3::Zero(); });
  expect_fault("/bodies/2/axis/1", [](Model& m) { m.bodies[2].axis = Vector3(1, nan_value, 0); });
}

TEST(BodyCheck, RefusesLengthsWhoseSquaresAreNotFinite) {
  expect_fault("/bodies/0/position", [](Model& m) { m.bodies[0].position.y() = -2e150; });
  expect_fault("/bodies/0/shape", [](Model& m) { m.bodies[0].shapes[0].position.x() = 2e150; });
  Model model = good_model();
  model.bodies[0].position = Vector3::Constant(1e150);
  const Result<BodySet> bodies = BodySet::create(model);
  ASSERT_TRUE(bodies.ok());
  EXPECT_TRUE(std::isfinite(bodies->scale()));
}

std::shared_ptr<Sphere> ball_of(double radius) {
  auto sphere = std::make_shared<Sphere>();
  sphere->radius = radius;
  return sphere;
}

TEST(BodyCheck, RefusesMassesWithoutFiniteDeterminants) {
  for (const double mass : {1e308, 1.1e100, 0.9e-100, 1e-308, 5e-324}) {
    expect_fault("/bodies/0/mass", [&](Model& m) { m.bodies[0].mass = mass; });
  }
  // Neither number is out of range, their product is.
  expect_fault("/bodies/0/shape", [](Model& m) {
    m.bodies[0].mass = 1e90;
    m.bodies[0].inertia.reset();
    m.bodies[0].shapes = {{ball_of(1e6)}};
  });
  // The volume of the sphere is 0, so its moments are no numbers.
  expect_fault("/bodies/0/shape", [](Model& m) {
    m.bodies[0].inertia.reset();
    m.bodies[0].shapes = {{ball_of(1e-120)}};
  });
  Model model = good_model();
  for (const double mass : {1e-100, 1e90}) {
    model.bodies[0].mass = mass;
    EXPECT_EQ(test::text(check_bodies(model)), "") << mass;
  }
}

TEST(BodyCheck, RefusesGravityWithoutFiniteSquares) {
  for (const double bad : {2e100, -1e308, infinite, nan_value}) {
    Model model = good_model();
    model.gravity.y() = bad;
    const Result<World> refused = World::create(model);
    ASSERT_FALSE(refused.ok()) << bad;
    EXPECT_EQ(refused.errors().front().path, "/gravity/1");
    model.gravity.y() = -1e100;
    Result<World> world = World::create(model);
    ASSERT_TRUE(world.ok());
    EXPECT_EQ(world->set_gravity(Vector3(0.0, 0.0, bad)).size(), 1U) << bad;
    EXPECT_TRUE(world->set_gravity(Vector3(0.0, 0.0, 1e100)).empty());
  }
}

TEST(BodyCheck, RefusesWrongMounts) {
  expect_fault("/bodies/0/mount", [](Model& m) { m.bodies[0].mount = BodyId{4}; });
  expect_fault("/bodies/6/mount", [](Model& m) { m.bodies[6].mount = BodyId{1}; });
  expect_fault("/bodies/6/mount", [](Model& m) { m.bodies[6].mount = BodyId{6}; });
  expect_fault("/bodies/6/mount", [](Model& m) { m.bodies[6].mount = BodyId::world(); });
  expect_fault("/bodies/6/mount", [](Model& m) { m.bodies[6].mount = BodyId{99}; });
  expect_fault("/bodies/6/mount", [](Model& m) { m.bodies[6].mount = BodyId{-2}; });
  for (const int carrier : {0, 2, 3, 4, 5}) {
    Model model = good_model();
    model.bodies[6].mount = BodyId{carrier};
    EXPECT_TRUE(check_bodies(model).empty()) << carrier;
  }
}

TEST(BodyCheck, RefusesUnbalancedRotors) {
  expect_fault("/bodies/1/shape", [](Model& m) {
    m.bodies[1].shapes[0].position = {0.01, 0.0, 0.0};
  });
  expect_fault("/bodies/6/inertia",
               [](Model& m) { m.bodies[6].inertia = Vector3(0.006, 0.007, 0.01); });
  Model shifted = good_model();  // along the axle: balanced
  shifted.bodies[1].shapes[0].position = {0.0, 0.0, 0.3};
  EXPECT_TRUE(check_bodies(shifted).empty());
}

TEST(BodyCheck, RefusesVelocitiesThatTheMobilityForbids) {
  const Vector3 skew{1.0, 1.0, 1.0};
  for (const int i : {1, 2, 3, 4, 6}) {
    expect_fault("/bodies/" + std::to_string(i) + "/velocity",
                 [&](Model& m) { m.bodies[static_cast<std::size_t>(i)].velocity = skew; });
    expect_fault("/bodies/" + std::to_string(i) + "/angular_velocity",
                 [&](Model& m) { m.bodies[static_cast<std::size_t>(i)].angular_velocity = skew; });
  }
  Model allowed = good_model();
  allowed.bodies[0].velocity = allowed.bodies[0].angular_velocity = skew;
  allowed.bodies[5].velocity = allowed.bodies[5].angular_velocity = skew;
  allowed.bodies[2].velocity = {0.0, 3.0, 0.0};
  allowed.bodies[3].velocity = {1.0, 2.0, 0.0};
  allowed.bodies[3].angular_velocity = allowed.bodies[1].angular_velocity = {0.0, 0.0, 2.0};
  EXPECT_EQ(test::text(check_bodies(allowed)), "");
}

TEST(BodyCheck, NamesTheVelocitiesThatTheMobilityAllows) {
  struct Case {
    std::size_t body;
    std::string velocity, spin;  ///< what is said of them
  };
  const std::vector<Case> cases{
      {1, "rotor allows: it stays where it is, so [0, 0, 0] is allowed",
       "rotor allows: it turns about its axis [0, 0, 1], so [0, 0, 3] is allowed"},
      {2, "slider allows: it slides along its axis [0, 1, 0], so [0, 2, 0] is allowed",
       "slider allows: it does not turn, so [0, 0, 0] is allowed"},
      {3, "planar allows: it stays in the plane across its axis [0, 0, 1], so [1, 2, 0] is allowed",
       "planar allows: it turns about its axis [0, 0, 1], so [0, 0, 3] is allowed"},
      {4, "static allows: it stays where it is, so [0, 0, 0] is allowed",
       "static allows: it does not turn, so [0, 0, 0] is allowed"},
      {6, "rotor allows: its axle moves with its mount, so [0, 0, 0] is allowed",
       "rotor allows: it turns about its axis [0, 0, 1], so [0, 0, 3] is allowed"}};
  for (const Case& one : cases) {
    Model model = good_model();
    BodyDef& body = model.bodies[one.body];
    body.velocity = body.angular_velocity = {1.0, 2.0, 3.0};
    const Errors errors = check_bodies(model);
    ASSERT_EQ(errors.size(), 2U) << body.name;
    const std::string asked = "velocity [1, 2, 3] is not one that mobility ";
    EXPECT_THAT(errors[0].message, testing::HasSubstr("the " + asked + one.velocity));
    EXPECT_THAT(errors[1].message, testing::HasSubstr("the angular " + asked + one.spin));
  }
  // An axis that is no coordinate's, and the value that is offered passes.
  Model model = good_model();
  model.bodies[1].axis = {3.0, 0.0, 4.0};
  model.bodies[1].shapes.clear();
  model.bodies[1].angular_velocity = {0.0, 1.0, 5.0};
  const Errors errors = check_bodies(model);
  ASSERT_FALSE(errors.empty());
  EXPECT_THAT(errors.back().message,
              testing::HasSubstr("about its axis [0.6, 0, 0.8], so [2.4, 0, 3.2] is allowed"));
  model.bodies[1].angular_velocity = {2.4, 0.0, 3.2};
  EXPECT_EQ(test::text(check_bodies(model)), "");
}

TEST(BodyCheck, OscillationsBelongToKinematicBodies) {
  expect_fault("/bodies/0/oscillation", [](Model& m) { m.bodies[0].oscillation = {0, 1, 0}; });
  expect_fault("/bodies/5/oscillation_frequency",
               [](Model& m) { m.bodies[5].oscillation_frequency = -1.0; });
}

TEST(BodyCheck, QuaternionsAreUnit) {
  expect_fault("/bodies/0/orientation",
               [](Model& m) { m.bodies[0].orientation = Quaternion(1.0, 0.1, 0.0, 0.0); });
  expect_fault("/bodies/0/orientation",
               [](Model& m) { m.bodies[0].orientation = Quaternion(0.0, 0.0, 0.0, 0.0); });
  expect_fault("/bodies/0/orientation",
               [](Model& m) { m.bodies[0].orientation = Quaternion(nan_value, 0.0, 0.0, 0.0); });
}

TEST(BodyCheck, NumbersAreFinite) {
  for (const double bad : {nan_value, infinite, -infinite}) {
    expect_fault("/bodies/0/position/2", [&](Model& m) { m.bodies[0].position.z() = bad; });
    expect_fault("/bodies/0/velocity/0", [&](Model& m) { m.bodies[0].velocity.x() = bad; });
    expect_fault("/bodies/0/angular_velocity/1",
                 [&](Model& m) { m.bodies[0].angular_velocity.y() = bad; });
    expect_fault("/bodies/0/force/1", [&](Model& m) { m.bodies[0].force.y() = bad; });
    expect_fault("/bodies/0/torque/1", [&](Model& m) { m.bodies[0].torque.y() = bad; });
    expect_fault("/bodies/5/oscillation/0", [&](Model& m) { m.bodies[5].oscillation.x() = bad; });
    expect_fault("/bodies/5/oscillation_phase",
                 [&](Model& m) { m.bodies[5].oscillation_phase = bad; });
  }
}

TEST(BodyCheck, ShapesAreChecked) {
  expect_fault("/bodies/0/shape", [](Model& m) { m.bodies[0].shapes[0].shape = nullptr; });
  expect_fault("/bodies/0/shape/size/0", [](Model& m) {
    auto box = std::make_shared<Box>();
    box->size.x() = -1.0;
    m.bodies[0].shapes[0].shape = box;
  });
  expect_fault("/bodies/0/shape/position/0",
               [](Model& m) { m.bodies[0].shapes[0].position.x() = nan_value; });
}

TEST(BodyCheck, ReportsAllFaultsOfAllBodies) {
  Model model = good_model();
  model.bodies[0].mass = -1.0;
  model.bodies[0].position.x() = nan_value;
  model.bodies[2].axis.reset();
  model.bodies[3].velocity = Vector3::Ones();
  model.bodies[6].mount = BodyId{1};
  EXPECT_EQ(check_bodies(model).size(), 5u) << test::text(check_bodies(model));
}

Errors world_errors(const Model& model) {
  const Result<World> world = World::create(model);
  return world ? Errors{} : world.errors();
}

TEST(ModelCheck, RefusesWrongGravityStepAndGround) {
  const auto expect = [](const std::string& path, const std::function<void(Model&)>& spoil) {
    Model model = good_model();
    model.ground.emplace();
    spoil(model);
    const Errors errors = world_errors(model);
    ASSERT_EQ(errors.size(), 1u) << path << "\n" << test::text(errors);
    EXPECT_EQ(errors[0].path, path);
  };
  expect("/gravity/1", [](Model& m) { m.gravity.y() = nan_value; });
  expect("/step/dt", [](Model& m) { m.step.dt = 0.0; });
  expect("/step/dt", [](Model& m) { m.step.dt = nan_value; });
  expect("/step/substeps", [](Model& m) { m.step.substeps = 0; });
  expect("/step/substeps", [](Model& m) { m.step.substeps = 100001; });
  expect("/step/iterations", [](Model& m) { m.step.iterations = 0; });
  expect("/ground/normal", [](Model& m) { m.ground->normal.setZero(); });
  expect("/ground/point/0", [](Model& m) { m.ground->point.x() = infinite; });
}

template <class Joint>
std::shared_ptr<Joint> joint(const std::string& name) {
  auto result = std::make_shared<Joint>();
  result->name = name;
  result->body_b = {0};
  return result;
}

TEST(ModelCheck, RefusesWrongJoints) {
  const auto expect = [](const std::string& path, std::shared_ptr<const JointDef> bad) {
    Model model = good_model();
    model.joints = {joint<BallJoint>("good"), std::move(bad)};
    const Errors errors = world_errors(model);
    ASSERT_EQ(errors.size(), 1u) << path << "\n" << test::text(errors);
    EXPECT_EQ(errors[0].path, path);
  };
  expect("/joints/1/name", joint<BallJoint>("good"));
  auto self = joint<BallJoint>("self");
  self->body_a = {0};
  expect("/joints/1/body_b", self);
  auto compliance = joint<BallJoint>("compliance");
  compliance->compliance = -1.0;
  expect("/joints/1/compliance", compliance);
  auto axis = joint<HingeJoint>("axis");
  axis->axis.setZero();
  expect("/joints/1/axis", axis);
  auto rod = joint<DistanceJoint>("rod");
  expect("/joints/1", rod);  // anchors coincide
  auto damped = joint<DistanceJoint>("damped");
  damped->length = 1.0;
  damped->damping = 1.0;
  expect("/joints/1/damping", damped);
  auto anchor = joint<BallJoint>("anchor");
  anchor->anchor.x() = nan_value;
  expect("/joints/1/anchor/0", anchor);
}

TEST(ModelCheck, JointNamesAreNotEmpty) {
  Model model = good_model();
  model.joints = {joint<BallJoint>("")};
  EXPECT_FALSE(world_errors(model).empty());
}

TEST(ModelCheck, JointsToBodiesThatDoNotExistAreErrors) {
  for (const int bad : {7, 1000, -2}) {
    Model model = good_model();
    auto dangling = joint<BallJoint>("dangling");
    dangling->body_b = {bad};
    model.joints = {dangling};
    EXPECT_FALSE(world_errors(model).empty()) << bad;
  }
}

}  // namespace
}  // namespace sheave
