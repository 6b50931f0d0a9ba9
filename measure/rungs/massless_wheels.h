#pragma once

#include "scenes/scene.h"

namespace sheave::measure {

/// Removes the inertia about the axle from all rotors for which that is allowed
/// (cable/cable_compile_links.cpp): round wheels that one cable passes over without end or slip,
/// without drive, torque, drag, joint or contact. Returns their number.
[[nodiscard]] int make_wheels_massless(Scene& scene);

}  // namespace sheave::measure
