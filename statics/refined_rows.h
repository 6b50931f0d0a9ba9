#pragma once
// Exact derivatives of rows that have approximate ones (Row::approximate); internal to statics.
//
// A span of a rope with weight, for example, has its chord tension T as unknown. Newton's method
// converges with the gradient of the chord alone, but the sag changes with the pose and with T, and so
// does the share of the weight at each end. With the residual R(q, T) and the forces F(q, T)
//
//   K = -dF/dq + dF/dT (dR/dT)^-1 dR/dq.
//
// Central differences (statics/difference.h) give the last three.

#include "statics/configuration.h"

namespace sheave {

/// Replaces gradients, actions and compliances of approximate rows of rows() at these unknowns, and
/// writes `refined_stiffness`, `refined_error` and `refined_rounding`. The
/// configuration must assume the forces of these unknowns, and is in its pose; `size`: of the scene
/// [m].
void refine_rows(Configuration& configuration, const VectorX& unknowns, double size,
                 ConfigurationRows& rows);

}  // namespace sheave
