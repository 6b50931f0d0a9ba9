#pragma once

#include "engine/joints/anchor.h"

namespace sheave {

/// Row `index` (0, 1, 2) of the constraint that two anchors coincide: C = e . (p_a - p_b) with the
/// world axis e of that index.
inline void evaluate_point_row(const Substep& substep, const Anchor& a, const Anchor& b, int index,
                               Row& row) {
  const Vector3 at_a = a.position(substep);
  const Vector3 at_b = b.position(substep);
  row.value = at_a[index] - at_b[index];
  add_relative_translation(substep, row, a.body, b.body, at_a, at_b, Vector3::Unit(index));
}

}  // namespace sheave
