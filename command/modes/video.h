#pragma once
// A mode as a film or a picture.

#include <string>

#include "scenes/scene.h"
#include "statics/modes.h"

namespace sheave::command {

/// What a picture's sides may be [pixels], as sheave render has it.
constexpr int least_mode_picture = 16;
constexpr int most_mode_picture = 4096;

struct ModeVideo {
  std::string path;         ///< of the film; empty: none
  std::string still;        ///< of the picture; empty: none
  int mode = 1;             ///< from 1
  int width = 1280;         ///< [pixels]
  int height = 720;         ///< [pixels]
  double amplitude = 0.05;  ///< largest displacement, as a share of the scene's size, or in radians
};

/// Two periods in four seconds, whatever the frequency. A Failure (2) if there is no such mode.
void animate_mode(const Scene& scene, Simulation& simulation, const Modes& modes,
                  const ModeVideo& video);

}  // namespace sheave::command
