// Attributes of MJCF that change masses and forces, and reports of those that are not taken.

#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/import/import.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using import::Outcome;
using nlohmann::json;
using testing::HasSubstr;

/// A model with this content, the world's bodies first.
std::string attribute_model(const std::string& world, const std::string& other = {}) {
  return "<mujoco>\n<worldbody>\n" + world + "\n</worldbody>\n" + other + "\n</mujoco>\n";
}

Outcome attribute_outcome(const std::string& text, const std::string& key = {}) {
  import::Options options;
  options.keyframe = key;
  Outcome outcome = import::import_model(text, "model.xml", options);
  EXPECT_TRUE(outcome.errors.empty()) << to_string(outcome.errors.front());
  return outcome;
}

/// The note about the element on a line.
import::Note note_at(const Outcome& outcome, int line) {
  const auto note = std::find_if(outcome.notes.begin(), outcome.notes.end(),
                                 [&](const import::Note& one) { return one.line == line;
}  // namespace
);
return note == outcome.notes.end() ? import::Note{} : *note;
}  // namespace sheave

class ImportedAttributes : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

/// Mass and moments of a geom of these attributes.
std::array<double, 4> mass_and_moments(const std::string& geom) {
  const Outcome outcome =
      attribute_outcome(attribute_model("<body><freejoint/><geom " + geom + "/></body>"));
  const json body = json::parse(outcome.json)["bodies"][0];
  const json& moments = body["inertia"];
  return {body["mass"].get<double>(), moments[0].get<double>(), moments[1].get<double>(),
          moments[2].get<double>()};
}

TEST_F(ImportedAttributes, AShellHasTheMomentsOfItsSurface) {
  // A number of these sums has some ten roundings of 1e-16.
  const auto expect = [](const std::string& geom, std::array<double, 4> closed) {
    const auto found = mass_and_moments(geom + " shellinertia='true'");
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(found[i], closed[i], 1e-14 * closed[0]) << geom << " " << i;
    }
  };
  const double circle = std::acos(-1.0);
  // A sphere has 2/3 m r^2, and by its density per area 4 pi r^2 kg.
  const double ball = 2.0 / 3.0 * 0.01;
  expect("type='sphere' size='.1' mass='1'", {1.0, ball, ball, ball});
  const double mass = 4.0 * circle * 0.01 * 3.0;
  expect("type='sphere' size='.1' density='3'", {mass, mass * ball, mass * ball, mass * ball});
  // A cube of the edge a has 5/18 m a^2.
  const double cube = 5.0 / 18.0 * 0.04;
  expect("type='box' size='.1 .1 .1' mass='1'", {1.0, cube, cube, cube});
  // A flat box is two sheets: m (a^2 + b^2) / 3 of half lengths, and 4 a b per sheet.
  const auto sheet = mass_and_moments("type='box' size='.3 .2 1e-9' mass='1' shellinertia='true'");
  EXPECT_NEAR(sheet[3], 0.13 / 3.0, 1e-8);
  EXPECT_NEAR(sheet[1], 0.04 / 3.0, 1e-8);
  // A cylinder of r = 0.1 and the length 0.4: side 2 pi r l = 0.08 pi, two caps 0.02 pi.
  const double across = 0.8 * (0.01 / 2.0 + 0.16 / 12.0) + 0.2 * (0.01 / 4.0 + 0.04);
  expect("type='cylinder' size='.1 .2' mass='1'", {1.0, across, across, 0.8 * 0.01 + 0.2 * 0.005});
  // A capsule of the same side: halves of 0.04 pi together, with their centres r / 2 beyond the side.
  const double half =
      2.0 / 3.0 * 0.01 - 0.25 * 0.01 + 0.25 * 0.25;  // about its own centre, and moved
  const double whole = 2.0 / 3.0 * (0.01 / 2.0 + 0.16 / 12.0) + 1.0 / 3.0 * half;
  expect("type='capsule' size='.1 .2' mass='1'",
         {1.0, whole, whole, 2.0 / 3.0 * 0.01 + 1.0 / 3.0 * ball});
}

TEST_F(ImportedAttributes, AnEllipsoidShellLiesBetweenTwoSolids) {
  // As in MuJoCo: the solid between the half axes and those that are longer by e, divided by its mass.
  // The difference quotient is off by e / 0.1, with rounding of 1e-16 / e.
  const std::array<double, 3> a{0.1, 0.2, 0.4};
  const double e = 1e-7;
  const auto found =
      mass_and_moments("type='ellipsoid' size='.1 .2 .4' mass='1' shellinertia='true'");
  const auto solid = [&](double more, std::size_t i) {
    const double volume = (a[0] + more) * (a[1] + more) * (a[2] + more);
    const double b = a[(i + 1) % 3] + more;
    const double c = a[(i + 2) % 3] + more;
    return std::array<double, 2>{volume, volume * (b * b + c * c) / 5.0};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const auto outer = solid(e, i);
    const auto inner = solid(0.0, i);
    const double closed = (outer[1] - inner[1]) / (outer[0] - inner[0]);
    EXPECT_NEAR(found[i + 1], closed, 1e-5 * closed) << i;
  }
  const auto round = mass_and_moments("type='ellipsoid' size='.1 .1 .1' shellinertia='true'");
  EXPECT_NEAR(round[0], 4000.0 * std::acos(-1.0) * 0.01, 1e-12 * round[0]);
  EXPECT_NEAR(round[1], round[0] * 2.0 / 3.0 * 0.01, 1e-12 * round[0]);
}

TEST_F(ImportedAttributes, AnActuatorTellsOfForcesBeyondItsRange) {
  const std::string body = "<body><joint name='j' type='slide'/><geom size='.1' mass='1'/></body>";
  const auto kind = [&](const std::string& actuator) {
    const std::string text = attribute_model(body, "<actuator>\n" + actuator + "</actuator>");
    return note_at(attribute_outcome(text), 6).taken;
  };
  using import::Taken;
  EXPECT_EQ(kind("<position joint='j' kp='10' kv='50' forcerange='-5 5'/>"), Taken::changed);
  EXPECT_EQ(kind("<position joint='j' kp='10' kv='50'/>"), Taken::same);
  EXPECT_EQ(kind("<position joint='j' kp='10' forcerange='-5 5'/>"), Taken::same);
  EXPECT_EQ(kind("<velocity joint='j' kv='10' forcerange='-5 5'/>"), Taken::changed);
}

TEST_F(ImportedAttributes, OptionsThatStopActuatorsAreTaken) {
  const std::string body = "<body><joint name='j' type='slide'/><geom size='.1' mass='1'/></body>";
  const std::string motor =
      "<actuator><motor joint='j' group='2' ctrlrange='-1 1' gear='3'/></actuator>"
      "<keyframe><key name='k' ctrl='5'/></keyframe>";
  const auto force = [&](const std::string& options) {
    const Outcome outcome = attribute_outcome(attribute_model(body, options + motor), "k");
    const json joint = json::parse(outcome.json)["joints"][0];
    return joint.contains("drive_values") ? joint["drive_values"][0].get<double>() : 0.0;
  };
  EXPECT_EQ(force(""), 3.0);
  EXPECT_EQ(force("<option><flag clampctrl='disable'/></option>"), 15.0);
  EXPECT_EQ(force("<option actuatorgroupdisable='1 2'/>"), 0.0);
  EXPECT_EQ(force("<option actuatorgroupdisable='1'/>"), 3.0);
}

TEST_F(ImportedAttributes, AttributesWithoutEffectHereAreTold) {
  const auto note = [](const std::string& joint) {
    const std::string text = attribute_model("<body>\n<joint name='j' type='slide' " + joint +
                                             "/>\n<geom size='.1'/></body>");
    return note_at(attribute_outcome(text), 4).text;
  };
  EXPECT_THAT(note("range='-1 1' margin='.1'"), HasSubstr("margin"));
  EXPECT_THAT(note("range='-1 1'"), testing::Not(HasSubstr("margin")));
  EXPECT_THAT(note("margin='.1'"), testing::Not(HasSubstr("margin")));
}

}  // namespace
}  // namespace sheave
