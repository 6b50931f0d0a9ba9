// Scaling: powers from units, and every unit of the format known.

#include "scenes/scaling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/format.h"

namespace sheave::test {
namespace {

using testing::SizeIs;

TEST(Scaling, PowersComeFromUnits) {
  const auto expect = [](std::string_view unit, int length, int mass, int time) {
    const auto powers = unit_powers(unit);
    ASSERT_TRUE(powers.has_value()) << unit;
    EXPECT_EQ(powers->length, length) << unit;
    EXPECT_EQ(powers->mass, mass) << unit;
    EXPECT_EQ(powers->time, time) << unit;
  };
  expect("", 0, 0, 0);
  expect("s", 0, 0, 1);
  expect("Hz", 0, 0, -1);
  expect("m", 1, 0, 0);
  expect("m/s2", 1, 0, -2);
  expect("kg/m3", -3, 1, 0);
  expect("kg m2", 2, 1, 0);
  expect("N", 1, 1, -2);
  expect("m/N", 0, -1, 2);
  expect("N s/m", 0, 1, -1);
  expect("N m s/rad", 2, 1, -1);
  expect("rad/(N m)", -2, -1, 2);
  EXPECT_FALSE(unit_powers("furlong").has_value());
  EXPECT_FALSE(unit_powers("rad/s, rad or N m").has_value());
}

/// Every unit in the format must be one that scaling understands, or three of them, one for each
/// kind of drive.
void expect_known_units(const ObjectFormat& format) {
  std::vector<TableFormat> tables = format.tables;
  for (const Variant& variant : format.variants) tables.push_back(variant.table);
  for (const TableFormat& table : tables) {
    for (const Field& field : table.fields) {
      const bool several = field.unit.find(" or ") != std::string_view::npos;
      EXPECT_TRUE(several || unit_powers(field.unit)) << format.name << "." << field.name;
      EXPECT_TRUE(!several || field.name.find("drive") != std::string_view::npos) << field.name;
    }
  }
  for (const Member& member : format.members) expect_known_units(*member.format);
}

TEST(Scaling, EveryUnitOfTheFormatIsKnown) { expect_known_units(scene_format()); }

TEST(Scaling, UnitOfADriveDependsOnItsKind) {
  const auto powers = [](const std::string& drive) {
    return scalable_settings(R"({"bodies": [{"drive": ")" + drive + R"(", "drive_values": [1]}]})");
  };
  EXPECT_THAT(powers("speed"), SizeIs(0));
  EXPECT_THAT(powers("angle"), SizeIs(0));
  ASSERT_THAT(powers("torque"), SizeIs(1));
  EXPECT_EQ(powers("torque")[0].pointer, "/bodies/0/drive_values");
  EXPECT_EQ(powers("torque")[0].powers, (UnitPowers{2, 1, -2}));
}

TEST(Scaling, ScalesNumbersVectorsAndLists) {
  EXPECT_EQ(scaled({"/a", "3", {1, 0, 0}}, 2.0).value, "6.0");
  EXPECT_EQ(scaled({"/a", "[1,[2,-3]]", {1, 0, 0}}, 2.0).value, "[2.0,[4.0,-6.0]]");
}

}  // namespace
}  // namespace sheave::test
