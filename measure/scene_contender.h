#pragma once

#include <string>

#include "engine/result.h"
#include "engine/work_limit.h"
#include "measure/timing.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// A scene with its own settings, ready to be timed from time 0 to its duration. The contender owns
/// the simulation.
[[nodiscard]] Result<Contender> scene_contender(std::string name, const Scene& scene,
                                                StopRequest stop = {});

}  // namespace sheave::measure
