#pragma once
// Distance between two scenes that must be similar (scenes/scaling.h).

#include "engine/work_limit.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// The larger of the errors of positions and tensions (measure/run_error.h) of `scene` against
/// `original`, in the original's units. Infinite if one diverges; an error if one does not build,
/// or if `stop` ended it.
[[nodiscard]] Result<double> similarity_error(const Scene& scene, const Scene& original,
                                              double length_factor, double mass_factor,
                                              const StopRequest& stop = {});

}  // namespace sheave::measure
