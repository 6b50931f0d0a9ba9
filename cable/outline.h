#pragma once
// The convex curve along which a cable runs on a body: a convex polygon in the plane of the link,
// offset by a corner radius (0: the polygon itself).
//
// The contact follows from the angle f of its outward normal. A corner is the contact for a whole
// interval of f, with an arc of the corner radius r. Along an edge f is constant and the contact
// moves at once from one corner to the next. The distance along the curve, counter-clockwise from
// corner 0, is
//   s(f) = (edges passed) + r f,
// over any number of turns. A cable that rolls from f1 to f2 takes s(f2) - s(f1) onto the body. At
// an edge s jumps by the edge's length. The length of the free span jumps by the same amount, so
// the constraint value, rest length minus length, stays continuous.

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
  /// The convex hull of `points` [m, z is ignored], offset by `corner_radius` [m], >= 0. An error
  /// if the points enclose no area.
  static Result<Outline> create(std::span<const Vector3> points, double corner_radius = 0.0);

  [[nodiscard]] int corner_count() const { return static_cast<int>(corners_.size()); }
  /// Corner of the polygon before the offset [m], counter-clockwise.
  [[nodiscard]] const Vector3& corner(int index) const {
    return corners_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] double corner_radius() const { return corner_radius_; }  ///< [m]
  /// Length of the whole curve, corner arcs included [m].
  [[nodiscard]] double perimeter() const { return edge_sums_.back() + 2.0 * pi * corner_radius_; }
  /// The corner farthest in the direction (x, y), which need not be a unit vector. The search
  /// starts at `near`. Of two corners equally far it returns the first that it meets.
  [[nodiscard]] int support(double x, double y, int near) const;
  /// Distance along the curve from corner 0 at normal angle 0 to the contact at `corner` with the
  /// normal angle `angle` [rad, unwrapped]: s(f) above [m]. The corner is an argument because on an
  /// edge the angle alone does not determine the contact.
  [[nodiscard]] double distance(int corner, double angle) const;

 private:
  std::vector<Vector3> corners_;
  /// length of the edges before corner i; the last entry is the sum of all [m]
  std::vector<double> edge_sums_;
  /// middle of each corner's interval of normals, increasing [rad]
  std::vector<double> normal_angles_;
  double corner_radius_ = 0.0;
};

}  // namespace sheave
