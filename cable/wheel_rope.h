#pragma once
// Spans of ropes with weight that end on wheels: their place in space, and their forces on the links.
// cable/cable_weight.cpp has the derivation.

#include <array>
#include <optional>

#include "cable/span_geometry.h"
#include "cable/wheel_catenary.h"
#include "engine/vector.h"

namespace sheave {

/// The vertical plane of a span of a rope with weight, and the wheels at its ends.
struct WheelPlane {
  bool has_wheels = false;            ///< false: both ends are points, and nothing else is known
  WheelSpan span;                     ///< in the plane
  Vector3 up = Vector3::UnitY();      ///< z of the plane
  Vector3 level = Vector3::UnitX();   ///< x of the plane; the span runs towards it
  Vector3 normal = Vector3::UnitZ();  ///< about which the radii are signed
  std::array<double, 2> radii{};      ///< signed radii about `normal` [m]
  std::array<Vector3, 2> centers{Vector3::Zero(), Vector3::Zero()};  ///< of the wheels [m]

  /// A length of the span, > 0 [m].
  [[nodiscard]] double size() const;
};

/// The rope stored on a wheel, as a load on it.
struct StoredLoad {
  double weight = 0.0;  ///< [N]
  /// Integral of the place relative to the centre over the weight [N m].
  Vector3 offset = Vector3::Zero();
};

/// A force on a link of a rope [N], and the world point at which it acts [m].
struct EndForce {
  Vector3 force = Vector3::Zero();
  Vector3 point = Vector3::Zero();
};

/// The load of rope with this weight per length, of which `length` covers `arc` on a wheel [m].
/// `turned` is the direction of the rope that comes to the wheel less that of the rope that leaves it;
/// a drum at the end of a rope has one of them only, and its rope lies all round it.
[[nodiscard]] StoredLoad stored_load(double weight, double length, double arc, double radius,
                                     const Vector3& turned);

/// The plane of a span with the straight tangent `span` between circles with these centres, and with
/// signed radii about `normal`. `gravity` [m/s2] is not 0.
[[nodiscard]] WheelPlane wheel_plane(const SpanGeometry& span, const Vector3& normal,
                                     const std::array<Vector3, 2>& centers,
                                     const std::array<double, 2>& radii, const Vector3& gravity);

/// Tensions of the rope at its ends [N].
[[nodiscard]] std::array<Vector3, 2> end_tensions(const WheelPlane& plane,
                                                  const WheelCatenary& rope);

/// Forces of a span on its links: the tension at the tangent point, the weight of the additional arc,
/// and the load of stored rope, with the moment of all of them about the centre of the wheel. `length`
/// [m], unstretched and between the points of the straight tangent, has the weight if it is not that
/// of the tension: a damper has a part of the tension that shapes no catenary.
[[nodiscard]] std::array<EndForce, 2> end_forces(const WheelPlane& plane, const WheelCatenary& rope,
                                                 const std::array<StoredLoad, 2>& stored,
                                                 std::optional<double> length);

/// The slopes of these forces by the chord tension, from the same span at a tension that is larger by
/// `step` [N], and with the same `length`.
[[nodiscard]] std::array<EndForce, 2> force_slopes(const WheelPlane& plane,
                                                   const WheelCatenary& rope,
                                                   const WheelCatenary& tighter, double step,
                                                   std::optional<double> length);

}  // namespace sheave
