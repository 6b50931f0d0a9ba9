#pragma once
// Smooth bodies and their geodesics; internal to the cable library.
//
// A surface is the set of points at one distance from a segment, its core: a ball (the core is a
// point), a capsule, or the side of a cylinder, whose core has no end. On each of them geodesics
// are known in closed form: a helix on the part beside the core, a great circle on the caps. Both
// meet with a common tangent. A neighbouring geodesic that starts at the distance J and drifts away
// at the rate J' obeys J'' = -K J with the Gaussian curvature K, 0 beside the core and 1 / r^2 on
// the caps.

#include "engine/vector.h"

namespace sheave {

/// A point of a surface and the direction of a geodesic through it.
struct SurfaceFrame {
  Vector3 point = Vector3::Zero();      ///< [m]
  Vector3 tangent = Vector3::UnitX();   ///< unit tangent of the geodesic
  Vector3 outward = -Vector3::UnitY();  ///< unit normal of the surface

  /// Unit tangent of the surface at right angles to the geodesic, which runs counter-clockwise
  /// about it.
  [[nodiscard]] Vector3 across() const { return cross(outward, tangent); }
};

struct SmoothSurface {
  Vector3 center = Vector3::Zero();  ///< middle of the core [m]
  Vector3 axis = Vector3::UnitZ();   ///< unit vector along the core
  double half_length = 0.0;          ///< of the core [m]; 0: a ball
  double radius = 0.0;               ///< [m], > 0
  /// Half balls close the surface at the core's ends. Otherwise it is the side of a cylinder, which
  /// counts as endless; beyond_ends() tells about its ends.
  bool round_ends = true;

  /// Along the axis, from the middle [m].
  [[nodiscard]] double height(const Vector3& point) const { return dot(axis, point - center); }
  /// The point of the core that is nearest to a point.
  [[nodiscard]] Vector3 core(const Vector3& point) const;
  /// The frame at the point of the surface nearest to `point`, with a tangent near `tangent`.
  [[nodiscard]] SurfaceFrame frame(const Vector3& point, const Vector3& tangent) const;
  /// Change of the outward normal with a motion along the surface [1/m times the motion].
  [[nodiscard]] Vector3 bend(const SurfaceFrame& at, const Vector3& motion) const;
  /// Distance of a point beyond the ends of a cylinder [m]; 0: the point is between them.
  [[nodiscard]] double beyond_ends(const Vector3& point) const;
};

/// The end of a geodesic.
struct SurfaceWay {
  SurfaceFrame end;
  double turned = 0.0;  ///< integral of the curvature, with the sign of the length [rad]
  // Of neighbouring geodesics, at the end: their distance and its rate,
  double shifted = 1.0;  ///< per distance at the start
  double shifted_rate = 0.0;
  double turned_off = 0.0;  ///< per angle at the start [m]
  double turned_off_rate = 1.0;
};

/// The geodesic of the given length [m]; a negative length runs backwards.
[[nodiscard]] SurfaceWay straightest_way(const SmoothSurface& surface, const SurfaceFrame& start,
                                         double length);

/// The shortest path over a ball or an endless cylinder from one point outside it to another.
struct WayBetween {
  SurfaceFrame entry;
  double length = 0.0;  ///< on the surface [m]; < 0: the straight line misses the body
};
/// `across` is about SurfaceFrame::across() and gives the side on which the path passes the body.
/// `length` [m] is an estimate, which decides between numbers of turns round a cylinder.
[[nodiscard]] WayBetween way_between(const SmoothSurface& surface, const Vector3& from,
                                     const Vector3& to, const Vector3& across, double length);

/// The passage of a line by the core.
struct CorePassage {
  double along = 0.0;               ///< from the line's start to its point nearest to the core [m]
  Vector3 point = Vector3::Zero();  ///< that point [m]
  Vector3 core = Vector3::Zero();   ///< the point of the core nearest to it [m]
  double beyond = 0.0;  ///< distance at which the line passes beyond a cylinder's ends [m]; else 0
};
/// `direction` is a unit vector. For a cylinder `core` lies between its ends.
[[nodiscard]] CorePassage core_passage(const SmoothSurface& surface, const Vector3& start,
                                       const Vector3& direction);

}  // namespace sheave
