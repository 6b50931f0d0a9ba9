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
// below the first order, for there the next term of the series still counts. Above 4.5 d2 is next
// to nothing beside d1, which no law of the step makes.
//
// Without an order the error is that of q(h/4) more than d1 + d2, and of a method of first order at
// least that is no more than |d2|, nor than half of |d1|. So it is told as
//   |d1 + d2| + max(|d2|, |d1| / 2),
// which is the error itself for p = 1 and 1.3 times that for p = 2. What happens at a moment t (a
// rope goes taut, a cable is cut) each run finds at the end of the substep in which t lies, so late
// by u, u + h/4, u + h/2 or u + 3h/4 for h, with u < h/4 for h/4. Where a delay makes an error in
// proportion, in these four cases d1 = 0, 0, h/2, h/2 and d2 = 0, h/4, 0, h/4 times that, and what
// is told is 0, h/2, 3h/4 or h times that: no less than the error, but for the first of them. All
// runs then do the same, and nothing that compares them can see it (`unseen`).

#include <cstddef>
#include <optional>

#include "engine/vector.h"

namespace sheave::measure {

/// Relative differences below this are rounding, or what the solver leaves: its tolerance is 1e-10
/// of the size.
inline constexpr double negligible_difference = 1e-9;

/// The larger one of d1 and d2, where that is largest, and what follows of the error.
struct StepDifference {
  double largest = 0.0;  ///< of all frames [unit of the quantity], >= 0
  double time = 0.0;     ///< of that frame [s]
  double at_end = 0.0;   ///< in the last frame, >= 0
  double scale = 1.0;    ///< what it is compared with, >= 0, same unit
  /// Of the error in the substep; nothing if the two differences do not obey one law, or are
  /// negligible.
  std::optional<double> order{};
  double bound = 0.0;  ///< the error without an order, as above, largest of all frames, >= 0
  /// What sudden events may have moved it by that all three runs found at the same moment: set by
  /// those who know of events, >= 0.
  double unseen = 0.0;

  /// largest / scale; 0 if there is no difference, even without a scale.
  [[nodiscard]] double relative() const;
  /// Whether no more than rounding is left of all differences.
  [[nodiscard]] bool negligible() const;
  /// What the error of the run with h comes to where the difference is largest, by the order;
  /// without one the larger of `bound` and `unseen`.
  [[nodiscard]] double error() const;
};

/// Adds up the frames of a run.
class StepDifferenceSum {
 public:
  /// A part of this frame's differences d1 and d2: of one body, of one tension (y = z = 0).
  void add(const Vector3& coarse, const Vector3& fine);
  /// The frame at this time [s] has all its parts.
  void end_frame(double time);
  /// Norm of the last frame's d1 or d2, whichever is larger.
  [[nodiscard]] double last() const { return last_; }
  /// Norms are divided by the root of `parts`, the number that a frame has, if they are to be means
  /// over these.
  [[nodiscard]] StepDifference result(double scale, std::size_t parts = 1) const;

 private:
  // |d1|^2, |d2|^2 and |d1 + d2|^2 of the frame that is being added.
  double frame_coarse_ = 0.0;
  double frame_fine_ = 0.0;
  double frame_sum_ = 0.0;
  double last_ = 0.0;
  double largest_ = 0.0;
  double bound_ = 0.0;
  double time_ = 0.0;
  // Over all frames:
  double coarse_ = 0.0;   // |d1|^2
  double fine_ = 0.0;     // |d2|^2
  double product_ = 0.0;  // d1 . d2
};

}  // namespace sheave::measure
