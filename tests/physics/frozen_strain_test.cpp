// What is wound with `tangent_update` "substep" has the strain of the tension that acted.

#include <algorithm>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/rounding.h"
#include "tests/support/shapes.h"

namespace sheave::test::frozen_strain {
namespace {

constexpr double h = 0.1;  // [s]
const Vector3 speed(-1.6, 0.0, 0.0);

/// A rope with 0.6 m to spare beyond a post that it slips over, and that a load winds round it that
/// flies past.
Machine wound_by_a_load(const StepSettings& step) {
  Machine machine;
  machine.model.step = step;
  machine.model.gravity.setZero();
  BodyDef post;
  post.name = "post";
  post.mobility = Mobility::fixed;
  post.shapes = {{make<Cylinder>([](Cylinder& c) { c.radius = 0.3, c.length = 0.1; })}};
  const BodyId around = machine.model.add(post);
  BodyDef flying = lump("load", {0.3, -0.7, 0.0}, 1.0);
  flying.velocity = speed;
  const BodyId load = machine.model.add(flying);
  auto middle = roll(around, right);
  middle->friction = 0.1;
  machine.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-2.0, 0.3, 0.0}), middle, attach(load)}));
  machine.cables[0].axial_stiffness = 1e5;
  machine.cables[0].tangent_update = TangentUpdate::substep;
  machine.cables[0].rest_lengths = {2.6, 0.7};
  return machine;
}

class FrozenStrain : public ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, FrozenStrain, testing::ValuesIn(combinations), combination_name);

// Nothing pulls at it: the load goes on as it was, but for the rounding of lengths of 1 m, and what
// is wound in a substep has the mean of the strain before and none. (Before, it has what its way
// round the post is longer than that of the attachments that have kept their places.)
TEST_P(FrozenStrain, SlackRopeIsWoundWithoutStrain) {
  Simulation simulation = start(wound_by_a_load(step_settings(h, 20)));
  double most = 0.0;
  for (int i = 0; i < 5; ++i) {
    const SpanReport span = simulation.cable_reports()[0].spans[1];
    most = std::max(most, span.length / span.rest_length - 1.0);
    ASSERT_TRUE(simulation.world.step().ok());
    EXPECT_LE(simulation.cable_reports()[0].links[1].most_strain, 0.5 * most + 16.0 * eps);
    EXPECT_LE((simulation.world.velocity(BodyId{1}) - speed).norm(), 16.0 * eps / h);
  }
  EXPECT_GT(simulation.cable_reports()[0].links[1].stored_length, 0.3 * 0.5 * pi + 0.05);
}

// A material that slides over the post follows it, so nothing is laid anew.
TEST_P(FrozenStrain, RopeThatSlidesOverAnArcIsNotFrozen) {
  Simulation simulation = start(wound_by_a_load(step_settings(h, 20)));
  ASSERT_TRUE(simulation.world.step().ok());
  EXPECT_LE(simulation.world.energy().elastic, 1e-20);
}

// All energy that it has then comes of being laid anew: of a constant compliance.
TEST_P(FrozenStrain, TheCertificateReportsRelaidRope) {
  Machine machine = wound_by_a_load(step_settings(h, 20));
  machine.cables[0].axial_stiffness.reset();
  machine.cables[0].compliance = 1e-5;
  Simulation simulation = start(machine);
  ASSERT_TRUE(simulation.world.step().ok());
  const double elastic = simulation.world.energy().elastic;
  const CertificateItem item = *simulation.certificate()->find(CertificateItem::Kind::energy);
  EXPECT_GT(elastic, 0.01);
  EXPECT_NEAR(item.value, elastic, 1e-9 * elastic) << item.sentence();
  EXPECT_GT(item.relative, 0.01);
}

// A drum that turns evenly under the weight of its load, whose rope is strained by m g / EA = 3.6 %
// everywhere: what is wound keeps its energy, there is no other length to be laid anew to, and
// nothing is gained.
TEST_P(FrozenStrain, RopeWoundUnderAConstantTensionKeepsItsEnergy) {
  for (const double turning : {2.0, -2.0}) {
    Machine machine;
    machine.model.step = step_settings(0.01, 20);
    machine.model.gravity = down;
    const double r = 0.1;
    const double stiffness = 270.0;
    const double strain = 9.81 / stiffness;
    BodyDef winch = wheel("drum", Vector3::Zero(), r, 0.02);
    winch.drive = DriveKind::speed;
    winch.drive_values = {turning};
    winch.angular_velocity = {0.0, 0.0, turning};
    const BodyId drum = machine.model.add(winch);
    BodyDef hanging = weight("load", {r, -1.0, 0.0}, 1.0);
    hanging.velocity = {0.0, r * turning, 0.0};
    const BodyId load = machine.model.add(hanging);
    auto wound = roll(drum, left);
    wound->stored_length = 1.0;
    machine.cables.push_back(cable("rope", {attach(load), wound}));
    machine.cables[0].axial_stiffness = stiffness;
    machine.cables[0].tangent_update = TangentUpdate::substep;
    machine.cables[0].rest_lengths = {1.0 / (1.0 + strain)};
    Simulation simulation = start(machine);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      const Certificate certificate = *simulation.certificate();
      EXPECT_TRUE(certificate.clean()) << certificate.worst()->sentence();
    }
    EXPECT_NEAR(simulation.world.velocity(load).y(), r * turning, 1e-3);
  }
}

// Rope that lies unstrained on its drum comes off so and is strained with all else in the span: work
// that is explained. (It had counted as coming off with the strain of the span, and the difference,
// T e / 2 of what flows for a strain e of up to 7 %, as energy from nowhere.) Left is what is laid
// anew: r phi^3 / 6 of a turn by phi = 0.01 rad, 2e-5 of r phi.
TEST_P(FrozenStrain, RopeUnwoundWithoutStrainIsNoFault) {
  Machine machine;
  machine.model.step = step_settings(0.005, 50);
  machine.model.gravity = down;
  BodyDef winch = wheel("drum", Vector3::Zero(), 0.1, 0.02);
  winch.drive = DriveKind::speed;
  winch.drive_values = {-2.0};
  const BodyId drum = machine.model.add(winch);
  const BodyId load = machine.model.add(weight("load", {0.1, -1.0, 0.0}, 1.0));
  auto wound = roll(drum, left);
  wound->stored_length = 1.0;
  machine.cables.push_back(cable("rope", {attach(load), wound}));
  machine.cables[0].axial_stiffness = 270.0;
  machine.cables[0].tangent_update = TangentUpdate::substep;
  Simulation simulation = start(machine);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(simulation.world.step().ok());
    const Certificate certificate = *simulation.certificate();
    EXPECT_TRUE(certificate.clean(1e-4)) << certificate.worst()->sentence();
  }
}

}  // namespace
}  // namespace sheave::test::frozen_strain
