// Numbers of muscles that MuJoCo finds itself, acc0 and lengthrange, against MuJoCo's own.

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/import/mjcf/joint_motion.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using testing::HasSubstr;

class MuscleRanges : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

std::string whole_model(const std::string& name) {
  std::ifstream file(test::model_path(name + ".xml"));
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

const import::mjcf::MuscleLaw& law_of(const test::ReadModel& model, const std::string& name) {
  for (const import::mjcf::Actuator& actuator : model->actuators) {
    if (actuator.name == name && actuator.muscle && actuator.tendon >= 0) return *actuator.muscle;
  }
  throw std::runtime_error("no muscle " + name);
}

// Both follow the same procedure, step by step, and differ by its rounding, which the motion makes
// larger: 1e-8 of the range. acc0 is a solution of one linear system.
TEST_F(MuscleRanges, AreThoseOfMujoco) {
  std::size_t found = 0;
  for (const char* const name : {"arm26", "ranges"}) {
    const test::ReadModel model(whole_model(name));
    const auto reference =
        test::references(std::string(name) == "arm26" ? "arm26-muscles" : "ranges");
    for (const auto& row : reference["constants"]) {
      const import::mjcf::MuscleLaw& law = law_of(model, row["name"].get<std::string>());
      const std::vector<double> range = test::numbers(row["lengthrange"]);
      ASSERT_TRUE(law.length_range);
      for (const std::size_t i : {0U, 1U}) {
        EXPECT_NEAR((*law.length_range)[i], range[i], 1e-6 * (range[1] - range[0]))
            << name << ' ' << row["name"] << ' ' << i;
      }
      const double force = law.scale / row["acc0"].get<double>();
      const bool given = row["name"] == "reach" || row["name"] == "biceps";
      EXPECT_NEAR(law.force, given ? law.force : force, 1e-9 * force) << name << row["name"];
      ++found;
    }
  }
  EXPECT_EQ(found, 12U);
}

// The mass matrix and the arms against differences of kinetic energy and of lengths: a central
// difference of size 1e-5 has an error of 1e-10 and a rounding of 1e-11.
TEST_F(MuscleRanges, MatricesAgreeWithDifferences) {
  const test::ReadModel model(whole_model("ranges"));
  const std::vector<double> q{0.3, -0.2, 0.7, 0.02};
  const import::mjcf::Pose pose = pose_of(*model, q, {});
  const import::mjcf::JointMotion motion(*model, pose);
  const auto energy = [&](const std::vector<double>& u) {
    const import::mjcf::Pose moving = pose_of(*model, q, u);
    double sum = 0.0;
    for (std::size_t i = 1; i < model->bodies.size(); ++i) {
      const import::mjcf::Inertial own =
          model->bodies[i].inertial.seen_from(moving.bodies[i].frame);
      const import::mjcf::BodyPose& body = moving.bodies[i];
      const Vector3 v =
          body.velocity + body.angular_velocity.cross(own.center - body.frame.position);
      sum += 0.5 * own.mass * v.squaredNorm() +
             0.5 * body.angular_velocity.dot(own.inertia * body.angular_velocity);
    }
    return sum + 0.5 * 0.002 * u[0] * u[0];  // the armature of the shoulder
  };
  const auto mass = motion.mass_matrix();
  ASSERT_EQ(mass.rows(), 4);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      std::vector<double> both(4, 0.0);
      std::vector<double> one(4, 0.0);
      std::vector<double> other(4, 0.0);
      both[static_cast<std::size_t>(i)] += 1.0;
      both[static_cast<std::size_t>(j)] += 1.0;
      one[static_cast<std::size_t>(i)] = other[static_cast<std::size_t>(j)] = 1.0;
      EXPECT_NEAR(mass(i, j), energy(both) - energy(one) - energy(other), 1e-13) << i << j;
    }
  }
  for (const import::mjcf::Tendon& tendon : model->tendons) {
    const auto arms = motion.arms(*tendon_pull(*model, pose, tendon));
    for (std::size_t i = 0; i < 4; ++i) {
      const auto length = [&](double way) {
        std::vector<double> there = q;
        there[i] += way;
        return tendon_pull(*model, pose_of(*model, there, {}), tendon)->length;
      };
      const double difference = (length(1e-5) - length(-1e-5)) / 2e-5;
      EXPECT_NEAR(arms[static_cast<Eigen::Index>(i)], difference, 1e-9) << tendon.name << i;
    }
  }
}

std::string range_model(const std::string& joint, const std::string& muscle,
                        const std::string& more = "", const std::string& compiler = "") {
  return fmt::format(
      R"(<mujoco><compiler>{}</compiler><worldbody><site name="a" pos="0.1 0 0"/>
      <body name="b"><joint name="j" axis="0 1 0" {}/><geom size="0.1"/><site name="c" pos="0 0 -0.3"/></body></worldbody>
      <tendon><spatial name="t"><site site="a"/><site site="c"/></spatial></tendon>
      <actuator><muscle name="m" tendon="t" {}/></actuator>{}</mujoco>)",
      compiler, joint, muscle, more);
}

std::string notes_of(const std::string& text) {
  const import::Outcome made = import::import_model(text, "m.xml");
  std::string all;
  for (const import::Note& note : made.notes) {
    if (note.text.find("length") != std::string::npos) {
      all += fmt::format("{}: {}\n", note.line, note.text);
    }
  }
  for (const SceneError& error : made.errors) all += to_string(error) + "\n";
  return all;
}

TEST_F(MuscleRanges, WhatCannotBeFoundIsToldWithItsLine) {
  const std::string limited = R"(limited="true" range="-60 60")";
  EXPECT_THAT(notes_of(range_model(limited, "")), HasSubstr("found as MuJoCo does"));
  EXPECT_THAT(notes_of(range_model(limited, "force=\"5\"")), HasSubstr("a muscle of 5 N"));
  EXPECT_THAT(notes_of(range_model(limited, "", "", "<lengthrange mode=\"none\"/>")),
              HasSubstr("4: it has no lengthrange, and <lengthrange mode"));
  EXPECT_THAT(notes_of(range_model(limited, "", "", "<lengthrange uselimit=\"true\"/>")),
              HasSubstr("uselimit"));
  EXPECT_THAT(notes_of(range_model(limited, "", "", "<lengthrange timestep=\"0\"/>")),
              HasSubstr("> 0"));
  EXPECT_THAT(notes_of(range_model(limited, "", "", "<lengthrange timestep=\"1e-9\"/>")),
              HasSubstr("too large"));
  EXPECT_THAT(notes_of(range_model(limited, "",
                                   R"(<equality><connect body1="b" anchor="0 0 0"/></equality>)")),
              HasSubstr("equalities (line 4)"));
  // Along the line through the axis nothing moves the length.
  std::string along = range_model(limited, "");
  along.replace(along.find("0.1 0 0"), 7, "0 0 0.1");
  EXPECT_THAT(notes_of(along), HasSubstr("no joint moves it"));
}

// The site c moves on a circle of 0.3 m about the origin, and a is 0.1 m from there: all lengths are
// between 0.2 m and 0.4 m. The motion has not come to rest for good, so its extremes are near.
TEST_F(MuscleRanges, AJointWithoutLimitsGivesTheExtremesOfTheLength) {
  const test::ReadModel model(range_model("limited=\"false\"", ""));
  const auto range = *law_of(model, "m").length_range;
  EXPECT_NEAR(range[0], 0.2, 0.05 * 0.2);
  EXPECT_NEAR(range[1], 0.4, 0.05 * 0.2);
}

}  // namespace
}  // namespace sheave
