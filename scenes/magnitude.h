#pragma once
// Sizes of numbers that the engine vouches for.

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace sheave {

/// Numbers of a scene, in SI units, should be 0 or of a magnitude within [smallest_magnitude,
/// largest_magnitude].
///
/// Why 1e30: the engine multiplies at most ten of a scene's numbers with each other before it
/// divides again. The most are in the determinant of a moment of inertia, (mass radius^2)^3, of
/// degree 9, and in the square of a gyroscopic torque's length, (mass radius^2 rate^2)^2, of degree
/// 10. Then the largest product is 1e300 and the smallest 1e-300; doubles reach to 1.8e308 and are
/// precise from 2.2e-308 on, which leaves a factor of 1e8 for sums and constants. Beyond this range
/// products may be infinite or 0, and what follows from them is not finite or wrong. Within it that
/// is no promise of accuracy: that is what the certificate of a run tells.
inline constexpr double largest_magnitude = 1e30;
inline constexpr double smallest_magnitude = 1e-30;

/// A number out of that range.
struct MagnitudeWarning {
  std::string pointer;  ///< JSON pointer of the setting
  double value = 0.0;
  std::string message;  ///< one sentence
};

/// All such numbers of a scene, at most `most`; infinite ones, which are no numbers but say "none",
/// are not among them. Masses that follow from densities count too.
[[nodiscard]] std::vector<MagnitudeWarning> check_magnitudes(const Scene& scene, std::size_t most);

}  // namespace sheave
