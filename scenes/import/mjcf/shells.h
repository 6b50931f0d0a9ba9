#pragma once
// Geoms whose mass lies on their surface (shellinertia).

#include "engine/vector.h"
#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

/// Area of the surface of a sphere, capsule, cylinder, ellipsoid or box [m2]; 0 of others.
[[nodiscard]] double shell_area(const Geom& geom);
/// Moments of inertia of a mass on this surface, about the centre, own axes [kg m2].
[[nodiscard]] Vector3 shell_moments(const Geom& geom, double mass);

}  // namespace sheave::import::mjcf
