#pragma once
// Warnings about a scene that is valid but perhaps not meant, before its run begins.

#include <vector>

#include "cable/step_warnings.h"
#include "scenes/scene.h"

namespace sheave {

/// Numbers outside the range that the engine vouches for (scenes/magnitude.h), at most 10. The
/// subject is a JSON pointer.
[[nodiscard]] std::vector<Warning> magnitude_warnings(const Scene& scene);

/// Elastic cables whose rest lengths stretch them absurdly (cable/start_warnings.h). None if the
/// scene says that its pose is meant ("start": "pose"), or starts in a saved state.
[[nodiscard]] std::vector<Warning> strain_warnings(const Scene& scene);

/// All warnings that need no search: numbers, windings, strains. The subject of a winding is a JSON
/// pointer.
[[nodiscard]] std::vector<Warning> scene_warnings(const Scene& scene);

/// The warnings of cables with which a run of the scene begins: windings, strains, and an elastic
/// cable that starts far from its rest ("unsettled_start"), which takes a search for the rest
/// (statics/start_at_rest.h).
[[nodiscard]] std::vector<Warning> start_warnings(const Scene& scene);

}  // namespace sheave
