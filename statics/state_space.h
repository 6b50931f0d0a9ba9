#pragma once
// x' = A x + B u of a linearised machine; internal to statics.

#include <vector>

#include "statics/acting.h"
#include "statics/modes.h"
#include "statics/relaxation.h"
#include "statics/tangent.h"

namespace sheave {

/// Fills Modes::state_matrix and the members that depend on it. Motions, damping and stiffness must
/// be filled already.
void fill_state_space(Configuration& configuration, const World& world, const Tangent& tangent,
                      const Acting& acting, const std::vector<Relaxation>& relaxations,
                      const std::vector<ModeInput>& inputs, Modes& modes);

}  // namespace sheave
