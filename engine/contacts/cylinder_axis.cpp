// A cylinder B against any solid. Each way in which a flat end, a rim or the mantle can touch a
// corner, an edge, a face, a rim or a mantle gives a candidate direction. The one with the largest
// gap is used.
//
//   flat end       the cylinder's axis
//   corner         from the nearest point of the cylinder to the corner
//   mantle, edge   axis x edge
//   rim, edge      tangent of the rim x edge, at the rim's point nearest to the line of the edge
//   rim, rim       tangent x tangent, at the nearest points of the two circles
//   rim, mantle    from the other axis to the rim's point nearest to that axis
//
// Nearest points of circles are found by alternating projections. For solids that overlap deeply,
// these need not be the best ones, so a search across the best direction improves it. The gap along
// a direction with a small error is too small by the square of the error.

#include <array>
#include <cmath>
#include <limits>

#include "engine/contacts/contact_axis.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr int projections = 24;
// Steps of the search across the best direction [rad].
constexpr double longest_step = 0.1;
constexpr double shortest_step = 1e-7;

struct Circle {
  Vector3 center;
  Vector3 axis;
  double radius;
  [[nodiscard]] Vector3 nearest(const Vector3& point) const {
    const Vector3 apart = point - center;
    const Vector3 out = sum(apart, -dot(axis, apart), axis);
    const double length = std::sqrt(dot(out, out));
    if (!(length > 0.0)) return center + radius * any_perpendicular(axis);
    return sum(center, radius / length, out);
  }
  [[nodiscard]] Vector3 tangent(const Vector3& point) const {
    return cross(axis, point - center) / radius;
  }
};

class Search {
 public:
  Search(const PlacedSolid& a, const PlacedSolid& b, double margin)
      : a_(a), b_(b), margin_(margin), axis_(b.axis()) {
    best_.gap = -std::numeric_limits<double>::infinity();
  }

  ContactAxis run() {
    try_both(axis_);
    for (const Vector3& corner : a_.vertices) {
      if (!a_.is(ConvexSolid::Kind::cylinder)) try_corner(corner);
    }
    for (std::size_t f = 0; f < a_.solid->faces.size(); ++f) try_one(-a_.face_normal(f));
    if (done()) return best_;
    for (const ConvexSolid::Edge& edge : a_.solid->edges) {
      if (!edge.repeats) try_both(cross(axis_, a_.edge_vector(edge)));
      if (!a_.is(ConvexSolid::Kind::cylinder)) try_rims(edge);
      if (done()) return best_;
    }
    if (a_.is(ConvexSolid::Kind::cylinder)) try_cylinder();
    if (!done()) climb();
    return best_;
  }

 private:
  [[nodiscard]] bool done() const { return best_.gap > margin_; }

  void try_one(const Vector3& direction) {
    const double length = std::sqrt(dot(direction, direction));
    if (length > 1e-9) try_normal(direction / length);
  }
  void try_normal(const Vector3& normal) {
    const double gap = gap_along(a_, b_, normal);
    if (!(gap > best_.gap)) return;
    best_.normal = normal;
    best_.gap = gap;
  }
  void try_both(const Vector3& direction) {
    const double length = std::sqrt(dot(direction, direction));
    if (!(length > 0.0)) return;
    const Vector3 normal = direction / length;
    try_normal(normal);
    try_normal(-normal);
  }

  /// Improves the best direction by steps across it, whose length is halved when no step increases
  /// the gap.
  void climb() {
    if (is_at_top()) return;
    for (double step = longest_step; step > shortest_step; step *= 0.5) {
      constexpr int most_moves =
          1000;  // few are needed: directions two steps away have been tried with the longer step
      for (int move = 0; move < most_moves && climbs(step); ++move) {
      }
    }
  }
  /// Whether no step increases the gap. Near the best direction the gap has a single top, whose
  /// slope the short step shows; long steps show other tops.
  bool is_at_top() {
    for (const double step : {longest_step, 0.5 * longest_step, 0.25 * longest_step}) {
      if (climbs(step)) return false;
    }
    return !climbs(10.0 * shortest_step);
  }
  /// Takes the best of four steps across the direction if it increases the gap. A direction with a
  /// closed form remains if steps improve it by rounding only.
  bool climbs(double step) {
    const Vector3 x = any_perpendicular(best_.normal);
    const Vector3 y = cross(best_.normal, x);
    const ContactAxis kept = best_;
    for (const Vector3& aside : {x, Vector3(-x), y, Vector3(-y)}) {
      try_one(kept.normal + step * aside);
    }
    const double size = a_.solid->radius + b_.solid->radius + (a_.first() - b_.first()).norm();
    if (best_.gap > kept.gap + 1e-12 * size) return true;
    best_ = kept;
    return false;
  }

  void try_corner(const Vector3& corner) {
    const Vector3 middle = 0.5 * (b_.first() + b_.last());
    const double half = 0.5 * (b_.last() - b_.first()).norm();
    const double along = dot(axis_, corner - middle);
    const Vector3 out = corner - middle - along * axis_;
    const double distance = out.norm();
    const double radius = b_.solid->radius;
    if (distance > 0.0) try_one(out / distance);
    if (std::abs(along) > half && distance > radius) {
      const Vector3 rim = middle + std::copysign(half, along) * axis_ + out * (radius / distance);
      const Vector3 from = corner - rim;
      if (from.norm() > 1e-9 * radius) try_one(from.normalized());
    }
  }

  void try_rims(const ConvexSolid::Edge& edge) {
    const Vector3& from = a_.vertices[at(edge.from)];
    const Vector3 along = a_.edge_vector(edge);
    const double square = dot(along, along);
    for (const Vector3& center : b_.vertices) {
      const Circle rim{center, axis_, b_.solid->radius};
      Vector3 on_line = from + 0.5 * along;
      Vector3 on_rim = rim.nearest(on_line);
      for (int i = 0; i < projections; ++i) {
        const Vector3 before = on_rim;
        on_line = sum(from, dot(along, on_rim - from) / square, along);
        on_rim = rim.nearest(on_line);
        if (on_rim == before) break;
      }
      try_both(cross(rim.tangent(on_rim), along));
    }
    if (edge.repeats) return;
    // If the edge is deep in the cylinder, other points of the rim may give a larger gap.
    if (!knows_tangents_) find_tangents();
    for (const Vector3& tangent : tangents_) try_both(cross(tangent, along));
  }
  void find_tangents() {
    const Vector3 x = any_perpendicular(axis_);
    const Vector3 y = cross(axis_, x);
    for (std::size_t i = 0; i < tangents_.size(); ++i) {
      const double angle = pi / static_cast<double>(tangents_.size()) * static_cast<double>(i);
      tangents_[i] = portable::cos(angle) * x + portable::sin(angle) * y;
    }
    knows_tangents_ = true;
  }

  void try_cylinder() {
    try_both(a_.axis());
    const Vector3 across = a_.first() - b_.first();
    try_both(across - axis_ * dot(axis_, across));
    for (const Vector3& center : b_.vertices) {
      const Circle rim{center, axis_, b_.solid->radius};
      try_mantle(rim, a_);
      for (const Vector3& other : a_.vertices) {
        const Circle second{other, a_.axis(), a_.solid->radius};
        Vector3 p = rim.nearest(other);
        Vector3 q = second.nearest(p);
        for (int i = 0; i < projections; ++i) {
          const Vector3 before = q;
          p = rim.nearest(q);
          q = second.nearest(p);
          if (q == before) break;
        }
        try_both(cross(rim.tangent(p), second.tangent(q)));
      }
    }
    for (const Vector3& center : a_.vertices) {
      try_mantle({center, a_.axis(), a_.solid->radius}, b_);
    }
  }

  void try_mantle(const Circle& rim, const PlacedSolid& other) {
    const Vector3 along = other.axis();
    const Vector3& on_axis = other.first();
    Vector3 foot = on_axis + along * dot(along, rim.center - on_axis);
    Vector3 on_rim = rim.nearest(foot);
    for (int i = 0; i < projections; ++i) {
      const Vector3 before = on_rim;
      foot = sum(on_axis, dot(along, on_rim - on_axis), along);
      on_rim = rim.nearest(foot);
      if (on_rim == before) break;
    }
    try_both(on_rim - foot);
  }

  const PlacedSolid& a_;
  const PlacedSolid& b_;
  double margin_;
  Vector3 axis_;
  ContactAxis best_;
  /// Directions all round the rim.
  std::array<Vector3, 12> tangents_;
  bool knows_tangents_ = false;
};

}  // namespace

ContactAxis axis_of_cylinder(const PlacedSolid& a, const PlacedSolid& b, double margin) {
  return Search(a, b, margin).run();
}

ContactAxis contact_axis(const PlacedSolid& a, const PlacedSolid& b, double margin) {
  const auto turned_round = [&](ContactAxis axis) {
    using Kind = ContactAxis::Kind;
    axis.normal = -axis.normal;
    std::swap(axis.core_a, axis.core_b);
    if (axis.kind == Kind::face_a || axis.kind == Kind::face_b) {
      axis.kind = axis.kind == Kind::face_a ? Kind::face_b : Kind::face_a;
    }
    return axis;
  };
  if (b.is(ConvexSolid::Kind::cylinder)) return axis_of_cylinder(a, b, margin);
  if (a.is(ConvexSolid::Kind::cylinder)) return turned_round(axis_of_cylinder(b, a, margin));
  if (a.is_round() && b.is_round()) return axis_of_round(a, b);
  if (a.is_round()) return axis_of_round_and_faces(a, b);
  if (b.is_round()) return turned_round(axis_of_round_and_faces(b, a));
  return axis_of_faces(a, b, margin);
}

}  // namespace sheave
