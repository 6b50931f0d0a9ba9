// Joints as quantities: every number of their reports, under the names that the reference tells.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "scenes/observables.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// A lump on a driven hinge, one in a driven sleeve, one on a ball with an axis, and one on a rod
/// that is too weak.
Machine jointed() {
  Machine m;
  m.model.gravity = down;
  m.model.step = settings(0.01, 1, 50);
  const auto add = [&](const auto& joint, const std::string& name, const Vector3& center) {
    joint->name = name;
    joint->body_b = m.model.add(lump(joint->name + " lump", center, 2.0));
    m.model.joints.push_back(joint);
  };
  // Against the order of the registry, so that reports must be put in order.
  auto sleeve = std::make_shared<CylindricalJoint>();
  sleeve->anchor = {5.0, 0.0, 0.0};
  sleeve->axis = Vector3::UnitY();
  sleeve->travel.drive = CoordinateDrive::speed;
  sleeve->travel.drive_values = {0.5};
  sleeve->angle.drive = CoordinateDrive::force;
  sleeve->angle.drive_values = {0.25};
  add(sleeve, "sleeve", {5.0, 0.0, 0.0});
  auto hinge = std::make_shared<HingeJoint>();
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_values = {2.0};
  add(hinge, "hinge", {0.4, 0.0, 0.0});
  auto ball = std::make_shared<BallJoint>();
  ball->anchor = {10.0, 0.0, 0.0};
  ball->axis = -Vector3::UnitY();
  add(ball, "ball", {10.1, -0.4, 0.0});
  auto plain = std::make_shared<BallJoint>();
  plain->anchor = {15.0, 0.0, 0.0};
  plain->friction = 0.1;
  add(plain, "plain", {15.0, -0.4, 0.0});
  auto rod = std::make_shared<DistanceJoint>();
  rod->anchor_a = {20.0, 1.0, 0.0};
  rod->anchor_b = {20.0, 0.0, 0.0};
  rod->breaking_force = 5.0;
  add(rod, "rod", {20.0, 0.0, 0.0});
  return m;
}

class JointObservables : public testing::Test {
 protected:
  JointObservables() : simulation(start(jointed())), set(simulation) {}

  double value(const std::string& name) {
    const Result<int> index = set.index_of(name);
    EXPECT_TRUE(index) << name;
    if (!index) return NAN;
    std::vector<double> values;
    set.sample(simulation, values);
    // Asked for alone it is the same.
    double alone = NAN;
    set.sample(simulation, std::span(&*index, 1), std::span(&alone, 1));
    EXPECT_EQ(alone, values.at(static_cast<std::size_t>(*index))) << name;
    return alone;
  }
  [[nodiscard]] bool exists(const std::string& name) const { return bool(set.index_of(name)); }

  Simulation simulation;
  ObservableSet set;
};

TEST_F(JointObservables, HaveTheValuesOfTheReports) {
  run(simulation.world, 0.5);
  const std::vector<JointReport> reports = joint_reports(simulation.world);
  ASSERT_EQ(reports.size(), 5U);
  for (const JointReport& joint : reports) {
    const std::string dot = joint.name + ".";
    EXPECT_EQ(value(dot + "force"), joint.force.norm());
    EXPECT_EQ(value(dot + "torque"), joint.torque.norm());
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      EXPECT_EQ(value(dot + "f" + axis), joint.force[i]);
      EXPECT_EQ(value(dot + "t" + axis), joint.torque[i]);
    }
    EXPECT_EQ(value(dot + "broken"), joint.broken_at ? 1.0 : 0.0);
    for (const JointCoordinateReport& coordinate : joint.coordinates) {
      const std::string name(coordinate.name);
      const bool only_one = joint.coordinates.size() == 1;
      EXPECT_EQ(value(dot + name), coordinate.value);
      EXPECT_EQ(value(dot + name + "_rate"), coordinate.rate);
      EXPECT_EQ(value(dot + (only_one ? "drive_force" : name + "_drive_force")),
                coordinate.drive_force);
    }
  }
}

TEST_F(JointObservables, HaveTheValuesOfTheClosedForm) {
  run(simulation.world, 0.5);
  EXPECT_NEAR(value("hinge.angle"), 1.0, 1e-6);
  EXPECT_NEAR(value("hinge.angle_rate"), 2.0, 1e-6);
  EXPECT_NEAR(value("sleeve.travel"), 0.25, 1e-6);
  EXPECT_NEAR(value("sleeve.travel_drive_force"), 2.0 * g, 1e-4);
  EXPECT_EQ(value("sleeve.angle_drive_force"), 0.25);
  // Against gravity holds what is not accelerated.
  EXPECT_NEAR(value("sleeve.fy"), 2.0 * g, 1e-4);
  EXPECT_EQ(value("rod.broken"), 1.0);
  EXPECT_EQ(value("rod.force"), 0.0);
  // The broken rod tells how far the lump has fallen since: first order, so by t g h / 2 = 0.025 m
  // too far.
  EXPECT_NEAR(value("rod.extension"), 0.5 * g * 0.25, 0.05);
}

TEST_F(JointObservables, DependOnTheJointType) {
  EXPECT_TRUE(exists("ball.twist"));
  EXPECT_TRUE(exists("ball.swing"));
  EXPECT_FALSE(exists("ball.turn0"));
  EXPECT_FALSE(exists("plain.twist")) << "swing and twist refer to an axis";
  EXPECT_FALSE(exists("sleeve.drive_force")) << "of which coordinate?";
  EXPECT_NEAR(value("ball.swing"), 0.0, 1e-12);
}

TEST_F(JointObservables, OfADefinitionEqualThoseOfItsSimulationAndAreUnique) {
  const Machine m = jointed();
  const std::vector<std::string> names = ObservableSet(m.model, m.cables).names();
  EXPECT_EQ(names, set.names());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  // 1 time, 5 bodies, 5 joints with 2 + 1 + 2 + 0 + 1 coordinates, energies.
  EXPECT_EQ(ObservableSet(m.model, m.cables).default_count(),
            1U + 5U * 14U + 5U * 9U + 6U * 3U + 4U);
}

TEST_F(JointObservables, ForcesAreUnknownAtTheStart) {
  for (const std::string name : {"hinge.force", "hinge.fx", "hinge.tz", "hinge.drive_force"}) {
    EXPECT_FALSE(set.known_at_start(set.index_of(name).value())) << name;
  }
  for (const std::string name : {"hinge.angle", "hinge.angle_rate", "hinge.broken"}) {
    EXPECT_TRUE(set.known_at_start(set.index_of(name).value())) << name;
  }
}

TEST_F(JointObservables, UnknownNamesGetASuggestion) {
  EXPECT_THAT(set.index_of("hinge.angel").errors()[0].message,
              testing::HasSubstr("did you mean \"hinge.angle\"?"));
}

// What the reference says must hold for all types.
TEST(JointQuantities, NameTheCoordinatesOfEveryType) {
  std::string help;
  for (const QuantityGroup& group : quantity_groups()) {
    for (const Quantity& quantity : group.quantities) {
      if (quantity.name == "<coordinate>") help = quantity.help;
    }
  }
  for (const auto& type : joint_types()) {
    const auto joint = type.make();
    if (auto* ball = dynamic_cast<BallJoint*>(joint.get())) ball->axis = Vector3::UnitY();
    if (joint->coordinates().empty()) continue;
    EXPECT_THAT(help, testing::HasSubstr(std::string(type.name)));
    for (const JointCoordinateInfo& coordinate : joint->coordinates()) {
      EXPECT_THAT(help, testing::HasSubstr(std::string(coordinate.name))) << type.name;
    }
  }
}

// A joint and a cable of one name share no quantity; a joint and a body share the angle, and the
// power of their drives, if both have one, which is refused at load.
TEST(JointQuantities, AreSharedWithBodiesInTheAngleOnly) {
  for (const auto& type : joint_types()) {
    const auto joint = type.make();
    bool turns = false;
    for (const JointCoordinateInfo& coordinate : joint->coordinates()) {
      turns = turns || coordinate.name == "angle";
    }
    EXPECT_EQ(shared_quantity(*joint, BodyDef{}), turns ? "angle" : "") << type.name;
    BodyDef driven;
    driven.drive = DriveKind::torque;
    if (joint->coordinates().size() != 1) continue;
    EXPECT_EQ(shared_quantity(*joint, driven), "drive_power") << type.name;
  }
  std::set<std::string_view> of_cables;
  std::set<std::string_view> of_joints;
  for (const QuantityGroup& group : quantity_groups()) {
    for (const Quantity& quantity : group.quantities) {
      if (group.prefix == "<cable>.") of_cables.insert(quantity.name);
      if (group.prefix == "<joint>.") of_joints.insert(quantity.name);
    }
  }
  EXPECT_FALSE(of_joints.empty());
  for (const std::string_view name : of_joints) EXPECT_FALSE(of_cables.contains(name)) << name;
}

TEST_F(JointObservables, HaveTheUnitsOfTheirCoordinates) {
  const auto unit = [&](std::string_view name) {
    const Result<int> index = set.index_of(name);
    EXPECT_TRUE(index) << name;
    return index ? set.unit(*index) : std::string_view("none");
  };
  EXPECT_EQ(unit("t"), "s");
  EXPECT_EQ(unit("hinge.angle"), "rad");
  EXPECT_EQ(unit("hinge.angle_rate"), "rad/s");
  EXPECT_EQ(unit("hinge.drive_force"), "N m");
  EXPECT_EQ(unit("hinge.drive_power"), "W");
  EXPECT_EQ(unit("hinge.drive_error"), "rad, rad/s");
  EXPECT_EQ(unit("sleeve.travel"), "m");
  EXPECT_EQ(unit("sleeve.travel_rate"), "m/s");
  EXPECT_EQ(unit("sleeve.travel_drive_force"), "N");
  EXPECT_EQ(unit("sleeve.travel_drive_error"), "m, m/s");
  EXPECT_EQ(unit("sleeve.angle_drive_force"), "N m");
  EXPECT_EQ(unit("rod.extension"), "m");
  EXPECT_EQ(unit("rod.torque"), "N m");
  EXPECT_EQ(unit("rod.broken"), "");
  EXPECT_EQ(unit("momentum.angular_z"), "kg m2/s");
}

}  // namespace
}  // namespace sheave::test
