// Distances of solids against brute force over directions, and manifolds against what geometry
// says.

#include "engine/contacts/manifold.h"

#include <gtest/gtest.h>

#include "engine/contacts/broad_phase.h"
#include "engine/contacts/contact_axis.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/half_space.h"
#include "tests/support/heaps.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

using test::Random;

std::vector<std::shared_ptr<const Shape>> all_shapes() {
  std::vector<Vector3> tetrahedron{{0, 0, 0}, {0.6, 0, 0.1}, {0.1, 0.7, 0}, {0.2, 0.2, 0.5}};
  return {test::ball(0.3),
          test::make<Capsule>([](Capsule& c) { c.radius = 0.2, c.length = 0.7; }),
          test::box({0.6, 0.4, 0.8}),
          test::make<Cylinder>([](Cylinder& c) { c.radius = 0.35, c.length = 0.5; }),
          test::polygon(test::ring(5, 0.4, 0.0), 0.3),
          test::polyhedron(tetrahedron),
          test::polyhedron(test::random_points(30, 7))};
}

/// Somewhere; one number after the other, in an order that no compiler chooses.
void place(const ConvexSolid& solid, double size, Random& random, PlacedSolid& placed) {
  const Vector3 position = random.vector(size);
  const Quaternion orientation = random.orientation();
  placed.place(solid, position, orientation);
}

/// The best gap of many directions, improved by random steps that become smaller.
double brute_force_gap(const PlacedSolid& a, const PlacedSolid& b, Random& random) {
  Vector3 best = Vector3::UnitX();
  double gap = -1e9;
  const auto attempt = [&](const Vector3& direction) {
    const Vector3 normal = direction.normalized();
    const double found = gap_along(a, b, normal);
    if (found > gap) gap = found, best = normal;
  };
  for (int i = 0; i < 600; ++i) attempt(random.vector(1.0));
  double step = 0.2;
  for (int i = 0; i < 1500; ++i, step *= 0.99) attempt(best + random.vector(step));
  return gap;
}

TEST(ContactAxis, NoDirectionIsBetter) {
  Random random(3);
  const auto shapes = all_shapes();
  for (const auto& first : shapes) {
    for (const auto& second : shapes) {
      const ConvexSolid solid_a = first->solid();
      const ConvexSolid solid_b = second->solid();
      for (int k = 0; k < 12; ++k) {
        PlacedSolid a;
        PlacedSolid b;
        place(solid_a, 0.5, random, a);
        place(solid_b, 0.5, random, b);
        const ContactAxis axis = contact_axis(a, b, 1e9);
        const double brute = brute_force_gap(a, b, random);
        SCOPED_TRACE(std::string(first->type()) + " and " + std::string(second->type()) + ", gap " +
                     std::to_string(brute));
        ASSERT_NEAR(axis.normal.norm(), 1.0, 1e-12);
        EXPECT_NEAR(axis.gap, gap_along(a, b, axis.normal), 1e-12);
        // Solids with corners that are apart may be nearer along the axis than they are: then both
        // corners stand out.
        if (brute > 0.0) {
          EXPECT_GT(axis.gap, 0.0);
          const bool exact = a.is_round() && (b.is_round() || !b.solid->faces.empty());
          if (!exact) continue;
        }
        // The rim of a cylinder that overlaps an edge or a rim deeply (here by some 0.1 m) is
        // searched for, and the search ends on ridges between two edges: within 0.1 % of the depth.
        const bool rim = (a.is(ConvexSolid::Kind::cylinder) && !b.is_round()) ||
                         (b.is(ConvexSolid::Kind::cylinder) && !a.is_round());
        EXPECT_GE(axis.gap, brute - (rim ? 2e-4 : 1e-8));
      }
    }
  }
}

TEST(ContactAxis, IsTheSameFromBothSides) {
  Random random(5);
  const auto shapes = all_shapes();
  for (const auto& first : shapes) {
    for (const auto& second : shapes) {
      const ConvexSolid solid_a = first->solid();
      const ConvexSolid solid_b = second->solid();
      PlacedSolid a;
      PlacedSolid b;
      place(solid_a, 0.4, random, a);
      place(solid_b, 0.4, random, b);
      const ContactAxis ab = contact_axis(a, b, 1e9);
      const ContactAxis ba = contact_axis(b, a, 1e9);
      EXPECT_NEAR(ab.gap, ba.gap, 1e-12);
      EXPECT_LT((ab.normal + ba.normal).norm(), 1e-9) << first->type() << " and " << second->type();
    }
  }
}

TEST(Manifold, PointsLieOnBothSurfaces) {
  Random random(11);
  const auto shapes = all_shapes();
  Manifold manifold;
  int points = 0;
  for (const auto& first : shapes) {
    for (const auto& second : shapes) {
      const ConvexSolid solid_a = first->solid();
      const ConvexSolid solid_b = second->solid();
      for (int k = 0; k < 20; ++k) {
        PlacedSolid a;
        PlacedSolid b;
        place(solid_a, 0.5, random, a);
        place(solid_b, 0.5, random, b);
        find_contacts(a, b, 0.02, manifold);
        const ContactAxis axis = contact_axis(a, b, 0.02);
        EXPECT_FALSE(axis.gap < 0.0 && manifold.points.empty());
        EXPECT_LE(manifold.points.size(), Manifold::most_points);
        for (const ContactPoint& point : manifold.points) {
          ++points;
          EXPECT_LE(point.gap, 0.02);
          // Sides of cylinders count as facing the other solid when they nearly do.
          const bool cylinder =
              a.is(ConvexSolid::Kind::cylinder) || b.is(ConvexSolid::Kind::cylinder);
          EXPECT_GE(point.gap, axis.gap - (cylinder ? 1e-2 : 1e-9))
              << first->type() << " and " << second->type();
          EXPECT_NEAR(
              manifold.normal.dot(point.core_a - point.core_b) - point.radius_a - point.radius_b,
              point.gap, 1e-12);
        }
      }
    }
  }
  EXPECT_GT(points, 500);
}

TEST(Manifold, HasTheRightNumberOfPointsForEachPairOfShapes) {
  Manifold manifold;
  const auto count = [&](const std::shared_ptr<const Shape>& above, const Quaternion& turn,
                         double height, const std::shared_ptr<const Shape>& below) {
    const ConvexSolid solid_a = above->solid();
    const ConvexSolid solid_b = below->solid();
    PlacedSolid a;
    PlacedSolid b;
    a.place(solid_a, {0.05, height, -0.03}, turn);
    b.place(solid_b, Vector3::Zero(), Quaternion::Identity());
    find_contacts(a, b, 1e-3, manifold);
    for (const ContactPoint& point : manifold.points) EXPECT_NEAR(point.gap, 0.0, 1e-12);
    EXPECT_LT((manifold.normal - Vector3::UnitY()).norm(), 1e-9);
    return manifold.points.size();
  };
  const auto plate = test::box({4.0, 1.0, 4.0});
  const auto none = Quaternion::Identity();
  const auto lying = rotation_by({0.5 * pi, 0.0, 0.0});
  const auto wheel = test::make<Cylinder>([](Cylinder& c) { c.radius = 0.35, c.length = 0.5; });
  const auto rod = test::make<Capsule>([](Capsule& c) { c.radius = 0.2, c.length = 0.7; });
  EXPECT_EQ(count(test::ball(0.3), none, 0.8, plate), 1U);
  EXPECT_EQ(count(rod, none, 0.7, plate), 2U);
  EXPECT_EQ(count(rod, lying, 0.5 + 0.35 + 0.2, plate), 1U);
  EXPECT_EQ(count(test::box({0.6, 0.4, 0.8}), none, 0.7, plate), 4U);
  EXPECT_EQ(count(test::box({0.6, 0.4, 0.8}), rotation_by({0.0, 0.7, 0.0}), 0.7, plate), 4U);
  EXPECT_EQ(count(wheel, none, 0.85, plate), 2U);
  EXPECT_EQ(count(wheel, lying, 0.75, plate), 4U);
  EXPECT_EQ(count(test::polygon(test::ring(12, 0.4, 0.0), 0.3), lying, 0.65, plate), 4U);
  const auto floor = std::make_shared<HalfSpace>();
  EXPECT_EQ(count(test::box({0.6, 0.4, 0.8}), none, 0.2, floor), 4U);
  EXPECT_EQ(count(wheel, none, 0.35, floor), 2U);
  EXPECT_EQ(count(wheel, lying, 0.25, floor), 4U);
  EXPECT_EQ(count(rod, none, 0.2, floor), 2U);
}

TEST(BroadPhase, FindsOverlappingPairsInOrder) {
  Random random(1);
  BroadPhase broad;
  std::vector<Bounds> boxes(60);
  for (int round = 0; round < 20; ++round) {
    for (Bounds& box : boxes) {
      box.low = random.vector(3.0);
      box.high = box.low + Vector3::Constant(random.between(0.1, 1.5));
    }
    boxes[7] = {Vector3::Constant(-1e300), Vector3::Constant(1e300)};
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < 60; ++i) {
      for (int j = i + 1; j < 60; ++j) {
        if (boxes[static_cast<std::size_t>(i)].overlaps(boxes[static_cast<std::size_t>(j)])) {
          expected.emplace_back(i, j);
        }
      }
    }
    const auto found = broad.find(boxes);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
  }
}

}  // namespace
}  // namespace sheave
