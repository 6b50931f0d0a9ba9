#include "cable/outline.h"

#include <cmath>

#include "engine/index.h"
#include "engine/math/portable.h"
#include "engine/shapes/convex_hull.h"

namespace sheave {
namespace {

/// Angle of the outward normal of the edge from `a` to `b`, counter-clockwise about z [rad].
double edge_normal_angle(const Vector3& a, const Vector3& b) {
  return portable::atan2(a.x() - b.x(), b.y() - a.y());
}

/// `angle` plus the multiple of 2 pi that brings it into [from, from + 2 pi).
double at_or_after(double angle, double from) {
  return angle - 2.0 * pi * std::floor((angle - from) / (2.0 * pi));
}

}  // namespace

Result<Outline> Outline::create(std::span<const Vector3> points, double corner_radius) {
  Result<std::vector<Vector3>> hull = hull_2d(points);
  if (!hull) return hull.errors();
  if (!(corner_radius >= 0.0)) return Error{"", "the corner radius must not be negative"};
  Outline outline;
  outline.corner_radius_ = corner_radius;
  outline.corners_ = std::move(*hull);
  const int count = outline.corner_count();
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const Vector3& before = outline.corner((i + count - 1) % count);
    const Vector3& here = outline.corner(i);
    const Vector3& after = outline.corner((i + 1) % count);
    outline.edge_sums_.push_back(sum);
    sum += (after - here).norm();
    // A corner's normals lie between those of its two edges.
    const double incoming = edge_normal_angle(before, here);
    const double outgoing = at_or_after(edge_normal_angle(here, after), incoming);
    const double middle = 0.5 * (incoming + outgoing);
    outline.normal_angles_.push_back(i == 0 ? middle
                                            : at_or_after(middle, outline.normal_angles_.back()));
  }
  outline.edge_sums_.push_back(sum);
  return outline;
}

int Outline::support(double x, double y, int near) const {
  const int count = corner_count();
  const auto height = [&](int i) { return x * corner(i).x() + y * corner(i).y(); };
  int best = near;
  double best_height = height(best);
  // On a convex polygon the height has one maximum, so climbing in both directions finds it.
  for (const int step : {1, count - 1}) {
    for (int walked = 0; walked < count; ++walked) {
      const int next = (best + step) % count;
      const double next_height = height(next);
      if (!(next_height > best_height)) break;
      best = next;
      best_height = next_height;
    }
  }
  return best;
}

double Outline::distance(int corner, double angle) const {
  const double turns = std::round((angle - normal_angles_[at(corner)]) / (2.0 * pi));
  return edge_sums_[at(corner)] + turns * edge_sums_.back() + corner_radius_ * angle;
}

}  // namespace sheave
