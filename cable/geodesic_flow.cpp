#include "cable/geodesic_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace sheave {
namespace {

/// Point, tangent, two neighbours with their rates, turned angle. Lengths are in units of the
/// surface's radius.
constexpr std::size_t flow_size = 11;
using FlowState = std::array<double, flow_size>;

/// A surface in its own frame, in units of its radius.
class FlowSurface {
 public:
  explicit FlowSurface(const SmoothSurface& surface)
      : torus_(surface.form == SurfaceForm::torus), ring_(surface.ring / surface.radius) {
    for (int i = 0; i < 3; ++i) {
      const double half_axis = torus_ ? 1.0 : surface.half_axes[i] / surface.radius;
      inverse_squares_[i] = 1.0 / (half_axis * half_axis);
    }
  }

  struct Bend {
    Vector3 outward;
    double along = 0.0;  ///< curvature along the tangent
    double gauss = 0.0;
  };
  [[nodiscard]] Bend bend(const Vector3& x, const Vector3& t) const {
    return torus_ ? torus_bend(x, t) : ellipsoid_bend(x, t);
  }

  /// Moves a point that is off the surface by rounding onto it.
  [[nodiscard]] Vector3 closest(const Vector3& x) const {
    if (!torus_) {
      return x / std::sqrt(inverse_squares_[0] * x[0] * x[0] + inverse_squares_[1] * x[1] * x[1] +
                           inverse_squares_[2] * x[2] * x[2]);
    }
    const double level = std::sqrt(x[0] * x[0] + x[1] * x[1]);
    const Vector3 core(ring_ * x[0] / level, ring_ * x[1] / level, 0.0);
    return core + (x - core).normalized();
  }

 private:
  [[nodiscard]] Bend ellipsoid_bend(const Vector3& x, const Vector3& t) const {
    const Vector3& s = inverse_squares_;
    const Vector3 gradient(s[0] * x[0], s[1] * x[1], s[2] * x[2]);
    const double size_squared = dot(gradient, gradient);
    const double size = std::sqrt(size_squared);
    return {gradient / size, (s[0] * t[0] * t[0] + s[1] * t[1] * t[1] + s[2] * t[2] * t[2]) / size,
            s[0] * s[1] * s[2] / (size_squared * size_squared)};
  }

  [[nodiscard]] Bend torus_bend(const Vector3& x, const Vector3& t) const {
    const double level = std::sqrt(x[0] * x[0] + x[1] * x[1]);
    const double off = level - ring_;
    const double tube = std::sqrt(off * off + x[2] * x[2]);
    const double round = (x[0] * t[1] - x[1] * t[0]) / level;
    const double cosine = off / tube;
    const double parallel = cosine / level;
    return {Vector3(cosine * x[0] / level, cosine * x[1] / level, x[2] / tube),
            (dot(t, t) - round * round) / tube + round * round * parallel, parallel / tube};
  }

  bool torus_;
  double ring_;
  Vector3 inverse_squares_ = Vector3::Ones();
};

Vector3 point_of(const FlowState& y) { return {y[0], y[1], y[2]}; }
Vector3 tangent_of(const FlowState& y) { return {y[3], y[4], y[5]}; }

FlowState flow_rate(const FlowSurface& surface, const FlowState& y) {
  const FlowSurface::Bend bend = surface.bend(point_of(y), tangent_of(y));
  return {y[3],
          y[4],
          y[5],
          -bend.along * bend.outward[0],
          -bend.along * bend.outward[1],
          -bend.along * bend.outward[2],
          y[7],
          -bend.gauss * y[6],
          y[9],
          -bend.gauss * y[8],
          bend.along};
}

FlowState midpoint_rule(const FlowSurface& surface, const FlowState& start, const FlowState& rate,
                        double length, int steps) {
  const double h = length / steps;
  FlowState before = start;
  FlowState now;
  for (std::size_t i = 0; i < flow_size; ++i) now[i] = start[i] + h * rate[i];
  for (int k = 1; k <= steps; ++k) {
    const FlowState slope = flow_rate(surface, now);
    if (k == steps) {
      for (std::size_t i = 0; i < flow_size; ++i)
        now[i] = 0.5 * (now[i] + before[i] + h * slope[i]);
      break;
    }
    for (std::size_t i = 0; i < flow_size; ++i) {
      const double next = before[i] + 2.0 * h * slope[i];
      before[i] = now[i];
      now[i] = next;
    }
  }
  return now;
}

/// One step; returns how far the last two orders differ, relative to the state.
double extrapolate(const FlowSurface& surface, const FlowState& start, double length,
                   FlowState& end) {
  constexpr int columns = 8;
  std::array<FlowState, columns> row;  // row[j]: extrapolated from the rules j ... k
  const FlowState rate = flow_rate(surface, start);
  for (int k = 0; k < columns; ++k) {
    row[static_cast<std::size_t>(k)] = midpoint_rule(surface, start, rate, length, 2 * (k + 1));
    for (int j = k - 1; j >= 0; --j) {
      const double ratio = static_cast<double>(k + 1) / (j + 1);
      const double share = 1.0 / (ratio * ratio - 1.0);
      FlowState& coarse = row[static_cast<std::size_t>(j)];
      const FlowState& fine = row[static_cast<std::size_t>(j + 1)];
      for (std::size_t i = 0; i < flow_size; ++i) {
        coarse[i] = fine[i] + (fine[i] - coarse[i]) * share;
      }
    }
  }
  end = row[0];
  double off = 0.0;
  for (std::size_t i = 0; i < flow_size; ++i) {
    off = std::max(off, std::abs(end[i] - row[1][i]) / (1.0 + std::abs(end[i])));
  }
  return off;
}

/// Brings the point onto the surface and the tangent into it.
void settle(const FlowSurface& surface, FlowState& y) {
  const Vector3 point = surface.closest(point_of(y));
  Vector3 tangent = tangent_of(y);
  const Vector3 outward = surface.bend(point, tangent).outward;
  tangent -= dot(tangent, outward) * outward;
  tangent /= tangent.norm();
  for (int i = 0; i < 3; ++i) {
    y[static_cast<std::size_t>(i)] = point[i];
    y[static_cast<std::size_t>(3 + i)] = tangent[i];
  }
}

FlowState flow(const FlowSurface& surface, FlowState y, double length) {
  constexpr double exact = 1e-14;
  constexpr double first_angle = 1.5;  // [rad]
  constexpr int most_halvings = 12;
  constexpr int most_steps = 2000;  // more than any rope needs
  double step = length;
  for (int k = 0; k < most_steps && length > 0.0; ++k) {
    const FlowSurface::Bend bend = surface.bend(point_of(y), tangent_of(y));
    const double curvature = std::max(std::abs(bend.along), std::sqrt(std::abs(bend.gauss)));
    step = std::min(length, 2.0 * step);
    if (step * curvature > first_angle) step = first_angle / curvature;
    FlowState end{};
    for (int halving = 0; halving <= most_halvings; ++halving) {
      if (extrapolate(surface, y, step, end) <= exact || halving == most_halvings) break;
      step *= 0.5;
    }
    y = end;
    settle(surface, y);
    length = step < length ? length - step : 0.0;
  }
  return y;
}

}  // namespace

SurfaceWay integrated_way(const SmoothSurface& surface, const SurfaceFrame& start, double length) {
  const double sense = length < 0.0 ? -1.0 : 1.0;
  const double unit = surface.radius;
  SmoothSurface axes = surface;
  if (surface.form == SurfaceForm::torus) axes.side = any_perpendicular(surface.axis);
  const Vector3 x = axes.to_own(start.point - surface.center) / unit;
  const Vector3 t = sense * axes.to_own(start.tangent);
  const FlowState y =
      flow(FlowSurface(surface), {x[0], x[1], x[2], t[0], t[1], t[2], 1.0, 0.0, 0.0, sense, 0.0},
           std::abs(length) / unit);
  SurfaceWay way;
  way.end = surface.frame(surface.center + unit * axes.from_own(point_of(y)),
                          axes.from_own(sense * tangent_of(y)));
  way.shifted = y[6];
  way.shifted_rate = sense * y[7] / unit;
  way.turned_off = unit * y[8];
  way.turned_off_rate = sense * y[9];
  way.turned = sense * y[10];
  return way;
}

}  // namespace sheave
