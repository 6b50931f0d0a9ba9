#pragma once

#include "scenes/scene.h"

namespace sheave::measure {

/// Gives no inertia about their axles to all rotors that can do without
/// (cable/cable_compile_links.cpp): round wheels that one cable passes over without end or slip,
/// with neither drive, torque, drag, joint nor contact. Returns their number.
[[nodiscard]] int make_wheels_massless(Scene& scene);

}  // namespace sheave::measure
