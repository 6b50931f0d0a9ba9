#pragma once
// The balances, each on its own.

#include <array>

#include "cable/certificate/evidence.h"
#include "cable/certificate/findings.h"

namespace sheave::certify {

/// Each body's substep again, from its start with the reported forces, against its end:
/// cable/certificate/momentum.cpp. Returns what is off per body as work done on it [J].
std::vector<double> check_momentum(const Evidence& evidence, Findings& findings);
/// Joints, spans, drives and contacts against what they ask for; slack against pull:
/// constraints.cpp, joints.cpp.
void check_spans(const Evidence& evidence, Findings& findings);
void check_joints(const Evidence& evidence, Findings& findings);
void check_body_drives(const Evidence& evidence, Findings& findings);
void check_contacts(const Evidence& evidence, Findings& findings);
/// Bounds and directions of friction: friction.cpp.
void check_friction(const Evidence& evidence, Findings& findings);
/// The tension that a link carries at most on one side while that of the other side is that of
/// `held` [N], each part of it with the angle of its time.
[[nodiscard]] double carried(const PassEvidence& pass, const SpanEvidence& held);
/// What nothing explains; `leaks` as check_momentum() returns them: energy.cpp.
void check_energy(const Evidence& evidence, const std::vector<double>& leaks, Findings& findings);
/// Cable lengths: length.cpp.
void check_lengths(const Evidence& evidence, Findings& findings);

/// How far the rims at the ends of a span have passed them in the substep, by the poses alone [m]:
/// what rolling gives to the span at its first end and its second. `rolled`, as in unrolled(),
/// chooses among whole turns.
[[nodiscard]] std::array<double, 2> rim_travels(const Evidence& evidence,
                                                const CableEvidence& cable,
                                                const SpanEvidence& span, double rolled);

/// By how much the rest length that a span has gained by rolling, `rolled` [m], differs from what
/// its rims have moved.
[[nodiscard]] double unrolled(const Evidence& evidence, const CableEvidence& cable,
                              const SpanEvidence& span, double rolled);

/// Of a material: the length whose strain changes by what stretches the span in the substep [m],
/// its own and half of what has been wound on, A in cable/cable_material.cpp. On outlines what is
/// wound on is no less than what is missing. `rolled` as in unrolled().
[[nodiscard]] double spring_length(const Evidence& evidence, const CableEvidence& cable,
                                   const SpanEvidence& span, double rolled);

}  // namespace sheave::certify
