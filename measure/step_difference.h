#pragma once
// Differences of a quantity between three runs with the substeps h, h/2 and h/4, and the error that
// follows from them.
//
// If q(h) = q + C h^p, the differences are d1 = q(h) - q(h/2) = C h^p (1 - 2^-p) and d2 = q(h/2) -
// q(h/4) = 2^-p d1, whence
//   p = log2(|d1| / |d2|),   q(h) - q = d1 2^p / (2^p - 1): 2 d1 for p = 1, 4/3 d1 for p = 2.
// d1 and d2 are vectors of all frames (and components, and bodies), and |.| is their Euclidean
// norm. Two numbers always have a ratio, but both vectors have the same direction only if the law
// holds. An order is therefore reported only if the cosine of the angle between them is at least
// 0.9, which differences by events or chaos reach only by chance, and if p is at least 0.7: a
// little below the first order, where the next term of the series still counts. Above p = 4.5 d2 is
// almost nothing against d1, which no law of the step explains.
//
// Without an order the error is d1 + d2 plus the error of q(h/4). For a method of at least first
// order the latter is at most |d2|, and at most half of |d1|. The reported bound is therefore
//   |d1 + d2| + max(|d2|, |d1| / 2),
// which is the error itself for p = 1 and 1.3 times that for p = 2. An event at a time t (a rope
// becomes taut, a cable is cut) takes effect in each run at the end of the substep that contains t:
// with h late by u, u + h/4, u + h/2 or u + 3h/4, and with h/4 late by u < h/4. If the error is
// proportional to the delay, these four cases have d1 = 0, 0, h/2, h/2 and d2 = 0, h/4, 0, h/4
// times that, and the reported bound is 0, h/2, 3h/4 or h times that: at least the error, except in
// the first case. There all runs have the same delay, and no comparison of them can see it
// (`unseen`).

#include <cstddef>
#include <optional>

#include "engine/vector.h"

namespace sheave::measure {

/// Relative differences below this are rounding or the solver's residual, whose tolerance is 1e-10
/// of the size.
inline constexpr double negligible_difference = 1e-9;

/// The larger of d1 and d2 in the frame where it is largest, and the error that follows.
struct StepDifference {
  double largest = 0.0;  ///< of all frames [unit of the quantity], >= 0
  double time = 0.0;     ///< of that frame [s]
  double at_end = 0.0;   ///< in the last frame, >= 0
  double scale = 1.0;    ///< reference of relative differences, >= 0, same unit
  /// Order of the error in the substep; nothing if the two differences do not obey one law or are
  /// negligible.
  std::optional<double> order{};
  /// bound of the error without an order, see above; largest of all frames, >= 0
  double bound = 0.0;
  /// Possible effect of sudden events that all three runs found at the same time, >= 0. Set by
  /// observers of events.
  double unseen = 0.0;

  /// largest / scale; 0 if there is no difference, even without a scale.
  [[nodiscard]] double relative() const;
  /// Whether all differences are only rounding.
  [[nodiscard]] bool negligible() const;
  /// Error of the run with h in the frame with the largest difference, by the order. Without an
  /// order the larger of `bound` and `unseen`.
  [[nodiscard]] double error() const;
};

/// Sums over the frames of a run.
class StepDifferenceSum {
 public:
  /// Adds a part of this frame's differences d1 and d2: of one body, or of one tension (y = z = 0).
  void add(const Vector3& coarse, const Vector3& fine);
  /// Completes the frame at this time [s].
  void end_frame(double time);
  /// Norm of the last frame's d1 or d2, whichever is larger.
  [[nodiscard]] double last() const { return last_; }
  /// `parts`: number of parts in a frame, if the norms are to be root mean squares over them; else
  /// 1.
  [[nodiscard]] StepDifference result(double scale, std::size_t parts = 1) const;

 private:
  //d1|^2, |d2|^2 and |d1 + d2|^2 of the present frame.
  double frame_coarse_ = 0.0;
  double frame_fine_ = 0.0;
  double frame_sum_ = 0.0;
  double last_ = 0.0;
  double largest_ = 0.0;
  double bound_ = 0.0;
  double time_ = 0.0;
  // Sums over all frames.
  double coarse_ = 0.0;   // |d1|^2
  double fine_ = 0.0;     // |d2|^2
  double product_ = 0.0;  // d1 . d2
};

}  // namespace sheave::measure
