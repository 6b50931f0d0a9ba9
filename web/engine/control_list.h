#pragma once
// The controls of a scene for which a page shows sliders.

#include <string>
#include <vector>

#include "scenes/control/control_point.h"
#include "scenes/scene.h"

namespace sheave::web {

struct SliderControl {
  std::string name;  ///< name in triggers and controllers, e.g. "drum.drive"
  std::string unit;
  double value = 0.0;    ///< at the start of the scene
  double minimum = 0.0;  ///< range of the slider; the control itself may have a wider range
  double maximum = 1.0;
  ControlPoint point;
};

/// Drives of bodies and joints, limits of brakes, feeds of cables, and excitations of muscles, in
/// the order of the scene. `simulation` is a simulation of it with its supervisor.
[[nodiscard]] std::vector<SliderControl> slider_controls(const Scene& scene,
                                                         const Simulation& simulation);

}  // namespace sheave::web
