#pragma once
// The convex curve that a cable runs along on a body: a convex polygon in the plane of the link,
// grown by a corner radius (0: the polygon itself).
//
// Where a cable touches follows from the angle f of the outward normal there: at a corner for a
// whole interval of f, with the arc of the corner radius r; between two corners f is that of the
// edge and the contact moves along it at once. So the distance along the curve is,
// counter-clockwise from corner 0,
//   s(f) = (edges passed) + r f,
// over any number of turns, and a cable that rolls from f1 to f2 takes s(f2) - s(f1) onto the body.
// At an edge s jumps by its length; the free span jumps by the same, so rest length minus length,
// which is what the constraint sees, stays continuous.

#include <array>
#include <span>
#include <vector>

#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

/// A convex closed curve in the plane z = 0.
class Outline {
 public:
  Outline() = default;  ///< no curve yet
  /// The convex hull of `points` [m, z is ignored] grown by `corner_radius` [m], >= 0. An error if
  /// the points enclose no area.
  static Result<Outline> create(std::span<const Vector3> points, double corner_radius = 0.0);

  [[nodiscard]] int corner_count() const { return static_cast<int>(corners_.size()); }
  /// Corner of the polygon before it is grown [m], counter-clockwise.
  [[nodiscard]] const Vector3& corner(int index) const {
    return corners_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] double corner_radius() const { return corner_radius_; }  ///< [m]
  /// Length of the whole curve, corner arcs included [m].
  [[nodiscard]] double perimeter() const { return edge_sums_.back() + 2.0 * pi * corner_radius_; }
  /// The corner farthest in the direction (x, y), which need not be a unit vector. Starts its walk
  /// at `near`. Of two corners equally far it is the one that the walk meets first.
  [[nodiscard]] int support(double x, double y, int near) const;
  /// Distance along the curve [m] from corner 0 at normal angle 0 to the contact at `corner` with
  /// normal angle `angle` [rad, unwrapped]: s(f) of the head of this file. The corner is given, not
  /// found, because at an edge the angle alone leaves it open.
  [[nodiscard]] double distance(int corner, double angle) const;

 private:
  std::vector<Vector3> corners_;
  std::vector<double> edge_sums_;      ///< length of the edges before corner i; one more for all
  std::vector<double> normal_angles_;  ///< of the middle of each corner's normals, increasing [rad]
  double corner_radius_ = 0.0;
};

}  // namespace sheave
