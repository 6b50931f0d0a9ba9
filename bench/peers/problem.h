#pragma once
// Problems that several engines can be given: weights and wheels along one cable, which neither
// stretches nor slips.
//
// Everything is told along the cable. Coordinate i is how far weight or wheel rim i has moved
// towards the last weight [m]; it has the mass m_i (of a wheel J / r^2) and is pulled with the
// force f_i. Span i joins coordinates i and i + 1 and can only pull: s_(i+1) - s_i <= 0. While all
// spans are taut they move as one,
//   s_i = a t^2 / 2,   a = sum f_i / sum m_i,
// which is exact, so errors need no reference run.

#include <string>
#include <vector>

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave::peers {

/// One weight or wheel.
struct Coordinate {
  double mass = 0.0;    ///< [kg]; of a wheel J / r^2
  double pull = 0.0;    ///< +1 if gravity pulls it towards the last weight, -1 away, 0 wheels
  double radius = 0.0;  ///< of a wheel [m]; 0: a weight
  int body = 0;         ///< in the scene
  double sense = 1.0;   ///< s = sense x (y - y0), or sense x radius x angle
};

struct Problem {
  std::string name;
  double gravity = 0.0;    ///< [m/s2]
  double dt = 1.0 / 60.0;  ///< of a frame and step [s]
  int frames = 60;
  double scale = 1.0;  ///< size of the scene [m]
  std::vector<Coordinate> coordinates;
  Scene scene;

  [[nodiscard]] double acceleration() const;  ///< [m/s2]
  [[nodiscard]] double duration() const { return dt * frames; }
};

/// Atwood's machine, the paper's simple scene with its bodies on vertical rails (all they do is
/// move up and down), and trains of 64 and 256 wheels. An error if a scene cannot be loaded.
[[nodiscard]] Result<std::vector<Problem>> all_problems(const std::string& source_folder);

}  // namespace sheave::peers
