// What a loader sees of shapes: the registry, the field tables and the faults they report.

#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "engine/shape.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"

namespace sheave {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ShapeRegistry, MakesEveryTypeUnderItsName) {
  std::set<std::string_view> names;
  for (const TypeEntry<Shape>& entry : shape_types()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.meaning.empty());
    const std::unique_ptr<Shape> shape = entry.make();
    EXPECT_EQ(shape->type(), entry.name);
    EXPECT_FALSE(entry.fields().empty());
  }
  EXPECT_EQ(names,
            (std::set<std::string_view>{"box", "sphere", "cylinder", "capsule", "cone", "torus",
                                        "ellipsoid", "prism", "polyhedron", "half-space"}));
}

TEST(ShapeRegistry, SizesAreRequiredPositiveLengths) {
  for (const TypeEntry<Shape>& entry : shape_types()) {
    if (!entry.make()->bounded()) continue;  // it has no size
    for (const Field& setting : entry.fields()) {
      if (setting.name == "top_radius") continue;  // 0 is the tip of a cone
      EXPECT_EQ(setting.presence, Presence::required) << entry.name << '.' << setting.name;
      EXPECT_EQ(setting.unit, "m");
      const std::unique_ptr<Shape> shape = entry.make();
      // The settings pointer is what the table's slots expect.
      const FieldSlot slot = setting.slot(const_cast<void*>(shape->settings()));
      if (auto* const* number = std::get_if<double*>(&slot)) {
        EXPECT_TRUE(setting.range.contains(**number)) << "default of " << setting.name;
        EXPECT_FALSE(setting.range.contains(0.0));
      }
    }
  }
}

TEST(ShapeRegistry, SettingsWrittenThroughTheTableReachTheShape) {
  for (const TypeEntry<Shape>& entry : shape_types()) {
    if (entry.name != "sphere" && entry.name != "box") continue;
    const std::unique_ptr<Shape> shape = entry.make();
    const FieldSlot slot = entry.fields()[0].slot(const_cast<void*>(shape->settings()));
    if (entry.name == "sphere") *std::get<double*>(slot) = 3.0;
    if (entry.name == "box") *std::get<Vector3*>(slot) = Vector3(6.0, 6.0, 6.0);
    EXPECT_EQ(shape->half_extent(), Vector3::Constant(3.0));
  }
}

TEST(PlacedShape, TableReachesItsPlacement) {
  PlacedShape placed;
  const std::span<const Field> table = PlacedShape::field_table();
  ASSERT_EQ(table.size(), 3U);
  EXPECT_EQ(std::get<Vector3*>(table[0].slot(&placed)), &placed.position);
  EXPECT_EQ(std::get<Quaternion*>(table[1].slot(&placed)), &placed.orientation);
  EXPECT_EQ(std::get<std::optional<double>*>(table[2].slot(&placed)), &placed.density);
}

/// The path and message of the only fault.
std::string only_fault(const Shape& shape) {
  const Errors errors = shape.validate("/bodies/2/shapes/0");
  if (errors.size() != 1) return std::to_string(errors.size()) + " faults";
  return errors[0].path + ": " + errors[0].message;
}

TEST(Polyhedron, ReportsPointsThatEncloseNoVolume) {
  Polyhedron shape;
  EXPECT_EQ(only_fault(shape),
            "/bodies/2/shapes/0/points: points: 0 points are given; between 4 and 4096 are needed");
  const std::string flat =
      "/bodies/2/shapes/0/points: points: the points enclose no volume; at least four points that "
      "do not lie in one plane are needed";
  shape.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(only_fault(shape), flat);
  EXPECT_EQ(shape.unit_density().mass, 0.0);
  EXPECT_TRUE(shape.hull().triangles.empty());
  shape.points = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {3, 3, 3}};
  EXPECT_EQ(only_fault(shape), flat);
  shape.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, nan}};
  EXPECT_NE(only_fault(shape).find("points: the points must be finite"), std::string::npos);
  shape.points.assign(4097, Vector3::Zero());
  EXPECT_NE(only_fault(shape).find("4097 points are given"), std::string::npos);
  shape.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
  EXPECT_EQ(only_fault(shape), "0 faults");
  EXPECT_EQ(shape.hull().triangles.size(), 4U);
}

TEST(Prism, ReportsAnOutlineThatEnclosesNoArea) {
  Prism shape;
  EXPECT_EQ(only_fault(shape),
            "/bodies/2/shapes/0/outline: outline: 0 points are given; between 3 "
            "and 4096 are needed");
  shape.outline = {{0, 0, 0}, {1, 2, 0}, {2, 4, 0}};
  EXPECT_EQ(only_fault(shape),
            "/bodies/2/shapes/0/outline: outline: the points enclose no area; at least three "
            "points that do not lie on one line are needed");
  EXPECT_EQ(shape.unit_density().mass, 0.0);
  EXPECT_TRUE(shape.hull().empty());
  shape.outline = {{0, 0, 0}, {1, 0, 0}, {0, nan, 0}};
  EXPECT_NE(only_fault(shape).find("outline: the points must be finite"), std::string::npos);
  shape.outline = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(only_fault(shape), "0 faults");
  EXPECT_EQ(shape.hull().size(), 3U);
}

TEST(Prism, ReportsPointsOutsideThePlaneOfTheOutline) {
  Prism shape;
  shape.outline = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.25}};
  EXPECT_NE(only_fault(shape).find("/outline/2: outline: this point has z = 0.25"),
            std::string::npos)
      << only_fault(shape);
  shape.outline[2].z() = 1e-15;  // the rounding of a rotation is no fault
  EXPECT_EQ(only_fault(shape), "0 faults");
}

}  // namespace
}  // namespace sheave
