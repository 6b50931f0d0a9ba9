#pragma once
// The way of a tendon from a site over a sphere or a cylinder to another site.
//
// MuJoCo draws it in a plane: that of both sites and the centre of a sphere, or that across the
// axis of a cylinder, along which the way then rises evenly. Both are geodesics. Without a side
// site the tendon takes the shorter way round the circle, and none if the straight line misses the
// circle. With one it takes the way whose middle lies further towards the side site, and none if
// the straight line passes the circle on that side.
//
// Over an ellipsoid, which MuJoCo does not have, the way is drawn on a sphere, to which the
// ellipsoid is scaled: its sense and its touching are right, its lengths are near to the geodesic's.

#include <optional>
#include <span>

#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

/// A way in the frame of the geom.
struct Wrap {
  bool touches = false;               ///< false: the straight line
  bool inside = false;                ///< a site lies in the geom, which the tendon then ignores
  Vector3 normal = Vector3::UnitZ();  ///< about which the way runs counter-clockwise or clockwise
  bool counter_clockwise = true;
  double angle = 0.0;  ///< on the circle [rad]
  double before =
      0.0;             ///< length from the first site to the geom [m]; all of it if none is touched
  double on = 0.0;     ///< length on the geom [m]
  double after = 0.0;  ///< length from the geom to the second site [m]
  Vector3 arrives = Vector3::Zero();  ///< where the way comes to the geom
  Vector3 leaves = Vector3::Zero();   ///< where the way leaves the geom
  /// Largest distance of the way on a cylinder from its middle, along the axis [m].
  double height = 0.0;
};

/// `from`, `to` and `side` are in the frame of the geom.
[[nodiscard]] Wrap wrap_over(const Geom& geom, const Vector3& from, const Vector3& to,
                             const std::optional<Vector3>& side);

/// A geom between two points of a tendon.
struct Obstacle {
  const Geom* geom = nullptr;
  Frame frame;                  ///< in the world
  std::optional<Vector3> side;  ///< in the frame of the geom
};

/// The ways over geoms in this order between two points in the world, each in the frame of its geom,
/// from the geom before that is touched to the next one.
[[nodiscard]] std::vector<Wrap> wrap_over_all(std::span<const Obstacle> obstacles,
                                              const Vector3& from, const Vector3& to);

}  // namespace sheave::import::mjcf
