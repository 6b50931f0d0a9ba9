#pragma once
// Range of numbers for which the engine's arithmetic is valid.

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace sheave {

/// Numbers of a scene, in SI units, should be 0 or of a magnitude within [smallest_magnitude,
/// largest_magnitude].
///
/// Reason for 1e30: the engine multiplies at most ten numbers of a scene with each other before it
/// divides again. The highest degrees are those of the determinant of a moment of inertia, (mass
/// radius^2)^3, degree 9, and of the squared length of a gyroscopic torque, (mass radius^2
/// rate^2)^2, degree 10. The largest product is then 1e300 and the smallest 1e-300. Doubles reach
/// 1.8e308 and are precise down to 2.2e-308, which leaves a factor of 1e8 for sums and constants.
/// Outside this range products may become infinite or 0, and results may be wrong or not finite.
/// Within the range accuracy is not guaranteed; the certificate of a run checks that.
inline constexpr double largest_magnitude = 1e30;
inline constexpr double smallest_magnitude = 1e-30;

/// A number out of that range.
struct MagnitudeWarning {
  std::string pointer;  ///< JSON pointer of the setting
  double value = 0.0;
  std::string message;  ///< one sentence
};

/// All such numbers of a scene, at most `most`. Infinite values, which mean "none", are not
/// included. Masses that follow from densities are included.
[[nodiscard]] std::vector<MagnitudeWarning> check_magnitudes(const Scene& scene, std::size_t most);

}  // namespace sheave
