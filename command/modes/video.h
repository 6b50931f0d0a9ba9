#pragma once
// A vibration mode as a film or a picture.

#include <string>

#include "scenes/scene.h"
#include "statics/modes.h"

namespace sheave::command {

/// Bounds of the sides of a picture [pixels], as in sheave render.
constexpr int least_mode_picture = 16;
constexpr int most_mode_picture = 4096;

struct ModeVideo {
  std::string path;   ///< file of the film; empty: none
  std::string still;  ///< file of the picture; empty: none
  int mode = 1;       ///< number of the mode, from 1
  int width = 1280;   ///< [pixels]
  int height = 720;   ///< [pixels]
  /// Largest displacement as a share of the scene's size, or largest rotation [rad].
  double amplitude = 0.05;
};

/// Shows two periods in four seconds, independent of the frequency. A Failure (2) if there is no
/// such mode.
void animate_mode(const Scene& scene, Simulation& simulation, const Modes& modes,
                  const ModeVideo& video);

}  // namespace sheave::command
