#include "cable/slack_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

const Vector3 down{0.0, -9.81, 0.0};

/// Length of the piece from s = a to b by chords, halved where they fall short of b - a.
double piece_length(const SlackCurve& c, double a, double b, int depth) {
  const double m = 0.5 * (a + b);
  const Vector3 pa = c.point(a);
  const Vector3 pm = c.point(m);
  const Vector3 pb = c.point(b);
  const double fine = (pm - pa).norm() + (pb - pm).norm();
  if (depth == 0 || std::abs(fine - (b - a)) < 1e-10 * c.length()) return fine;
  return piece_length(c, a, m, depth - 1) + piece_length(c, m, b, depth - 1);
}

double arc_length(const SlackCurve& c) {
  double sum = 0.0;
  constexpr int pieces = 64;
  for (int i = 0; i < pieces; ++i) {
    sum += piece_length(c, c.length() * i / pieces, c.length() * (i + 1) / pieces, 30);
  }
  return sum;
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " against " << b.transpose();
}

struct Case {
  Vector3 start, end;
  double length;
};

class SlackCurveCases : public testing::TestWithParam<Case> {};

TEST_P(SlackCurveCases, HasItsLengthAndItsEnds) {
  const auto& [start, end, length] = GetParam();
  const SlackCurve c(start, end, length, down);
  EXPECT_EQ(c.length(), length);
  EXPECT_NEAR(arc_length(c), length, 1e-6 * length);
  EXPECT_EQ(c.point(0.0), start);
  EXPECT_EQ(c.point(length), end);
  // The formula itself, not only the special case, reaches the second end.
  expect_near(c.point(length * (1.0 - 1e-12)), end, 1e-9 * length);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SlackCurveCases,
    testing::Values(Case{{0, 0, 0}, {1, 0, 0}, 1.5},                    // level
                    Case{{0, 0, 0}, {1, 0.8, 0.3}, 1.5},                // to a higher end
                    Case{{0, 5, 0}, {1, 0.8, 0.3}, 6.0},                // to a lower end
                    Case{{-3, 2, 7}, {-3, 1, 7}, 4.0},                  // one end under the other
                    Case{{0, 0, 0}, {1e-14, 1, 0}, 3.0},                // nearly so
                    Case{{0, 0, 0}, {1e-7, 1, 0}, 3.0},                 //
                    Case{{0, 0, 0}, {1e-3, -1, 0}, 1.1},                //
                    Case{{2, 2, 2}, {2, 2, 2}, 1.0},                    // both ends at one place
                    Case{{0, 0, 0}, {1, 0, 0}, 1.0 + 1e-6},             // nearly taut
                    Case{{0, 0, 0}, {1, 1, 0}, std::sqrt(2.0) + 1e-9},  //
                    Case{{0, 0, 0}, {1, 0, 0}, 1.0 + 1e-12},            //
                    Case{{0, 0, 0}, {1, 0, 0}, 1000.0},                 // very slack
                    Case{{0, 0, 0}, {1e-3, 0.5, 0}, 1e4},               //
                    Case{{1e4, 1e4, 0}, {1e4 + 1, 1e4, 0}, 2.0},        // far away
                    Case{{0, 0, 0}, {1e-5, 0, 0}, 3e-5}));              // tiny

TEST(SlackCurve, AgreesWithTheClosedFormWhereEndsAreLevel) {
  // y = a cosh(x/a) between x = -w and w: length 2 a sinh(w/a), sag a (cosh(w/a) - 1).
  for (const double a : {0.05, 0.3, 1.0, 4.0, 200.0}) {
    const double w = 1.3;
    const double length = 2.0 * a * std::sinh(w / a);
    const SlackCurve c({-w, 0, 0}, {w, 0, 0}, length, down);
    const double sag = a * (std::cosh(w / a) - 1.0);
    expect_near(c.point(0.5 * length), {0.0, -sag, 0.0}, 1e-10 * length);
    for (const double x : {-1.2, -0.7, 0.4, 1.1}) {
      const double s = a * std::sinh(x / a) + 0.5 * length;
      expect_near(c.point(s), {x, a * std::cosh(x / a) - a - sag, 0.0}, 1e-9 * length);
    }
  }
}

TEST(SlackCurve, IsSymmetricInItsEnds) {
  const Vector3 p{0.2, 1.0, -0.4};
  const Vector3 q{1.5, 0.3, 0.9};
  const SlackCurve forth(p, q, 3.0, down);
  const SlackCurve back(q, p, 3.0, down);
  for (const double s : {0.1, 0.9, 1.7, 2.8}) {
    expect_near(forth.point(s), back.point(3.0 - s), 1e-12);
  }
}

TEST(SlackCurve, HangsAlongGravityOfAnyDirection) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Vector3 p{number(random), number(random), number(random)};
    const Vector3 q{number(random), number(random), number(random)};
    const Vector3 gravity{number(random), number(random), number(random)};
    const double length = (q - p).norm() * (1.0 + std::exp(12.0 * number(random) - 6.0));
    const SlackCurve c(p, q, length, gravity);
    EXPECT_NEAR(arc_length(c), length, 1e-6 * length);
    // The curve stays in the upright plane through its ends and below the straight line.
    const Vector3 middle = c.point(0.5 * length);
    EXPECT_NEAR((q - p).cross(gravity).dot(middle - p), 0.0, 1e-9 * length);
    EXPECT_GT(gravity.dot(middle - 0.5 * (p + q)), 0.0);
  }
}

TEST(SlackCurve, TooShortIsStraight) {
  const SlackCurve c({0, 0, 0}, {3, 4, 0}, 2.0, down);
  EXPECT_TRUE(c.is_straight());
  EXPECT_EQ(c.length(), 5.0);
  expect_near(c.point(2.5), {1.5, 2.0, 0.0}, 1e-15);
  EXPECT_EQ(c.point_count(1e-3), 2U);
}

TEST(SlackCurve, WithoutGravityHangsAlongMinusY) {
  const SlackCurve c({0, 0, 0}, {1, 0, 0}, 2.0, Vector3::Zero());
  EXPECT_LT(c.point(1.0).y(), -0.5);
}

/// The polyline of a curve.
std::vector<Vector3> polyline(const SlackCurve& curve, double tolerance) {
  std::vector<Vector3> points(curve.point_count(tolerance));
  curve.write(tolerance, points);
  return points;
}

/// Distance of a point from a polyline [m].
double distance_from(const std::vector<Vector3>& line, const Vector3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vector3 along = line[k] - line[k - 1];
    const double square = along.squaredNorm();
    const double share =
        square > 0.0 ? std::clamp((p - line[k - 1]).dot(along) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - line[k - 1] - share * along).norm());
  }
  return least;
}

TEST(SlackCurve, PolylineReachesTheBottomOfATightFold) {
  // 10 m of cable between ends 1 mm apart hang 5 m down in a narrow loop.
  const SlackCurve c({0, 0, 0}, {1e-3, 0, 0}, 10.0, down);
  const std::vector<Vector3> points = polyline(c, 1e-3);
  double lowest = 0.0;
  for (const Vector3& p : points) lowest = std::min(lowest, p.y());
  EXPECT_NEAR(lowest, -5.0, 1e-3);
  EXPECT_EQ(points.front(), Vector3(0, 0, 0));
  EXPECT_EQ(points.back(), Vector3(1e-3, 0, 0));
  EXPECT_EQ(polyline(SlackCurve({0, 0, 0}, {0, 1, 0}, 3.0, down), 1e-3),
            (std::vector<Vector3>{{0, 0, 0}, {0, -1, 0}, {0, 1, 0}}));
}

TEST(SlackCurve, PolylineStaysWithinItsTolerance) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const Vector3 p{number(random), number(random), number(random)};
    const Vector3 q{number(random), number(random), number(random)};
    const double length = (q - p).norm() * (1.0 + std::exp(12.0 * number(random) - 6.0));
    const double tolerance = length * std::exp(4.0 * number(random) - 8.0);
    const SlackCurve c(p, q, length, down);
    const std::vector<Vector3> line = polyline(c, tolerance);
    for (int k = 0; k <= 200; ++k) {
      ASSERT_LE(distance_from(line, c.point(length * k / 200)), tolerance) << i << ' ' << k;
    }
    // The number of steps is inversely proportional to the root of the tolerance.
    EXPECT_LE(line.size(), 3 + 2 * c.point_count(4.0 * tolerance));
  }
}

TEST(SlackCurve, OfForcesIsTheCurveOfItsLength) {
  // The tension of an inextensible rope is w a across and w s' up, with the weight w per length and
  // the length s' from the lowest point.
  const double a = 0.7;
  const double weight = 5.0;  // [N/m]
  const double u0 = -1.1;
  const double u1 = 0.6;
  const Vector3 start{a * u0, a * std::cosh(u0), 0};
  const Vector3 end{a * u1, a * std::cosh(u1), 0};
  const double length = a * (std::sinh(u1) - std::sinh(u0));
  const Vector3 start_force{weight * a, weight * a * std::sinh(u0), 0};
  const Vector3 end_force{-weight * a, -weight * a * std::sinh(u1), 0};
  const std::vector<Vector3> expected = polyline(SlackCurve(start, end, length, down), 1e-3);
  const std::vector<Vector3> found =
      polyline(SlackCurve::of_forces(start, end, start_force, end_force, length), 1e-3);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) expect_near(found[k], expected[k], 1e-12);
  for (const Vector3& p : found) EXPECT_NEAR(p.y(), a * std::cosh(p.x() / a), 1e-12);
}

TEST(SlackCurve, WritesAsFarAsThereIsRoom) {
  const SlackCurve c({0, 0, 0}, {1, 0, 0}, 2.0, down);
  const std::vector<Vector3> whole = polyline(c, 1e-3);
  std::vector<Vector3> some(whole.size() - 3);
  c.write(1e-3, some);
  for (std::size_t k = 0; k < some.size(); ++k) EXPECT_EQ(some[k], whole[k]);
  c.write(1e-3, {});
}

TEST(SlackCurve, ChangesContinuouslyAsItTightens) {
  Vector3 previous = SlackCurve({0, 0, 0}, {1, 0.2, 0}, 1.2, down).point(0.6);
  const double distance = Vector3(1, 0.2, 0).norm();
  for (double excess = 0.18; excess > 1e-16; excess *= 0.8) {
    const Vector3 now = SlackCurve({0, 0, 0}, {1, 0.2, 0}, distance + excess, down)
                            .point(0.5 * (distance + excess));
    EXPECT_LE((now - previous).norm(), 0.25 * std::sqrt(excess) + 0.1 * excess + 1e-7);
    previous = now;
  }
  expect_near(previous, {0.5, 0.1, 0.0}, 1e-7);
}

}  // namespace
}  // namespace sheave
