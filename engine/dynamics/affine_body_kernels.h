#pragma once
// Loops of every substep over bodies with one coordinate each (engine/dynamics/affine_bodies.h).

#include <array>
#include <cstddef>
#include <span>

#include "engine/state.h"

namespace sheave {

/// Coefficients of the orientation of a rotor: cos(a/2) upright + sin(a/2) turned at the angle a.
struct TurningBody {
  std::array<double, 4> upright{};
  std::array<double, 4> turned{};
  std::array<double, 3> axis{};  ///< unit vector, world frame
  int body = 0;
  int number = 0;
};

/// Speeds after loads, keep v + push. `end_speeds` may be the same array as `speeds`.
void load_speeds(std::size_t count, const double* keep, const double* push, const double* speeds,
                 double* end_speeds);
/// motion = h v.
void move_at(std::size_t count, double h, const double* speeds, double* motion);
/// Places at the end; false if a place or a speed is beyond its limit or not a number.
[[nodiscard]] bool move_places(std::size_t count, const double* places, const double* motion,
                               const double* farthest, const double* speeds, const double* fastest,
                               double* ends);
/// Writes angles, spins and orientations of rotors; `scratch` has room for three numbers per rotor.
void turn_bodies(std::span<const TurningBody> rotors, const double* places, const double* speeds,
                 double* scratch, BodyState* bodies);

}  // namespace sheave
