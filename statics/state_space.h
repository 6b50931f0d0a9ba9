#pragma once
// x' = A x + B u of a linearised machine; internal to statics.

#include <vector>

#include "statics/acting.h"
#include "statics/modes.h"
#include "statics/tangent.h"

namespace sheave {

/// Fills Modes::state_matrix and what comes with it; motions, damping and stiffness must be there.
void fill_state_space(Configuration& configuration, const World& world, const Tangent& tangent,
                      const Acting& acting, const std::vector<ModeInput>& inputs, Modes& modes);

}  // namespace sheave
