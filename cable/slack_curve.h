#pragma once
// The curve of a cable that hangs between two points.

#include <cstddef>
#include <span>

#include "engine/vector.h"

namespace sheave {

/// A catenary between two points: a slack cable of given length, or a rope with weight.
class SlackCurve {
 public:
  /// A slack cable from `start` to `end` [m] with the given length [m]. Only the direction of
  /// `gravity` counts; without gravity down is -y. A length up to the distance of the ends gives
  /// the straight line, whose length() is then the distance.
  SlackCurve(const Vector3& start, const Vector3& end, double length, const Vector3& gravity);
  /// A rope with weight that pulls its ends with these forces [N]. Their sum is the weight; the
  /// rope must have one. `length` [m] is the rest length, which determines the size of the curve
  /// where both ends are at one place.
  static SlackCurve of_forces(const Vector3& start, const Vector3& end, const Vector3& start_force,
                              const Vector3& end_force, double length);

  /// Place at arc length s [m] of a slack cable, clamped to [0, length()]. Exact at both ends.
  [[nodiscard]] Vector3 point(double s) const;
  [[nodiscard]] double length() const { return length_; }  ///< [m]
  [[nodiscard]] bool is_straight() const { return straight_; }

  /// Number of points of a polyline whose distance from the curve is at most `tolerance` [m], > 0;
  /// in 2 ... 2001.
  [[nodiscard]] std::size_t point_count(double tolerance) const;
  /// Writes that polyline from start to end, as far as `points` has room. Both ends are exact.
  void write(double tolerance, std::span<Vector3> points) const;

 private:
  SlackCurve() = default;
  /// The curve at the parameter u, relative to its start.
  [[nodiscard]] Vector3 at_parameter(double u) const;
  /// The lowest point of a curve without width, relative to its start.
  [[nodiscard]] Vector3 fold() const;
  [[nodiscard]] std::size_t steps(double from, double to, double tolerance) const;

  Vector3 start_ = Vector3::Zero();
  Vector3 end_ = Vector3::Zero();
  Vector3 across_ = Vector3::Zero();  ///< horizontal unit vector from start to end
  Vector3 up_ = Vector3::UnitY();
  double length_ = 0.0;
  double width_ = 0.0;   ///< horizontal distance of the ends [m]
  double rise_ = 0.0;    ///< height of the end above the start [m]
  double radius_ = 0.0;  ///< a: radius of curvature at the lowest point [m]
  double lowest_ = 0.0;  ///< arc length of the lowest point; may lie outside [0, length]
  double from_ = 0.0;    ///< parameters u = asinh(s'/a) of both ends
  double to_ = 0.0;
  bool straight_ = true;
};

}  // namespace sheave
