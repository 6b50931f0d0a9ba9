#pragma once
// The controls of a scene that a page makes sliders of.

#include <string>
#include <vector>

#include "scenes/control/control_point.h"
#include "scenes/scene.h"

namespace sheave::web {

struct SliderControl {
  std::string name;  ///< as triggers and controllers call it, e.g. "drum.drive"
  std::string unit;
  double value = 0.0;    ///< that the scene begins with
  double minimum = 0.0;  ///< of a slider; the control itself may allow more
  double maximum = 1.0;
  ControlPoint point;
};

/// Drives of bodies and joints, the limits of brakes, feeds of cables, in the order of the scene.
[[nodiscard]] std::vector<SliderControl> slider_controls(const Scene& scene);

}  // namespace sheave::web
