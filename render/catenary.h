#pragma once
// The shape of a cable of given length hanging between two points.

#include <vector>

#include "engine/vector.h"

namespace sheave::render {

/// A hanging cable, parametrised by the arc length s in [0, length()] from its first end.
class Catenary {
 public:
  /// From `start` to `end` [m] with the given length [m]. Only the direction of `gravity` counts;
  /// without gravity down is -y. A length up to the distance of the ends gives the straight line,
  /// whose length() is then the distance.
  Catenary(const Vector3& start, const Vector3& end, double length, const Vector3& gravity);

  /// Place at arc length s [m], clamped to [0, length()]. Exact at both ends.
  [[nodiscard]] Vector3 point(double s) const;
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] bool is_straight() const { return straight_; }

  /// `count` >= 2 places from start to end, half of them equidistant in length and half in
  /// direction, so that both long arms and tight bends are smooth.
  [[nodiscard]] std::vector<Vector3> points(int count) const;

 private:
  Vector3 start_;
  Vector3 end_;
  Vector3 across_ = Vector3::Zero();  ///< horizontal unit vector from start to end
  Vector3 up_ = Vector3::UnitY();
  double length_ = 0.0;
  double width_ = 0.0;   ///< horizontal distance of the ends [m]
  double rise_ = 0.0;    ///< height of the end above the start [m]
  double radius_ = 0.0;  ///< a: radius of curvature at the lowest point [m]
  double lowest_ = 0.0;  ///< arc length of the lowest point; may lie outside [0, length]
  bool straight_ = true;
};

}  // namespace sheave::render
