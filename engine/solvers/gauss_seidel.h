#pragma once

#include <memory>
#include <span>

#include "engine/constraint_batch.h"
#include "engine/substep.h"

namespace sheave {

/// Visits all rows of all features in a fixed order, `iterations` times, each re-evaluated at the
/// current positions (the paper's solver; row update in engine/row.h).
void solve_gauss_seidel(Substep& substep,
                        std::span<const std::unique_ptr<ConstraintBatch>> features);

}  // namespace sheave
