#include "cable/geodesic_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/index.h"

namespace sheave {
namespace {

/// The changes of a body's geodesic, in this order.
enum Change { along, aside, angle, longer };
constexpr std::size_t per_stop = 4;

class Chain {
 public:
  Chain(std::vector<GeodesicStop>& stops, const SpanEnd& from, const SpanEnd& to)
      : stops_(stops), from_(from), to_(to), ring_(!from), unknowns_(per_stop * stops.size()) {}

  bool solve() {
    const std::vector<GeodesicStop> given = stops_;
    travel();
    // The closed form of a single ball or cylinder holds also where the ends of the spans and the
    // centre of a ball are on one line, and Newton's matrix is singular.
    if (count() == 1 && is_closed_form(stops_[0].surface)) take_turns();
    if (refine()) return true;
    stops_ = given;
    travel();
    take_turns();
    if (refine()) return true;
    stops_ = given;
    straighten();
    return refine();
  }

 private:
  [[nodiscard]] std::size_t count() const { return stops_.size(); }
  /// Whether way_between() is the shortest path.
  [[nodiscard]] static bool is_closed_form(const SmoothSurface& surface) {
    return surface.is_ball() || surface.form == SurfaceForm::cylinder;
  }

  void travel() {
    for (GeodesicStop& stop : stops_) {
      stop.way = straightest_way(stop.surface, stop.entry, stop.length);
    }
  }

  [[nodiscard]] Vector3 before(std::size_t j) const {
    if (j > 0) return stops_[j - 1].way.end.point;
    return ring_ ? stops_.back().way.end.point : from_(stops_[0].entry.point);
  }
  [[nodiscard]] Vector3 behind(std::size_t j) const {
    if (j + 1 < count()) return stops_[j + 1].entry.point;
    return ring_ ? stops_.front().entry.point : to_(stops_[j].way.end.point);
  }

  /// Gives each body in turn its geodesic between the present ends of its neighbours.
  void take_turns() {
    constexpr int rounds = 8;
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t j = 0; j < count(); ++j) {
        GeodesicStop& stop = stops_[j];
        const SmoothSurface& whole = stop.surface;
        SmoothSurface part = whole;
        // Of a capsule first its side, then the cap that this way would need.
        const bool capsule = whole.is_capsule();
        if (capsule) part.form = SurfaceForm::cylinder;
        WayBetween way = way_between(part, before(j), behind(j), stop.entry, stop.length);
        if (capsule && !(part.beyond_ends(way.entry.point) == 0.0)) {
          part.form = SurfaceForm::rounded;
          part.center = whole.core(way.entry.point);
          part.half_length = 0.0;
          way = way_between(part, before(j), behind(j), stop.entry, stop.length);
        }
        stop.entry = whole.frame(way.entry.point, way.entry.tangent);
        stop.length = way.length;
        stop.way = straightest_way(whole, stop.entry, stop.length);
      }
    }
  }

  /// Gives each body a geodesic of length 0 where the line between its neighbours passes it.
  void straighten() {
    for (std::size_t j = 0; j < count(); ++j) {
      GeodesicStop& stop = stops_[j];
      const Vector3 start = before(j);
      const Vector3 line = behind(j) - start;
      const double length = line.norm();
      if (!(length > 0.0)) continue;
      const Vector3 direction = line / length;
      const Vector3 outward = cross(direction, stop.entry.across());
      const Vector3 core = core_passage(stop.surface, start, direction).core;
      stop.entry = touched_frame(stop.surface, core, outward, direction);
      stop.length = 0.0;
      stop.way = straightest_way(stop.surface, stop.entry, 0.0);
    }
  }

  /// Newton's method.
  bool refine() {
    constexpr int most_rounds = 40;
    constexpr double settled = 4e-15;
    constexpr double nearly = 1e-11;  // rounding may leave so much
    double last = 0.0;
    for (int round = 0; round < most_rounds; ++round) {
      const double size = set_up();
      if (residual() <= settled * size) return runs_forward();
      if (!eliminate()) return false;
      const double step = apply(size);
      if (!std::isfinite(step)) return false;
      if (step <= settled * size) return runs_forward();
      if (round > 0 && step <= nearly * size && step >= 0.25 * last) return runs_forward();
      last = step;
    }
    return false;
  }

  /// Whether all spans arrive at and leave the bodies in the direction of the geodesics.
  [[nodiscard]] bool runs_forward() const {
    for (std::size_t j = 0; j < count(); ++j) {
      const GeodesicStop& stop = stops_[j];
      if (dot(stop.entry.point - before(j), stop.entry.tangent) < 0.0) return false;
      if (dot(behind(j) - stop.way.end.point, stop.way.end.tangent) < 0.0) return false;
    }
    return true;
  }

  /// Largest error of the equations that are set up [m].
  [[nodiscard]] double residual() const {
    double largest = 0.0;
    for (std::size_t row = 0; row < unknowns_; ++row) {
      largest = std::max(largest, std::abs(matrix_[row * (unknowns_ + 1) + unknowns_]));
    }
    return largest;
  }

  double& entry(std::size_t row, std::size_t stop, std::size_t change) {
    return matrix_[row * (unknowns_ + 1) + per_stop * stop + change];
  }

  /// Motion of the exit of a body per unit of each change.
  [[nodiscard]] static std::array<Vector3, per_stop> exit_motion(const GeodesicStop& stop) {
    const SurfaceFrame& end = stop.way.end;
    return {end.tangent, stop.way.shifted * end.across(), stop.way.turned_off * end.across(),
            end.tangent};
  }

  /// Sets up the equations and their derivatives; returns the size of the chain [m].
  double set_up() {
    matrix_.assign(unknowns_ * (unknowns_ + 1), 0.0);
    double size = 0.0;
    for (std::size_t j = 0; j < count(); ++j) {
      const GeodesicStop& stop = stops_[j];
      size = std::max({size, stop.surface.radius, set_up_entry(j), set_up_exit(j)});
    }
    return size;
  }

  double set_up_entry(std::size_t j) {
    const GeodesicStop& stop = stops_[j];
    const SurfaceFrame& at = stop.entry;
    const Vector3 across = at.across();
    const Vector3 span = at.point - before(j);
    const std::size_t row = per_stop * j;
    const std::array<Vector3, 2> motion{at.tangent, across};
    for (const Change change : {along, aside}) {
      const Vector3 bend = stop.surface.bend(at, motion[change]);
      // The point moves at right angles to n, and n turns with it; b turns out of the surface.
      entry(row, j, change) += dot(span, bend);
      entry(row + 1, j, change) +=
          dot(motion[change], across) - dot(across, bend) * dot(span, at.outward);
    }
    entry(row + 1, j, angle) -= dot(span, at.tangent);
    if (j > 0 || ring_) {
      const std::size_t i = j > 0 ? j - 1 : count() - 1;
      const std::array<Vector3, per_stop> moved = exit_motion(stops_[i]);
      for (std::size_t c = 0; c < per_stop; ++c) {
        entry(row, i, c) -= dot(moved[c], at.outward);
        entry(row + 1, i, c) -= dot(moved[c], across);
      }
    }
    matrix_[row * (unknowns_ + 1) + unknowns_] = -dot(span, at.outward);
    matrix_[(row + 1) * (unknowns_ + 1) + unknowns_] = -dot(span, across);
    return span.norm();
  }

  double set_up_exit(std::size_t j) {
    const GeodesicStop& stop = stops_[j];
    const SurfaceFrame& at = stop.way.end;
    const Vector3 across = at.across();
    const Vector3 span = behind(j) - at.point;
    const std::size_t row = per_stop * j + 2;
    const std::array<Vector3, per_stop> motion = exit_motion(stop);
    const std::array<double, per_stop> turned{0.0, stop.way.shifted_rate, stop.way.turned_off_rate,
                                              0.0};
    for (std::size_t c = 0; c < per_stop; ++c) {
      const Vector3 bend = stop.surface.bend(at, motion[c]);
      entry(row, j, c) += dot(span, bend);
      entry(row + 1, j, c) += -dot(motion[c], across) - turned[c] * dot(span, at.tangent) -
                              dot(across, bend) * dot(span, at.outward);
    }
    if (j + 1 < count() || ring_) {
      const std::size_t i = j + 1 < count() ? j + 1 : 0;
      const SurfaceFrame& next = stops_[i].entry;
      const std::array<Vector3, 2> moved{next.tangent, next.across()};
      for (const Change change : {along, aside}) {
        entry(row, i, change) += dot(moved[change], at.outward);
        entry(row + 1, i, change) += dot(moved[change], across);
      }
    }
    matrix_[row * (unknowns_ + 1) + unknowns_] = -dot(span, at.outward);
    matrix_[(row + 1) * (unknowns_ + 1) + unknowns_] = -dot(span, across);
    return span.norm();
  }

  /// Gaussian elimination with partial pivoting. Most entries are 0 and are skipped.
  bool eliminate() {
    const std::size_t n = unknowns_;
    const auto row = [&](std::size_t i) { return matrix_.data() + i * (n + 1); };
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i) {
        if (std::abs(row(i)[k]) > std::abs(row(pivot)[k])) pivot = i;
      }
      if (!(std::abs(row(pivot)[k]) > 0.0)) return false;
      if (pivot != k) std::swap_ranges(row(k), row(k) + n + 1, row(pivot));
      for (std::size_t i = k + 1; i < n; ++i) {
        const double factor = row(i)[k] / row(k)[k];
        if (factor == 0.0) continue;
        for (std::size_t c = k; c <= n; ++c) row(i)[c] -= factor * row(k)[c];
      }
    }
    step_.assign(n, 0.0);
    for (std::size_t k = n; k-- > 0;) {
      double sum = row(k)[n];
      for (std::size_t c = k + 1; c < n; ++c) sum -= row(k)[c] * step_[c];
      step_[k] = sum / row(k)[k];
    }
    return true;
  }

  /// Takes the step, or a part of it, in a chain of this size; returns the largest part of it [m].
  double apply(double size) {
    double share = 1.0;
    double largest = 0.0;
    for (std::size_t j = 0; j < count(); ++j) {
      const GeodesicStop& stop = stops_[j];
      const double* d = step_.data() + per_stop * j;
      const double radius = stop.surface.bend_radius(stop.entry);
      const bool bar = stop.surface.form == SurfaceForm::cylinder;
      const double far =
          0.25 * ((stop.entry.point - before(j)).norm() + (behind(j) - stop.way.end.point).norm());
      const auto bound = [&](double change, double most) {
        if (std::abs(change) * share > most) share = most / std::abs(change);
      };
      bound(d[along], 0.5 * radius);
      bound(d[aside], bar ? radius + far : 0.5 * radius);
      bound(d[longer], radius);
      bound(d[angle], 0.5);
      largest = std::max({largest, std::abs(d[along]), std::abs(d[aside]), std::abs(d[longer]),
                          std::abs(d[angle]) * radius});
    }
    // The curvature jumps at the seam of a cap, where whole steps could alternate for ever.
    constexpr double far_away = 1e-3;
    constexpr int most_halvings = 6;
    const bool watched = largest > far_away * size;
    const double before = watched ? bends() : 0.0;
    const std::vector<GeodesicStop> start = watched ? stops_ : std::vector<GeodesicStop>();
    for (int halving = 0; halving <= most_halvings; ++halving) {
      move(share);
      travel();
      if (!watched || bends() < before || halving == most_halvings) break;
      stops_ = start;
      share *= 0.5;
    }
    return largest;
  }

  void move(double share) {
    for (std::size_t j = 0; j < count(); ++j) {
      GeodesicStop& stop = stops_[j];
      const double* d = step_.data() + per_stop * j;
      const SurfaceFrame& at = stop.entry;
      const Vector3 across = at.across();
      const Vector3 point = at.point + share * (d[along] * at.tangent + d[aside] * across);
      stop.entry = stop.surface.frame(point, at.tangent + share * d[angle] * across);
      stop.length += share * d[longer];
    }
  }

  /// Residual of the equations: squared lengths of the spans across the geodesics [m2].
  [[nodiscard]] double bends() const {
    double sum = 0.0;
    const auto add = [&](const Vector3& span, const SurfaceFrame& at) {
      sum += (span - dot(span, at.tangent) * at.tangent).squaredNorm();
    };
    for (std::size_t j = 0; j < count(); ++j) {
      add(stops_[j].entry.point - before(j), stops_[j].entry);
      add(behind(j) - stops_[j].way.end.point, stops_[j].way.end);
    }
    return sum;
  }

  std::vector<GeodesicStop>& stops_;
  const SpanEnd& from_;
  const SpanEnd& to_;
  bool ring_;
  std::size_t unknowns_;
  std::vector<double> matrix_;  ///< row by row, with the right side behind each
  std::vector<double> step_;
};

}  // namespace

bool find_shortest_way(std::vector<GeodesicStop>& stops, const SpanEnd& from, const SpanEnd& to) {
  return Chain(stops, from, to).solve();
}

}  // namespace sheave
