#pragma once
// The loops over bodies with one number each that every substep goes through
// (engine/dynamics/affine_bodies.h).

#include <array>
#include <cstddef>
#include <span>

#include "engine/state.h"

namespace sheave {

/// What a state says of a rotor: at the angle a its orientation is cos(a/2) upright + sin(a/2)
/// turned, as coefficients.
struct TurningBody {
  std::array<double, 4> upright{};
  std::array<double, 4> turned{};
  std::array<double, 3> axis{};  ///< unit vector, world frame
  int body = 0;
  int number = 0;
};

/// Speeds after loads, keep v + push; those at the end may be those of the start.
void load_speeds(std::size_t count, const double* keep, const double* push, const double* speeds,
                 double* end_speeds);
/// motion = h v.
void move_at(std::size_t count, double h, const double* speeds, double* motion);
/// Places at the end; false if one of them, or a speed, is beyond its limit or no number.
[[nodiscard]] bool move_places(std::size_t count, const double* places, const double* motion,
                               const double* farthest, const double* speeds, const double* fastest,
                               double* ends);
/// Writes angles, spins and orientations of rotors; `scratch` has room for three numbers of each.
void turn_bodies(std::span<const TurningBody> rotors, const double* places, const double* speeds,
                 double* scratch, BodyState* bodies);

}  // namespace sheave
