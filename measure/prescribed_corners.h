#pragma once
// Times at which a scene itself prescribes a jump of an acceleration or of a force: the points of
// tables.

#include <vector>

#include "scenes/scene.h"

namespace sheave::measure {

/// Times of the points of all drives of bodies and joints, and of all setpoints of controllers, in
/// increasing order, each once [s].
[[nodiscard]] std::vector<double> prescribed_corners(const Scene& scene);

}  // namespace sheave::measure
