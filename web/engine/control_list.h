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

/// Drives of bodies and joints, limits of brakes, and feeds of cables, in the order of the scene.
[[nodiscard]] std::vector<SliderControl> slider_controls(const Scene& scene);

}  // namespace sheave::web
