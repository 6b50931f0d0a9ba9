// Similar scenes: powers from units, every setting found, and Newton's equations alike in both.

#include "measure/similarity.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/format.h"

namespace sheave::measure {
namespace {

using testing::SizeIs;

TEST(Similarity, PowersComeFromUnits) {
  const auto expect = [](std::string_view unit, int length, int mass) {
    const auto powers = unit_powers(unit);
    ASSERT_TRUE(powers.has_value()) << unit;
    EXPECT_EQ(powers->length, length) << unit;
    EXPECT_EQ(powers->mass, mass) << unit;
  };
  expect("", 0, 0);
  expect("s", 0, 0);
  expect("Hz", 0, 0);
  expect("m", 1, 0);
  expect("m/s2", 1, 0);
  expect("kg/m3", -3, 1);
  expect("kg m2", 2, 1);
  expect("N", 1, 1);
  expect("m/N", 0, -1);
  expect("N s/m", 0, 1);
  expect("N m s/rad", 2, 1);
  expect("rad/(N m)", -2, -1);
  EXPECT_FALSE(unit_powers("furlong").has_value());
  EXPECT_FALSE(unit_powers("rad/s, rad or N m").has_value());
}

/// Every unit in the format must be one that scaling understands, or three of them, one for each kind of drive.
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

TEST(Similarity, EveryUnitOfTheFormatIsKnown) { expect_known_units(scene_format()); }

TEST(Similarity, UnitOfADriveDependsOnItsKind) {
  const auto powers = [](const std::string& drive) {
    return scalable_settings(R"({"bodies": [{"drive": ")" + drive + R"(", "drive_values": [1]}]})");
  };
  EXPECT_THAT(powers("speed"), SizeIs(0));
  EXPECT_THAT(powers("angle"), SizeIs(0));
  ASSERT_THAT(powers("torque"), SizeIs(1));
  EXPECT_EQ(powers("torque")[0].pointer, "/bodies/0/drive_values");
  EXPECT_EQ(powers("torque")[0].powers, (UnitPowers{2, 1}));
}

TEST(Similarity, ScalesNumbersVectorsAndLists) {
  EXPECT_EQ(scaled({"/a", "3", {1, 0}}, 2.0).value, "6.0");
  EXPECT_EQ(scaled({"/a", "[1,[2,-3]]", {1, 0}}, 2.0).value, "[2.0,[4.0,-6.0]]");
}

std::string similarity_scene_path(const std::string& name) {
  return std::string(SHEAVE_SOURCE_DIR) + "/scenes/" + name;
}

Scene short_scene(const std::string& name, const std::vector<Override>& more) {
  std::vector<Override> overrides{{"/duration", "0.2", ""}, {"/checks", "[]", ""}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  SceneResult scene = load_scene(similarity_scene_path(name), overrides);
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

TEST(Similarity, ScenesOfAllSizesAndMassesMoveAlike) {
  // Factors that are powers of two change no digit, except where cable is counted in multiples of a power of two that the
  // size decides; 12 steps of some 40 roundings each stay far below 1e-9.
  for (const std::string name :
       {"analytic/atwood.json", "machines/crane.json", "paper/pulley.json"}) {
    std::ifstream file(similarity_scene_path(name));
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::vector<ScalableSetting> settings = scalable_settings(text);
    ASSERT_FALSE(settings.empty());
    const Scene original = short_scene(name, {});
    for (const auto& [length, mass] : {std::pair{1024.0, 1.0}, {1.0, 1.0 / 1024.0}}) {
      const Scene other = short_scene(name, similar_scene(settings, length, mass));
      const Result<double> error = similarity_error(other, original, length, mass);
      ASSERT_TRUE(error);
      EXPECT_LT(*error, 1e-9) << name << " " << length << " " << mass;
    }
    // What is not similar is told apart.
    const Scene heavier = short_scene(name, {{"/gravity", "[0, -30, 0]", ""}});
    EXPECT_GT(similarity_error(heavier, original, 1.0, 1.0).value(), 1e-3) << name;
  }
}

}  // namespace
}  // namespace sheave::measure
