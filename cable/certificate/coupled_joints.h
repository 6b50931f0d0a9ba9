#pragma once
// Couplings of joints, from their definition and the reports of the joints alone.

#include "cable/certificate/pushes.h"

namespace sheave::certify {

/// The force [N] of a coupling of joints along its length, from the reported wrench on its body_b.
[[nodiscard]] double coupling_force(const Evidence& evidence, const JointEvidence& joint, End when);
/// The length of a coupling of joints [m] for the reported coordinates of the joints, at the start
/// or the end of the substep.
[[nodiscard]] double coupling_length(const Evidence& evidence, const JointEvidence& joint,
                                     End when);
/// The wrenches of a coupling of joints on all bodies of the joints.
[[nodiscard]] JointPushes coupled_pushes(const Evidence& evidence, const JointEvidence& joint,
                                         End when);

}  // namespace sheave::certify
