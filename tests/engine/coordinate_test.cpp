// What is wrong with the settings along a joint's coordinate: where the error points and what it
// says.

#include "engine/joints/coordinate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sheave {
namespace {

Errors errors_of(const JointCoordinate& coordinate) {
  Errors errors;
  check_coordinate(coordinate, "door", "/joints/3", "angle_", errors);
  return errors;
}

/// Expects one error at this field with this text.
void expect_error(const JointCoordinate& coordinate, const std::string& field,
                  const std::string& message) {
  const Errors errors = errors_of(coordinate);
  ASSERT_EQ(errors.size(), 1U) << field << ": " << message;
  EXPECT_EQ(errors[0].path, "/joints/3/angle_" + field);
  EXPECT_THAT(errors[0].message, testing::StartsWith("joint \"door\": "));
  EXPECT_THAT(errors[0].message, testing::HasSubstr(message));
}

JointCoordinate driven(CoordinateDrive drive, std::vector<double> values,
                       std::vector<double> times = {}) {
  JointCoordinate coordinate;
  coordinate.drive = drive;
  coordinate.drive_values = std::move(values);
  coordinate.drive_times = std::move(times);
  return coordinate;
}

TEST(JointCoordinate, AcceptsNoSettings) { EXPECT_TRUE(errors_of({}).empty()); }

TEST(JointCoordinate, AcceptsAllSettingsTogether) {
  JointCoordinate all = driven(CoordinateDrive::position, {0.0, 1.0}, {0.0, 2.0});
  all.lower = -1.0;
  all.upper = 2.0;
  all.limit_compliance = 1e-6;
  all.stiffness = 100.0;
  all.rest = 0.5;
  all.damping = 3.0;
  all.friction = 1.0;
  all.drive_amplitude = 0.1;
  all.drive_frequency = 2.0;
  all.drive_limit = 50.0;
  all.drive_compliance = 1e-3;
  EXPECT_TRUE(errors_of(all).empty());
}

TEST(JointCoordinate, StopsEncloseTheStart) {
  JointCoordinate stops;
  stops.lower = 0.0;
  stops.upper = 0.0;
  EXPECT_TRUE(errors_of(stops).empty()) << "held at 0";
  stops.lower = 0.25;
  stops.upper = 0.5;
  expect_error(stops, "lower", "a rigid lower stop must be at most 0, not 0.25");
  stops.lower = -0.5;
  stops.upper = -0.25;
  expect_error(stops, "upper", "a rigid upper stop must be at least 0, not -0.25");
  // An elastic stop may be pressed from the start.
  stops.limit_compliance = 1e-4;
  EXPECT_TRUE(errors_of(stops).empty());
}

TEST(JointCoordinate, StopsMustNotCross) {
  JointCoordinate stops;
  stops.lower = 1.0;
  stops.upper = -1.0;
  expect_error(stops, "lower", "the lower stop 1 lies above the upper one -1");
}

TEST(JointCoordinate, ComplianceOfStopsNeedsAStop) {
  JointCoordinate coordinate;
  coordinate.limit_compliance = 1e-4;
  expect_error(coordinate, "limit_compliance", "there are no stops");
  coordinate.upper = 1.0;
  EXPECT_TRUE(errors_of(coordinate).empty());
}

TEST(JointCoordinate, ARestNeedsASpring) {
  JointCoordinate coordinate;
  coordinate.rest = 0.3;
  expect_error(coordinate, "rest", "give a stiffness too");
  coordinate.stiffness = 1.0;
  EXPECT_TRUE(errors_of(coordinate).empty());
}

TEST(JointCoordinate, SettingsOfADriveNeedADrive) {
  std::vector<JointCoordinate> cases(5);
  cases[0].drive_values = {1.0};
  cases[1].drive_times = {1.0};
  cases[2].drive_amplitude = 1.0;
  cases[3].drive_limit = 1.0;
  cases[4].drive_compliance = 1.0;
  for (const JointCoordinate& coordinate : cases) {
    expect_error(coordinate, "drive", "settings of a drive need a drive");
  }
}

TEST(JointCoordinate, ADriveNeedsSomethingToFollow) {
  expect_error(driven(CoordinateDrive::speed, {}), "drive_values",
               "a drive needs values or an amplitude");
  JointCoordinate sine = driven(CoordinateDrive::speed, {});
  sine.drive_amplitude = 1.0;
  expect_error(sine, "drive_frequency", "a sine needs a frequency above 0");
  sine.drive_frequency = 1.0;
  EXPECT_TRUE(errors_of(sine).empty());
}

TEST(JointCoordinate, ValuesAndTimesMustMatch) {
  expect_error(driven(CoordinateDrive::speed, {1.0, 2.0}), "drive_values", "there are 2 and 0");
  expect_error(driven(CoordinateDrive::speed, {1.0}, {0.0, 1.0}), "drive_values",
               "there are 1 and 2");
  EXPECT_TRUE(errors_of(driven(CoordinateDrive::speed, {1.0})).empty());
  EXPECT_TRUE(errors_of(driven(CoordinateDrive::speed, {1.0}, {2.0})).empty());
}

TEST(JointCoordinate, TimesMustIncrease) {
  expect_error(driven(CoordinateDrive::speed, {1.0, 2.0, 3.0}, {0.0, 1.0, 1.0}), "drive_times/2",
               "times must increase");
  expect_error(driven(CoordinateDrive::speed, {1.0, 2.0, 3.0}, {1.0, 0.0, -1.0}), "drive_times/1",
               "times must increase");
}

TEST(JointCoordinate, OnlyPositionsGiveAndForcesHaveNoLimit) {
  JointCoordinate force = driven(CoordinateDrive::force, {1.0});
  force.drive_limit = 2.0;
  expect_error(force, "drive_limit", "leave the limit out");
  JointCoordinate speed = driven(CoordinateDrive::speed, {1.0});
  speed.drive_limit = 2.0;
  EXPECT_TRUE(errors_of(speed).empty());
  speed.drive_compliance = 0.1;
  expect_error(speed, "drive_compliance", "only a drive to a position can have compliance");
}

TEST(JointCoordinate, ARigidPositionBeginsWhereTheJointIs) {
  expect_error(driven(CoordinateDrive::position, {0.5}), "drive_values", "at 0, not at 0.5");
  JointCoordinate limited = driven(CoordinateDrive::position, {0.5});
  limited.drive_limit = 10.0;
  EXPECT_TRUE(errors_of(limited).empty());
  JointCoordinate soft = driven(CoordinateDrive::position, {0.5});
  soft.drive_compliance = 1e-3;
  EXPECT_TRUE(errors_of(soft).empty());
  EXPECT_TRUE(errors_of(driven(CoordinateDrive::position, {0.0, 0.5}, {0.0, 1.0})).empty());
  // A sine counts too: -0.2 + 0.2 sin(pi / 2) is 0.
  JointCoordinate sine = driven(CoordinateDrive::position, {-0.2});
  sine.drive_amplitude = 0.2;
  sine.drive_frequency = 1.0;
  sine.drive_phase = 1.5707963267948966;
  EXPECT_TRUE(errors_of(sine).empty());
  sine.drive_phase = 0.0;
  expect_error(sine, "drive_values", "at 0, not at -0.2");
}

TEST(JointCoordinate, ActsIfAnySettingActs) {
  EXPECT_FALSE(JointCoordinate{}.acts());
  EXPECT_TRUE(driven(CoordinateDrive::force, {1.0}).acts());
  JointCoordinate upper;
  upper.upper = 1.0;
  EXPECT_TRUE(upper.acts());
  JointCoordinate friction;
  friction.friction = 1.0;
  EXPECT_TRUE(friction.acts());
}

}  // namespace
}  // namespace sheave
