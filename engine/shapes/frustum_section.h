#pragma once

#include <vector>

#include "engine/shapes/section.h"

namespace sheave {

/// Appends the section of a frustum along z from -length / 2, where it has the radius `radius` [m],
/// to length / 2.
void append_frustum_section(double radius, double top_radius, double length,
                            const SectionPlane& plane, std::vector<Vector3>& points);

}  // namespace sheave
