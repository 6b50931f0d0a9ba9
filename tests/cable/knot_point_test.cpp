// The place of a knot without mass against the laws at the head of cable/knot_point.h.

#include "cable/knot_point.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

/// Rounding of a few operations on lengths of some metres.
constexpr double place_rounding = 1e-13;

std::vector<KnotArm> random_arms(std::mt19937& random, int count, double compliance) {
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  std::uniform_real_distribution<double> reach(0.05, 0.8);
  std::vector<KnotArm> arms;
  for (int i = 0; i < count; ++i) {
    arms.push_back({{place(random), place(random), place(random)},
                    reach(random),
                    compliance * (1.0 + reach(random))});
  }
  return arms;
}

double largest_excess(const std::vector<KnotArm>& arms, const Vector3& point) {
  double most = -1e300;
  for (const KnotArm& arm : arms) most = std::max(most, (arm.end - point).norm() - arm.reach);
  return most;
}

Vector3 force_of(const std::vector<KnotArm>& arms, const KnotPlace& place) {
  Vector3 force = Vector3::Zero();
  for (std::size_t i = 0; i < arms.size(); ++i) {
    force += place.shares[i] * (arms[i].end - place.point).normalized();
  }
  return force;
}

/// C of the knot.
double value_of(const std::vector<KnotArm>& arms, const KnotPlace& place) {
  double value = 0.0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    value += place.shares[i] * (arms[i].reach - (arms[i].end - place.point).norm());
  }
  return value;
}

// No point near the one found has a smaller greatest excess: the function is convex, so the minimum is
// that of all points. At a distance d in a direction with a kink it is larger by about d, and in others
// by d^2 / r.
TEST(KnotPoint, RigidRopesHaveTheLeastExcess) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> way(-1.0, 1.0);
  for (const int count : {2, 3, 4}) {
    for (int trial = 0; trial < 200; ++trial) {
      const std::vector<KnotArm> arms = random_arms(random, count, 0.0);
      KnotPlace place;
      find_knot_place(arms, place);
      const double least = largest_excess(arms, place.point);
      EXPECT_NEAR(value_of(arms, place), -least, place_rounding);
      double sum = 0.0;
      for (std::size_t i = 0; i < arms.size(); ++i) {
        EXPECT_GE(place.shares[i], 0.0);
        sum += place.shares[i];
        if (place.shares[i] == 0.0) continue;
        EXPECT_NEAR((arms[i].end - place.point).norm() - arms[i].reach, least, 1e-11);
      }
      EXPECT_NEAR(sum, 1.0, place_rounding);
      EXPECT_LE(force_of(arms, place).norm(), 1e-11);
      for (int k = 0; k < 20; ++k) {
        const Vector3 other{way(random), way(random), way(random)};
        for (const double far : {1e-3, 0.3}) {
          EXPECT_GE(largest_excess(arms, place.point + far * other), least - place_rounding);
        }
      }
    }
  }
}

// The balance of elastic ropes, and the energy of the spring that stands for them.
TEST(KnotPoint, ElasticRopesBalance) {
  std::mt19937 random(11);
  for (const int count : {2, 3, 4}) {
    for (const double compliance : {1e-2, 1.0, 100.0}) {
      for (int trial = 0; trial < 100; ++trial) {
        const std::vector<KnotArm> arms = random_arms(random, count, compliance);
        KnotPlace place;
        find_knot_place(arms, place);
        if (!place.taut) continue;
        const double value = value_of(arms, place);
        double yield = 0.0;
        for (const KnotArm& arm : arms) yield += arm.compliance;
        const double force = -value / yield;
        double energy = 0.0;
        for (std::size_t i = 0; i < arms.size(); ++i) {
          const double stretch = std::max((arms[i].end - place.point).norm() - arms[i].reach, 0.0);
          EXPECT_NEAR(place.shares[i] * force, stretch / arms[i].compliance, 1e-11 * force);
          energy += 0.5 * stretch * stretch / arms[i].compliance;
        }
        EXPECT_NEAR(0.5 * value * value / yield, energy, 1e-12 * energy);
        EXPECT_LE(force_of(arms, place).norm(), 1e-11);
      }
    }
  }
}

// The gradient of C by the end of a rope is minus the share times the direction of the rope; the
// difference quotient of step d is off by d^2 times a third derivative of about 1 / length^2.
TEST(KnotPoint, GradientsAreSharesTimesDirections) {
  std::mt19937 random(3);
  constexpr double step = 1e-5;
  for (const double compliance : {0.0, 0.1}) {
    for (int trial = 0; trial < 100; ++trial) {
      std::vector<KnotArm> arms = random_arms(random, 3, compliance);
      KnotPlace place;
      find_knot_place(arms, place);
      double least = 1.0;
      for (const KnotArm& arm : arms) least = std::min(least, (arm.end - place.point).norm());
      const bool near_change =
          *std::min_element(place.shares.begin(), place.shares.end()) < 0.05 || least < 0.2;
      if (!place.taut || largest_excess(arms, place.point) < 0.1 || near_change) continue;
      for (std::size_t i = 0; i < arms.size(); ++i) {
        const Vector3 u = (arms[i].end - place.point).normalized();
        for (int axis = 0; axis < 3; ++axis) {
          const auto value_at = [&](double by) {
            std::vector<KnotArm> moved = arms;
            moved[i].end[axis] += by;
            KnotPlace other;
            find_knot_place(moved, other);
            return value_of(moved, other);
          };
          const double slope = (value_at(step) - value_at(-step)) / (2.0 * step);
          EXPECT_NEAR(slope, -place.shares[i] * u[axis], 1e-7);
        }
      }
    }
  }
}

// Two ropes end to end: the knot divides the distance in the ratio of their compliances.
TEST(KnotPoint, ASpliceIsOneRope) {
  const std::vector<KnotArm> arms{{{0.0, 0.0, 0.0}, 1.0, 0.1}, {{0.0, -4.0, 0.0}, 2.0, 0.3}};
  KnotPlace place;
  find_knot_place(arms, place);
  EXPECT_NEAR((place.point - Vector3(0.0, -1.25, 0.0)).norm(), 0.0, place_rounding);
  EXPECT_NEAR(value_of(arms, place), -1.0, place_rounding);  // the stretch of both
  EXPECT_NEAR(place.shares[0], 1.0, place_rounding);         // both have the tension of the row
  EXPECT_NEAR(place.shares[1], 1.0, place_rounding);
}

// A slack knot lies where its ropes have equally much to spare.
TEST(KnotPoint, ASlackKnotHasEqualSpareLengths) {
  const std::vector<KnotArm> arms{{{0.0, 0.0, 0.0}, 1.5, 0.0}, {{2.0, 0.0, 0.0}, 1.0, 0.0}};
  KnotPlace place;
  find_knot_place(arms, place);
  EXPECT_FALSE(place.taut);
  EXPECT_NEAR(value_of(arms, place), 0.25, place_rounding);
  EXPECT_NEAR((place.point - Vector3(1.25, 0.0, 0.0)).norm(), 0.0, place_rounding);
}

}  // namespace
}  // namespace sheave
