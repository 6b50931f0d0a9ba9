// Masses as drawings have them: a centre of mass, a tensor with products of inertia, densities of
// shapes; and messages about tensors that no body has.

#include "engine/body_mass.h"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "engine/shapes/box.h"
#include "engine/world.h"

namespace sheave {
namespace {

/// Rotation from the principal axes to the axes of the drawing.
const Quaternion turn = Quaternion(0.8, 0.2, -0.4, 0.4).normalized();
const Vector3 principal_moments{1.0, 2.5, 3.0};

std::shared_ptr<const Shape> box(const Vector3& size) {
  auto shape = std::make_shared<Box>();
  shape->size = size;
  return shape;
}

BodyDef asymmetric_body() {
  BodyDef body;
  body.name = "bracket";
  body.mass = 3.0;
  body.inertia = principal_moments;
  body.angular_velocity = {0.3, 2.0, 0.4};
  return body;
}

/// The same body with the axes of its drawing.
BodyDef drawn_body() {
  BodyDef body = asymmetric_body();
  const Matrix3 rotation = turn.toRotationMatrix();
  const Matrix3 tensor = rotation * principal_moments.asDiagonal() * rotation.transpose();
  body.inertia = tensor.diagonal();
  body.products_of_inertia = {tensor(0, 1), tensor(0, 2), tensor(1, 2)};
  body.orientation = turn.conjugate();
  return body;
}

World world_of(const BodyDef& body, IntegratorKind integrator) {
  Model model;
  model.step.dt = 0.01;
  model.step.integrator = integrator;
  model.step.solver = SolverKind::direct;
  model.add(body);
  Result<World> world = World::create(model);
  if (!world) ADD_FAILURE() << world.errors()[0].message;
  return std::move(*world);
}

Vector3 angular_momentum(const World& world, const BodyDef& body) {
  const Vector3 own =
      world.orientation(BodyId{0}).conjugate() * world.state().bodies[0].angular_velocity;
  return world.orientation(BodyId{0}) * Vector3(defined_inertia(body) * own);
}

std::string first_message(const BodyDef& body) {
  Model model;
  model.add(body);
  const Result<World> world = World::create(model);
  if (world) return "";
  return world.errors()[0].path + ": " + world.errors()[0].message;
}

void expect_message(const BodyDef& body, const std::string& words) {
  const std::string message = first_message(body);
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

// Both integrators conserve the angular momentum of a free body to rounding, 2000 substeps of 1e-16
// each. The energy oscillates by (w h)^2 / 12, 2.1e-6 with w = 2 rad/s and h = 2.5 ms. Two
// descriptions of one body differ by the rounding of the tensor, which grows while the body tumbles
// about its middle axis, by e^(w t / 2) = 150 at most.
TEST(BodyMass, ATensorWithProductsTurnsAsItsPrincipalMoments) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const BodyDef drawn = drawn_body();
    World principal = world_of(asymmetric_body(), integrator);
    World own = world_of(drawn, integrator);
    const double energy = own.energy().kinetic;
    const Vector3 momentum = angular_momentum(own, drawn);
    EXPECT_NEAR(energy, principal.energy().kinetic, 1e-14 * energy);
    for (int i = 0; i < 500; ++i) {
      ASSERT_TRUE(principal.step().ok());
      ASSERT_TRUE(own.step().ok());
    }
    // A point of the body, by its coordinates along the principal axes.
    const Vector3 point(0.3, -0.7, 1.1);
    const Vector3 there = principal.orientation(BodyId{0}) * point;
    const Vector3 here = own.orientation(BodyId{0}) * (turn * point);
    EXPECT_LT((there - here).norm(), 1e-10);
    EXPECT_GT((there - point).norm(), 0.1) << "it has turned";
    EXPECT_NEAR(own.energy().kinetic, energy, 2.1e-6 * energy);
    EXPECT_NEAR(own.energy().kinetic, principal.energy().kinetic, 1e-10 * energy);
    EXPECT_LT((angular_momentum(own, drawn) - momentum).norm(), 1e-10 * momentum.norm());
  }
}

// A compound pendulum on an axis at the origin of its frame, with its centre of mass at d from the
// axis: w^2 = m g d / (I + m d^2) for small angles; at 1e-4 rad the next term is 1e-8 / 16 of the
// period. rattle's error of the phase is (w h)^2 / 24 of it, with w = 3.5 /s and h = 1/960 s 6e-7.
TEST(BodyMass, ACompoundPendulumSwingsAboutAnAxisBesideItsCentreOfMass) {
  constexpr double mass = 3.0;
  constexpr double moment = 0.8;
  constexpr double gravity = 10.0;
  const Vector3 center(0.3, -0.4, 0.0);  // 0.5 m from the axis
  const double square = mass * gravity * 0.5 / (moment + mass * 0.25);
  // The body is turned until its centre of mass is 1e-4 rad beside the lowest place.
  constexpr double aside = 1e-4;
  const double angle = -0.5 * pi - std::atan2(center.y(), center.x()) + aside;
  Model model;
  model.gravity = {0.0, -gravity, 0.0};
  model.step = {1.0 / 240.0, 4, 50, SolverKind::direct, IntegratorKind::rattle};
  BodyDef plate;
  plate.name = "plate";
  plate.mobility = Mobility::planar;
  plate.mass = mass;
  plate.center_of_mass = center;
  plate.inertia = Vector3(0.5, 0.5, moment);
  plate.orientation = Quaternion(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle));
  auto axis = std::make_shared<HingeJoint>();
  axis->name = "axis";
  axis->body_b = model.add(plate);
  model.joints.push_back(axis);
  Result<World> world = World::create(model);
  ASSERT_TRUE(world) << world.errors()[0].message;
  const auto place = [&] { return world->state().bodies[0].position; };
  EXPECT_NEAR(place().norm(), 0.5, 1e-15);
  EXPECT_NEAR(std::atan2(place().x(), -place().y()), aside, 1e-15);
  for (int i = 0; i < 480; ++i) ASSERT_TRUE(world->step().ok());
  const double phase = std::sqrt(square) * world->state().time;
  EXPECT_NEAR(std::atan2(place().x(), -place().y()), aside * std::cos(phase), 1e-5 * aside);
}

TEST(BodyMass, ABoxGivenByItsDensityEqualsOneGivenByItsMass) {
  BodyDef by_density = asymmetric_body();
  by_density.mass.reset();
  by_density.inertia.reset();
  by_density.shapes = {{box({0.5, 0.25, 2.0})}};
  BodyDef by_mass = by_density;
  BodyDef by_shape = by_density;
  by_density.density = 4.0;
  by_mass.mass = 1.0;
  by_shape.shapes[0].density = 4.0;
  std::vector<std::uint64_t> hashes;
  for (const BodyDef& body : {by_density, by_mass, by_shape}) {
    World world = world_of(body, IntegratorKind::rattle);
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(world.step().ok());
    hashes.push_back(hash(world.state()));
  }
  // All numbers are powers of two but the twelfth of the moments, and rounded alike.
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(BodyMass, ShapesHaveTheirOwnDensities) {
  BodyDef hammer;
  hammer.name = "hammer";
  hammer.density = 1.0;
  // A handle of 1 kg along x from 0 to 1 m, and a head of 8 kg in its end.
  hammer.shapes = {{box({1.0, 1.0, 1.0}), {0.5, 0.0, 0.0}},
                   {box({1.0, 1.0, 1.0}), {1.5, 0.0, 0.0}}};
  hammer.shapes[1].density = 8.0;
  const MassProperties own = defined_mass_properties(hammer);
  EXPECT_DOUBLE_EQ(own.mass, 9.0);
  EXPECT_NEAR(own.center_of_mass.x(), (1.0 * 0.5 + 8.0 * 1.5) / 9.0, 1e-15);
  EXPECT_NEAR(own.inertia(0, 0), 9.0 / 6.0, 1e-14);
  // 1/6 of each mass, and m1 m2 / (m1 + m2) times the square of the distance of 1 m.
  EXPECT_NEAR(own.inertia(1, 1), 9.0 / 6.0 + 8.0 / 9.0, 1e-14);
  EXPECT_EQ(first_message(hammer), "");
}

TEST(BodyMass, AMissingDensityOrASecondMassIsTold) {
  BodyDef body;
  body.name = "bracket";
  body.shapes = {{box({1.0, 1.0, 1.0})}, {box({1.0, 1.0, 1.0})}};
  body.shapes[1].density = 8.0;
  expect_message(body,
                 "body \"bracket\": only 1 of its 2 shapes have a density; the body needs "
                 "\"density\" for the others");
  body.mass = 2.0;
  expect_message(body, "/bodies/0/shapes/1/density: body \"bracket\": the body has a mass");
}

TEST(BodyMass, ATensorThatNoBodyHasIsTold) {
  BodyDef body = asymmetric_body();
  body.inertia = Vector3(1.0, 1.0, 3.0);
  expect_message(body,
                 "/bodies/0/inertia: body \"bracket\": no body has the moments of inertia "
                 "[1, 1, 3] kg m2: each must be at most the sum of the other two");
  // The principal moments of this tensor are 1 - 0.8, 1 and 1 + 0.8: possible. With 1.2 in place
  // of 0.8 one is negative.
  body.inertia = Vector3(1.0, 1.0, 1.0);
  body.products_of_inertia = {0.4, 0.0, 0.0};
  EXPECT_EQ(first_message(body), "");
  body.products_of_inertia = {0.8, 0.0, 0.0};
  expect_message(body, "principal moments of inertia [0.2, 1, 1.8] kg m2: each must be at most");
  body.products_of_inertia = {1.25, 0.0, 0.0};
  expect_message(body,
                 "/bodies/0/products_of_inertia: body \"bracket\": no body has the principal "
                 "moments of inertia [-0.25, 1, 2.25] kg m2: each must be greater than 0");
  body.inertia.reset();
  body.shapes = {{box({1.0, 1.0, 1.0})}};
  expect_message(body, "/products_of_inertia: body \"bracket\": needs \"inertia\"");
}

TEST(BodyMass, ACentreOfMassNeedsAMassAndATensor) {
  BodyDef body = asymmetric_body();
  body.center_of_mass = Vector3(0.1, 0.2, 0.3);
  EXPECT_EQ(first_message(body), "");
  EXPECT_EQ(defined_mass_properties(body).center_of_mass, Vector3(0.1, 0.2, 0.3));
  body.inertia.reset();
  body.shapes = {{box({1.0, 1.0, 1.0})}};
  expect_message(body, "shapes tell no inertia about another centre of mass than their own");
  body.mass.reset();
  body.density = 2.0;
  expect_message(body, "the densities of the shapes place the centre of mass");
  BodyDef rotor = asymmetric_body();
  rotor.mobility = Mobility::rotor;
  rotor.angular_velocity = Vector3::Zero();
  rotor.center_of_mass = Vector3(0.1, 0.0, 0.0);
  expect_message(rotor,
                 "/bodies/0/center_of_mass: body \"bracket\": the centre of mass of a rotor "
                 "must lie on its axle");
}

}  // namespace
}  // namespace sheave
