#pragma once
// What the links that run along a body have in common: where the cable's plane cuts it.

#include <optional>

#include "cable/link.h"

namespace sheave {

/// Settings of a wheel or outline; the fields mean what RollingLink says.
struct WheelPlacement {
  BodyId body;
  Winding winding = Winding::counter_clockwise;
  std::optional<Vector3> center;
  std::optional<Vector3> normal;
  std::optional<double> radius;
};

/// A circle if a radius is given or the body has a wheel-like shape whose section is one, otherwise the hull of the
/// section of all its shapes; on the body itself, also if that is a mounted rotor. Errors have the
/// prefix `path`.
[[nodiscard]] Result<LinkGeometry> place_wheel(const WheelPlacement& placement,
                                               const BodySet& bodies, const std::string& path);

/// A wheel whose centre lies on the axle of a mounted rotor gets it and its plane fixed to the carrier, which saves
/// following the rotor's own angle.
void carry_by_axle(const BodySet& bodies, LinkGeometry& link);

}  // namespace sheave
