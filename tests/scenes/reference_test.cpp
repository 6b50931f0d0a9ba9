#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/format.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

TEST(Reference, NamesEveryKeyWithItsMeaning) {
  const std::string text = scene_reference();
  const auto expect_table = [&](std::span<const Field> fields) {
    for (const Field& field : fields) {
      EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(field.name) + "` |"));
      EXPECT_FALSE(field.meaning.empty()) << field.name;
    }
  };
  for (const ObjectFormat* format :
       {&scene_format(), &step_format(), &body_format(), &shape_format(), &joint_format(),
        &ground_format(), &cable_format(), &link_format(), &camera_format(), &camera_key_format(),
        &parameter_format(), &annotation_format(), &paint_format(), &check_format()}) {
    EXPECT_THAT(text, testing::HasSubstr("\n## " + std::string(format->name) + "\n"));
    for (const TableFormat& table : format->tables) expect_table(table.fields);
    for (const Member& member : format->members) {
      EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(member.name) + "` |"));
    }
    for (const Variant& variant : format->variants) {
      EXPECT_THAT(text, testing::HasSubstr("`\"" + std::string(variant.name) + "\"`\n"));
      expect_table(variant.table.fields);
    }
  }
}

TEST(Reference, ShowsRangesUnitsAndDefaults) {
  const std::string text = scene_reference();
  EXPECT_THAT(text, testing::HasSubstr("| `mass` | a number > 0 [kg] |  |"));
  EXPECT_THAT(text, testing::HasSubstr("| `substeps` | an integer 1 ... 100000 | `4` |"));
  EXPECT_THAT(text, testing::HasSubstr("| `gravity` | [x, y, z], numbers [m/s2] | required |"));
}

TEST(Names, KeepColumnsUnambiguous) {
  for (const char* good : {"a", "A1", "left wheel", "x_1-2", "0"})
    EXPECT_TRUE(is_name(good)) << good;
  for (const char* bad : {"", " a", "a ", "a.b", "a,b", "a\"", "a\n", "\xC3\xA4", "a/b", "a\tb"}) {
    EXPECT_FALSE(is_name(bad)) << bad;
  }
  EXPECT_TRUE(is_name(std::string(128, 'n')));
  EXPECT_FALSE(is_name(std::string(129, 'n')));
}

}  // namespace
}  // namespace sheave
