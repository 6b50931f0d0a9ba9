#pragma once
// By how much a quantity differs between three runs with the substeps h, h/2 and h/4, and what that
// says of its error.
//
// If q(h) = q + C h^p, the differences are d1 = q(h) - q(h/2) = C h^p (1 - 2^-p) and d2 = q(h/2) -
// q(h/4) = 2^-p d1, whence
//   p = log2(|d1| / |d2|),   q(h) - q = d1 2^p / (2^p - 1): twice d1 for p = 1, 4/3 of it for p = 2.
// Here d1 and d2 are vectors of all frames (and components, and bodies), and |.| is their Euclidean
// norm. Two numbers always have a ratio; but only if the law holds do both vectors have one
// direction. So an order is told where the cosine of the angle between them is at least 0.9, which
// differences that events or chaos have made have by chance only, and p at least 0.7: a little
// below the first order, for there the next term of the series still counts.

#include <cstddef>
#include <optional>

#include "engine/vector.h"

namespace sheave::measure {

/// Relative differences below this are rounding, or what the solver leaves: its tolerance is 1e-10
/// of the size.
inline constexpr double negligible_difference = 1e-9;

/// The difference of the run with h from that with h/2, where it is largest.
struct StepDifference {
  double largest = 0.0;  ///< of all frames [unit of the quantity], >= 0
  double time = 0.0;     ///< of that frame [s]
  double at_end = 0.0;   ///< in the last frame, >= 0
  double scale = 1.0;    ///< what it is compared with, >= 0, same unit
  /// Of the error in the substep; nothing if the two differences do not obey one law, or are
  /// negligible.
  std::optional<double> order{};

  /// largest / scale; 0 if there is no difference, even without a scale.
  [[nodiscard]] double relative() const;
  /// What the error of the run with h comes to where the difference is largest, by the order;
  /// without one the difference, which the error may exceed.
  [[nodiscard]] double error() const;
};

/// Adds up the frames of a run.
class StepDifferenceSum {
 public:
  /// A part of this frame's differences d1 and d2: of one body, of one tension (y = z = 0).
  void add(const Vector3& coarse, const Vector3& fine);
  /// The frame at this time [s] has all its parts.
  void end_frame(double time);
  /// Norm of the last frame's d1.
  [[nodiscard]] double last() const { return last_; }
  /// Norms are divided by the root of `parts`, the number that a frame has, if they are to be means
  /// over these.
  [[nodiscard]] StepDifference result(double scale, std::size_t parts = 1) const;

 private:
  double frame_ = 0.0;  // |d1|^2 of the frame that is being added
  double last_ = 0.0;
  double largest_ = 0.0;
  double time_ = 0.0;
  // Over all frames:
  double coarse_ = 0.0;   // |d1|^2
  double fine_ = 0.0;     // |d2|^2
  double product_ = 0.0;  // d1 . d2
};

}  // namespace sheave::measure
