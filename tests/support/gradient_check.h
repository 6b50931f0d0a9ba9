#pragma once
// Row gradients against finite differences of Row::value.

#include <string>

#include "engine/constraint_batch.h"
#include "engine/substep.h"

namespace sheave::test {

/// What comparing all rows of a batch found.
struct GradientCheck {
  double error = 0.0;    ///< largest |term - difference| / largest gradient component of the row
  int compared = 0;      ///< derivatives compared
  double largest = 0.0;  ///< largest derivative seen; 0 would mean that nothing was tested
  std::string worst;     ///< row, body and kind of motion of the largest error
};

/// Compares every row of `batch` with five-point differences of its value under the translations
/// and rotations that the mobilities allow. begin() has been called; bodies are anywhere.
///
/// Motions follow the conventions of engine/row.h: a rotation d turns `orientation` by d and adds d
/// to `turn`. A rotor has its `turn` only; a mounted one's is its absolute spin about its carrier's
/// axle, so it changes along that axle and stays when the carrier is rotated.
///
/// A cable that goes over to another corner of an outline has a kink in its gradient. With `kinks`
/// a derivative counts as right if the differences to one side of the place alone say so.
[[nodiscard]] GradientCheck check_gradients(Substep& substep, ConstraintBatch& batch,
                                            bool kinks = false);

/// Moves every moving body by a fixed pseudo-random amount: translations up to `distance` [m],
/// rotations up to `angle` [rad] per axis.
void displace(Substep& substep, double distance, double angle, unsigned seed = 1);

}  // namespace sheave::test
