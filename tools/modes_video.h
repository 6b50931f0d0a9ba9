#pragma once
// A mode as a film or a picture.

#include <string>

#include "scenes/scene.h"
#include "statics/modes.h"

namespace sheave::tools {

struct ModeVideo {
  std::string path;         ///< of the film; empty: none
  std::string still;        ///< of the picture; empty: none
  int mode = 1;             ///< from 1
  double amplitude = 0.05;  ///< largest displacement, as a share of the scene's size, or in radians
};

/// Two periods in four seconds, whatever the frequency. A Failure (2) if there is no such mode.
void animate_mode(const Scene& scene, Simulation& simulation, const Modes& modes,
                  const ModeVideo& video);

}  // namespace sheave::tools
