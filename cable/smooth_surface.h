#pragma once
// Smooth bodies and their geodesics; internal to the cable library.
//
// A ball, a capsule and the side of a cylinder are the points at one distance from a segment, their
// core. On them and on the side of a cone, which unrolls, geodesics are known in closed form. On a
// torus, whose core is a circle, and on an ellipsoid they are integrated (cable/geodesic_flow.h).
// The sides of cylinders and cones count as endless; beyond_ends() tells about their ends. A
// neighbouring geodesic that starts at the distance J and drifts away at the rate J' obeys J'' = -K
// J with the Gaussian curvature K.

#include <cstdint>

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

enum class SurfaceForm : std::uint8_t {
  rounded,    ///< a ball or a capsule: half balls close the surface at the core's ends
  cylinder,   ///< the side, without the flat ends
  cone,       ///< the side of a cone or frustum, without the flat ends
  torus,      ///< the core is a circle, the ring
  ellipsoid,  ///< the core is the centre
};

struct SmoothSurface {
  SurfaceForm form = SurfaceForm::rounded;
  Vector3 center = Vector3::Zero();  ///< of the body [m]; of a cone: half way between its ends
  Vector3 axis = Vector3::UnitZ();   ///< unit vector along the core; of a torus: normal of its ring
  /// Ellipsoid: unit vector along the first of its half axes, at right angles to `axis`, the third.
  Vector3 side = Vector3::UnitX();
  double half_length = 0.0;  ///< of the core, or between the middle and the ends of a cone [m]
  /// [m], > 0. Cone: half way between the ends. Torus: of the tube. Ellipsoid: the geometric mean
  /// of the half axes.
  double radius = 0.0;
  double slope = 0.0;                   ///< cone: growth of the radius along the axis, not 0
  double ring = 0.0;                    ///< torus: radius of its core [m], > radius
  Vector3 half_axes = Vector3::Zero();  ///< ellipsoid: along side, axis x side and axis [m], > 0

  [[nodiscard]] bool is_ball() const { return form == SurfaceForm::rounded && half_length == 0.0; }
  [[nodiscard]] bool is_capsule() const {
    return form == SurfaceForm::rounded && half_length > 0.0;
  }
  /// Whether the surface ends at flat ends, which are no part of it.
  [[nodiscard]] bool has_ends() const {
    return form == SurfaceForm::cylinder || form == SurfaceForm::cone;
  }
  /// Along the axis, from the middle [m].
  [[nodiscard]] double height(const Vector3& point) const { return dot(axis, point - center); }
  /// The point of the core that is nearest to a point; for a cone the point of the axis at the same
  /// height.
  [[nodiscard]] Vector3 core(const Vector3& point) const;
  /// The frame at the point of the surface nearest to `point` (for an ellipsoid on the ray from its
  /// centre), with a tangent near `tangent`.
  [[nodiscard]] SurfaceFrame frame(const Vector3& point, const Vector3& tangent) const;
  /// Change of the outward normal with a motion along the surface [1/m times the motion].
  [[nodiscard]] Vector3 bend(const SurfaceFrame& at, const Vector3& motion) const;
  /// Radius of curvature of the geodesic there [m], within the sizes of the body.
  [[nodiscard]] double bend_radius(const SurfaceFrame& at) const;
  /// Whether the body is hollow along the geodesic there, so that a taut cable would lift off.
  [[nodiscard]] bool is_hollow(const SurfaceFrame& at) const;
  /// Distance of a point beyond the flat ends [m]; 0: the point is between them.
  [[nodiscard]] double beyond_ends(const Vector3& point) const;
  /// Whether a point lies inside the body, between its flat ends if it has some.
  [[nodiscard]] bool contains(const Vector3& point) const;
  /// Largest distance of the body from its centre [m].
  [[nodiscard]] double reach() const;

  /// Ellipsoid: coordinates along its half axes of a vector, and the vector of such coordinates.
  [[nodiscard]] Vector3 to_own(const Vector3& v) const {
    return {dot(side, v), dot(cross(axis, side), v), dot(axis, v)};
  }
  [[nodiscard]] Vector3 from_own(const Vector3& v) const {
    return v[0] * side + v[1] * cross(axis, side) + v[2] * axis;
  }
};

/// The tip of a cone and its opening.
struct ConeTip {
  Vector3 point = Vector3::Zero();  ///< [m]
  Vector3 up = Vector3::UnitZ();    ///< unit vector from the tip into the cone
  double growth = 1.0;              ///< of the radius along `up`, > 0
  double sine = 0.0;                ///< of half the angle at the tip
  double cosine = 1.0;
};
[[nodiscard]] ConeTip tip_of(const SmoothSurface& cone);

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

/// A path over a body from one point outside it to another: the shortest for a ball and an endless
/// cylinder, an estimate for other bodies.
struct WayBetween {
  SurfaceFrame entry;
  double length = 0.0;  ///< on the surface [m]; < 0: the straight line misses the body
};
/// `at` is on the surface. Its SurfaceFrame::across() gives the side on which the path passes the
/// body. `length` [m] is an estimate, which decides between numbers of turns.
[[nodiscard]] WayBetween way_between(const SmoothSurface& surface, const Vector3& from,
                                     const Vector3& to, const SurfaceFrame& at, double length);

/// The passage of a line by the core.
struct CorePassage {
  double along = 0.0;               ///< from the line's start to its point nearest to the body [m]
  Vector3 point = Vector3::Zero();  ///< the point of the line that is nearest to the core [m]
  Vector3 core = Vector3::Zero();   ///< the point of the core nearest to it [m]
  double beyond = 0.0;  ///< distance at which the line passes beyond the flat ends [m]; else 0
};
/// `direction` is a unit vector. For a cylinder `core` lies between its ends. `near`, if not null,
/// is a point of a torus's core: the passage is then the one that is nearest to it.
[[nodiscard]] CorePassage core_passage(const SmoothSurface& surface, const Vector3& start,
                                       const Vector3& direction, const Vector3* near = nullptr);

/// Depth below the surface [m] of a line with this passage that lies at the signed distance
/// `distance` from the core, in the direction from the core to the line.
[[nodiscard]] double depth_of(const SmoothSurface& surface, const CorePassage& passage,
                              const Vector3& direction, double distance);

/// The frame at which a line of this direction touches the body that it passes at this point of the
/// core, on the side `outward` (a unit vector).
[[nodiscard]] SurfaceFrame touched_frame(const SmoothSurface& surface, const Vector3& core,
                                         const Vector3& outward, const Vector3& direction);

}  // namespace sheave
