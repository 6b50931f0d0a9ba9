#include "engine/dynamics/affine_body_kernels.h"

#include <cmath>
#include <cstdint>

#include "engine/math/packs.h"
#include "engine/math/sine_cosine.h"

namespace sheave {

SHEAVE_IN_PACKS
void load_speeds(std::size_t count, const double* keep, const double* push, const double* speeds,
                 double* end_speeds) {
  for (std::size_t d = 0; d < count; ++d) end_speeds[d] = keep[d] * speeds[d] + push[d];
}

SHEAVE_IN_PACKS
void move_at(std::size_t count, double h, const double* speeds, double* __restrict motion) {
  for (std::size_t d = 0; d < count; ++d) motion[d] = h * speeds[d];
}

SHEAVE_IN_PACKS
bool move_places(std::size_t count, const double* places, const double* motion,
                 const double* farthest, const double* speeds, const double* fastest,
                 double* __restrict ends) {
  // A NaN passes no comparison.
  std::uint64_t beyond = 0;
  for (std::size_t d = 0; d < count; ++d) {
    ends[d] = places[d] + motion[d];
    beyond |= std::abs(ends[d]) <= farthest[d] ? 0U : 1U;
    beyond |= std::abs(speeds[d]) <= fastest[d] ? 0U : 1U;
  }
  return beyond == 0;
}

SHEAVE_IN_PACKS
void turn_bodies(std::span<const TurningBody> rotors, const double* places, const double* speeds,
                 double* __restrict scratch, BodyState* bodies) {
  double* const sines = scratch + rotors.size();
  double* const cosines = sines + rotors.size();
  for (std::size_t j = 0; j < rotors.size(); ++j) scratch[j] = 0.5 * places[rotors[j].number];
  sines_cosines(rotors.size(), scratch, sines, cosines);
  for (std::size_t j = 0; j < rotors.size(); ++j) {
    const TurningBody& rotor = rotors[j];
    BodyState& body = bodies[rotor.body];
    const double speed = speeds[rotor.number];
    double* const spin = body.angular_velocity.data();
    for (std::size_t i = 0; i < 3; ++i) spin[i] = speed * rotor.axis[i];
    body.angle = places[rotor.number];
    double* const orientation = body.orientation.coeffs().data();
    std::array<double, 4> now{};
    for (std::size_t i = 0; i < 4; ++i) {
      now[i] = cosines[j] * rotor.upright[i] + sines[j] * rotor.turned[i];
    }
    for (std::size_t i = 0; i < 4; ++i) orientation[i] = now[i];
  }
}

}  // namespace sheave
