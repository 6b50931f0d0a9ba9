#include "cable/knot_point.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/index.h"

namespace sheave {
namespace {

/// Solves a symmetric positive definite system of up to three equations by Cholesky's method; false
/// if it is singular to rounding.
bool solve_definite(std::array<std::array<double, 3>, 3> m, int n,
                    std::span<std::array<double, 3>> right) {
  constexpr double least = 1e-14;  // of the diagonal: the square of a relative distance of 1e-7
  for (int j = 0; j < n; ++j) {
    const double whole = m[at(j)][at(j)];
    double pivot = whole;
    for (int k = 0; k < j; ++k) pivot -= m[at(j)][at(k)] * m[at(j)][at(k)];
    if (!(pivot > least * whole)) return false;
    m[at(j)][at(j)] = std::sqrt(pivot);
    for (int i = j + 1; i < n; ++i) {
      double entry = m[at(i)][at(j)];
      for (int k = 0; k < j; ++k) entry -= m[at(i)][at(k)] * m[at(j)][at(k)];
      m[at(i)][at(j)] = entry / m[at(j)][at(j)];
    }
  }
  for (std::array<double, 3>& x : right) {
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) x[at(i)] -= m[at(i)][at(k)] * x[at(k)];
      x[at(i)] /= m[at(i)][at(i)];
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) x[at(i)] -= m[at(k)][at(i)] * x[at(k)];
      x[at(i)] /= m[at(i)][at(i)];
    }
  }
  return true;
}

/// The point of equal excess of some arms, in the hull of their ends.
struct EqualPoint {
  bool exists = false;
  double excess = 0.0;  ///< v [m]
  Vector3 point = Vector3::Zero();
  std::array<double, 4> weights{};  ///< s, not normalised; per arm of the subset
};

/// Roots of a x^2 + 2 b x + c = 0, without cancellation; NaN if there are none.
std::array<double, 2> roots_of(double a, double b, double c) {
  const double root = std::sqrt(b * b - a * c);
  const double q = b >= 0.0 ? -b - root : -b + root;
  return {q / a, q != 0.0 ? c / q : 0.0};
}

/// `subset`: indices of one to four arms.
EqualPoint equal_point(std::span<const KnotArm> arms, std::span<const int> subset) {
  EqualPoint best;
  const KnotArm& base = arms[at(subset[0])];
  const int n = static_cast<int>(subset.size()) - 1;
  if (n == 0) return {true, -base.reach, base.end, {1.0}};
  std::array<Vector3, 3> away;
  std::array<std::array<double, 3>, 3> gram{};
  std::array<std::array<double, 3>, 2> sides{};  // of the parts of p without v and with it
  for (int i = 0; i < n; ++i) {
    const KnotArm& arm = arms[at(subset[at(i + 1)])];
    away[at(i)] = arm.end - base.end;
    const double longer = arm.reach - base.reach;
    sides[0][at(i)] = 0.5 * (dot(away[at(i)], away[at(i)]) - longer * (arm.reach + base.reach));
    sides[1][at(i)] = -longer;
    for (int k = 0; k <= i; ++k)
      gram[at(i)][at(k)] = gram[at(k)][at(i)] = dot(away[at(i)], away[at(k)]);
  }
  if (!solve_definite(gram, n, sides)) return best;
  Vector3 still = Vector3::Zero();
  Vector3 moves = Vector3::Zero();
  for (int i = 0; i < n; ++i) {
    still = sum(still, sides[0][at(i)], away[at(i)]);
    moves = sum(moves, sides[1][at(i)], away[at(i)]);
  }
  const auto roots = roots_of(dot(moves, moves) - 1.0, dot(still, moves) - base.reach,
                              dot(still, still) - base.reach * base.reach);
  for (const double v : roots) {
    if (!std::isfinite(v) || (best.exists && v <= best.excess)) continue;
    std::array<double, 4> weights{};
    bool inside = true;
    double first = 1.0;
    for (int i = 0; i <= n; ++i) {
      const double radius = arms[at(subset[at(i)])].reach + v;
      const double part = i > 0 ? sides[0][at(i - 1)] + v * sides[1][at(i - 1)] : 0.0;
      inside = inside && radius >= 0.0 && part >= 0.0;
      first -= part;
      weights[at(i)] = part * radius;
    }
    weights[0] = first * (base.reach + v);
    if (!inside || !(first >= 0.0)) continue;
    best = {true, v, base.end + still + v * moves, weights};
  }
  return best;
}

/// Calls visit(point, subset) for every subset of the arms with a point in its hull.
template <class Visit>
void for_each_equal_point(std::span<const KnotArm> arms, Visit visit) {
  std::array<int, most_knot_arms> subset{};
  for (unsigned chosen = 1; chosen < (1U << arms.size()); ++chosen) {
    std::size_t size = 0;
    for (unsigned i = 0; i < arms.size(); ++i) {
      if ((chosen >> i & 1U) != 0) subset[size++] = static_cast<int>(i);
    }
    const std::span<const int> own(subset.data(), size);
    const EqualPoint point = equal_point(arms, own);
    if (point.exists) visit(point, own);
  }
}

/// The shares of all arms.
std::vector<double> shares_of(const EqualPoint& point, std::span<const int> subset,
                              std::size_t count) {
  std::vector<double> shares(count, 0.0);
  double whole = 0.0;
  for (std::size_t k = 0; k < subset.size(); ++k) whole += point.weights[k];
  for (std::size_t k = 0; k < subset.size(); ++k) {
    shares[at(subset[k])] =
        whole > 0.0 ? point.weights[k] / whole : 1.0 / static_cast<double>(subset.size());
  }
  return shares;
}

/// The point where the greatest excess is least, over all arms.
double find_equal_point(std::span<const KnotArm> arms, KnotPlace& place) {
  double excess = 0.0;
  bool found = false;
  for_each_equal_point(arms, [&](const EqualPoint& point, std::span<const int> subset) {
    if (found && point.excess <= excess) return;
    found = true;
    excess = point.excess;
    place.point = point.point;
    place.shares = shares_of(point, subset, arms.size());
  });
  return excess;
}

struct ElasticPull {
  double energy = 0.0;
  Vector3 force = Vector3::Zero();
  std::array<std::array<double, 3>, 3> stiffness{};
};

ElasticPull elastic_pull(std::span<const KnotArm> arms, const Vector3& point) {
  ElasticPull pull;
  for (const KnotArm& arm : arms) {
    const Vector3 away = arm.end - point;
    const double length = away.norm();
    const double excess = length - arm.reach;
    if (!(excess > 0.0) || !(length > 0.0)) continue;
    const double tension = excess / arm.compliance;
    const Vector3 u = away / length;
    pull.energy += 0.5 * tension * excess;
    pull.force = sum(pull.force, tension, u);
    const double across = tension / length;
    const double along = 1.0 / arm.compliance - across;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) pull.stiffness[at(i)][at(k)] += along * u[i] * u[k];
      pull.stiffness[at(i)][at(i)] += across;
    }
  }
  return pull;
}

/// Moves the point to the least elastic energy, by Newton's method with shorter steps where the
/// energy does not fall.
void find_elastic_balance(std::span<const KnotArm> arms, Vector3& point) {
  constexpr int most_rounds = 100;
  double size = 0.0;
  for (const KnotArm& arm : arms) size = std::max(size, (arm.end - point).norm());
  for (int round = 0; round < most_rounds; ++round) {
    const ElasticPull pull = elastic_pull(arms, point);
    std::array<std::array<double, 3>, 1> step{{{pull.force[0], pull.force[1], pull.force[2]}}};
    if (!solve_definite(pull.stiffness, 3, step)) return;
    const Vector3 way{step[0][0], step[0][1], step[0][2]};
    const double far = way.norm();
    // Energies do not resolve steps below the root of rounding.
    const bool near = far <= 1e-7 * size;
    double share = 1.0;
    const double slope = dot(pull.force, way);
    for (int half = 0; half < 40 && !near; ++half) {
      if (elastic_pull(arms, sum(point, share, way)).energy <= pull.energy - 0.1 * share * slope) {
        break;
      }
      share *= 0.5;
    }
    point = sum(point, share, way);
    if (far <= 1e-12 * size) return;  // the next step would be its square
  }
}

/// Places the knot of stretched elastic ropes. `yield`: sum of their compliances.
void balance_elastic(std::span<const KnotArm> arms, double yield, KnotPlace& place) {
  find_elastic_balance(arms, place.point);
  double energy = 0.0;  // twice the energy
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const double stretch = std::max((arms[i].end - place.point).norm() - arms[i].reach, 0.0);
    place.shares[i] = stretch / arms[i].compliance;
    energy += stretch * place.shares[i];
  }
  const double force = std::sqrt(energy / yield);
  for (double& share : place.shares) share /= force;
}

}  // namespace

void find_knot_place(std::span<const KnotArm> arms, KnotPlace& place) {
  // Solvers leave residuals of a smaller share of the size in a rope that pulls.
  constexpr double pulls = 1e-9;
  // The error of shares by stretches, rounding over strain, is here that of shares by geometry, the
  // strain.
  constexpr double resolved = 1e-8;
  const double excess = find_equal_point(arms, place);
  double size = 0.0;
  double yield = 0.0;
  for (const KnotArm& arm : arms) {
    size = std::max(size, (arm.end - place.point).norm());
    yield += arm.compliance;
  }
  place.taut = excess > -pulls * size;
  if (!(yield > 0.0)) return;
  if (excess > resolved * size) return balance_elastic(arms, yield, place);
  double square = 0.0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    square += place.shares[i] * place.shares[i] * arms[i].compliance;
  }
  const double scale = std::sqrt(yield / square);
  for (double& share : place.shares) share *= scale;
}

bool has_other_shares(std::span<const KnotArm> arms, const KnotPlace& place) {
  constexpr double rounding = 1e-9;
  constexpr double least_difference = 1e-6;
  double size = 0.0;
  double excess = 0.0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const double length = (arms[i].end - place.point).norm();
    size = std::max(size, length);
    excess += place.shares[i] * (length - arms[i].reach);
  }
  bool others = false;
  for_each_equal_point(arms, [&](const EqualPoint& point, std::span<const int> subset) {
    if (point.excess < excess - rounding * size) return;
    const std::vector<double> shares = shares_of(point, subset, arms.size());
    for (std::size_t i = 0; i < shares.size(); ++i) {
      others = others || std::abs(shares[i] - place.shares[i]) > least_difference;
    }
  });
  return others;
}

}  // namespace sheave
