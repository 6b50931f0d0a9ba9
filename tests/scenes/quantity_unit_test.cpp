#include "scenes/quantity_unit.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/observables.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave {
namespace {

TEST(QuantityUnit, AgreesWithTheTables) {
  EXPECT_EQ(quantity_unit("t"), "s");
  EXPECT_EQ(quantity_unit("weight.vy"), "m/s");
  EXPECT_EQ(quantity_unit("rope.12.tension"), "N");
  EXPECT_EQ(quantity_unit("rope.link0.wrap_angle"), "rad");
  EXPECT_EQ(quantity_unit("rope.length_error"), "");
  EXPECT_EQ(quantity_unit("door.angle_rate"), "rad/s");
  EXPECT_EQ(quantity_unit("ram.travel"), "m");
  EXPECT_EQ(quantity_unit("ram.travel_drive_force"), "N");
  EXPECT_EQ(quantity_unit("power.friction"), "W");
  EXPECT_EQ(quantity_unit("winch.drive_force"), "N, N m");
  EXPECT_EQ(quantity_unit("rope.0.tensoin"), std::nullopt);
  EXPECT_EQ(quantity_unit("tension"), std::nullopt);
  EXPECT_EQ(quantity_unit(".x"), std::nullopt);
}

TEST(QuantityUnit, OfAnExpressionFollowsFromItsNames) {
  EXPECT_EQ(quantity_unit("a.x - b.x"), "m");
  EXPECT_EQ(quantity_unit("hoist rope.0.tension * 2"), "N");
  EXPECT_EQ(quantity_unit("(rope.1.tension - rope.0.tension) * 0.5"), "N");
  EXPECT_EQ(quantity_unit("my-rope.0.tension/2"), "N");
  EXPECT_EQ(quantity_unit("hypot(a.vx, 'a b'.vy)"), "m/s");
  EXPECT_EQ(quantity_unit("a.x * b.x / t"), "m2/s");
  EXPECT_EQ(quantity_unit("a.x + t"), std::nullopt);
  EXPECT_EQ(quantity_unit("a.tensoin * 2"), std::nullopt);
}

std::vector<std::string> parts(const std::string& units) {
  std::vector<std::string> result;
  std::size_t from = 0;
  for (std::size_t comma = units.find(", "); comma != std::string::npos;
       comma = units.find(", ", from)) {
    result.push_back(units.substr(from, comma - from));
    from = comma + 2;
  }
  result.push_back(units.substr(from));
  return result;
}

TEST(QuantityUnit, IsKnownOfEveryQuantityOfEveryShippedScene) {
  for (const auto& path : test::valid_scene_files()) {
    const SceneResult scene = load_scene(path.string());
    ASSERT_TRUE(scene) << path;
    const ObservableSet quantities(scene->model, scene->cables);
    for (int i = 0; i < static_cast<int>(quantities.names().size()); ++i) {
      const std::string& name = quantities.names()[static_cast<std::size_t>(i)];
      const std::optional<std::string> unit = quantity_unit(name);
      ASSERT_TRUE(unit.has_value()) << path << ": " << name;
      // By the name alone the joint is not known: then there are more.
      const std::vector<std::string> possible = parts(*unit);
      for (const std::string& part : parts(std::string(quantities.unit(i)))) {
        EXPECT_NE(std::find(possible.begin(), possible.end(), part), possible.end())
            << path << ": " << name << " is in " << quantities.unit(i) << ", not in " << *unit;
      }
    }
  }
}

}  // namespace
}  // namespace sheave
