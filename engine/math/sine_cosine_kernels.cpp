#include "engine/math/packs.h"
#include "engine/math/sine_cosine.h"

namespace sheave {

SHEAVE_IN_PACKS
void sines_cosines(std::size_t count, const double* angles, double* __restrict sines,
                   double* __restrict cosines) {
  std::uint64_t large = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // The comparison is false for a NaN.
    large |= std::abs(angles[i]) < small_angle ? 0U : 1U;
  }
  for (std::size_t i = 0; i < count && large == 0; ++i) {
    const SineCosine both = sine_cosine_of_small(angles[i]);
    sines[i] = both.sine;
    cosines[i] = both.cosine;
  }
  for (std::size_t i = 0; i < count && large != 0; ++i) {
    const SineCosine both = sine_cosine(angles[i]);
    sines[i] = both.sine;
    cosines[i] = both.cosine;
  }
}

}  // namespace sheave
