#pragma once

#include <optional>

#include "cable/link.h"

namespace sheave {

/// The cable lies on a smooth body along a geodesic, and slides over it. A `rolling` link holds the
/// cable in a plane, as a groove does; here only friction along the cable acts, and nothing holds
/// the cable sideways.
class SurfaceLink final : public LinkDef {
 public:
  /// Side of the body on which the cable passes: the direction in which the cable runs round
  /// `normal`. Exactly one of `winding`, `side` and `side_point` is needed.
  std::optional<Winding> winding;
  std::optional<Side> side;  ///< left or right; left is counter-clockwise
  /// Direction from which the winding is seen, body frame, any length except 0; default: the z axis
  /// of the body's shape. The geodesic need not be perpendicular to it.
  std::optional<Vector3> normal;
  /// A point outside the shape, body frame [m]: at time 0 the cable passes the body on this side.
  /// Of a torus it also selects the part of the ring.
  std::optional<Vector3> side_point;
  /// Capstan coefficient, >= 0: the tensions on both sides differ by at most the factor e^(friction
  /// x angle), where the angle is the integral of the geodesic's curvature.
  double friction = 0.0;
  /// Which of the body's shapes, from 0; it must be a sphere, a cylinder, a capsule, a cone, a torus
  /// or an ellipsoid.
  int shape = 0;
  /// Whether the cable does not touch the body at time 0. When the cable comes to touch
  /// the body between the same two links, the body catches the cable on the side where it was.
  bool lifted = false;

  static constexpr std::string_view type_name = "surface";
  static constexpr std::string_view type_meaning =
      "the cable lies on a ball, a cylinder, a capsule, a cone, a torus or an ellipsoid along a "
      "geodesic, and slides over it";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
