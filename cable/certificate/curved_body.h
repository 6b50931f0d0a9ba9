#pragma once
// Smooth bodies as the certificate sees them: from the shapes of the scene, with formulas of its own.

#include <optional>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// Unit normal of a surface at a point, and the distance of the point from the surface [m].
struct Outward {
  Vector3 normal;
  double off;
};

/// A cone, a torus or an ellipsoid at the end of the substep.
struct CurvedBody {
  enum class Kind { cone, torus, ellipsoid };
  Kind kind = Kind::ellipsoid;
  Vector3 center = Vector3::Zero();    ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< columns: x, y and z of the shape
  /// Ellipsoid: its half axes [m]. Cone: radii at both ends and length [m]. Torus: radii of the ring
  /// and of the tube [m].
  Vector3 sizes = Vector3::Ones();

  [[nodiscard]] Outward outward_at(const Vector3& point) const;
  /// Largest bend of the surface times its smallest size, by which an error of angle can grow.
  [[nodiscard]] double sharpness() const;
  /// Ellipsoid: components of a vector divided by the squares of the half axes, in the world frame.
  [[nodiscard]] Vector3 gradient(const Vector3& vector) const;
};

/// The curved body on which the cable lies along a geodesic at this link; none: the link is of
/// another kind.
[[nodiscard]] std::optional<CurvedBody> curved_body(const Evidence& evidence,
                                                    const LinkReport& link);

/// How far the geodesic is from one between these spans [m]: its ends, the direction of the spans,
/// the moment about an axis, and the points of the path. `in` and `out` are unit vectors along the
/// spans.
[[nodiscard]] double off_curved_body(const CurvedBody& body, const LinkReport& link,
                                     const Vector3& in, const Vector3& out);

}  // namespace sheave::certify
