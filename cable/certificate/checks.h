#pragma once
// The checks of the certificate, one function per balance.

#include <algorithm>
#include <array>

#include "cable/certificate/evidence.h"
#include "cable/certificate/findings.h"

namespace sheave::certify {

/// Repeats each body's substep from its start with the reported forces and compares the result with
/// its end: cable/certificate/momentum.cpp. Returns the residual per body as work done on it [J].
std::vector<double> check_momentum(const Evidence& evidence, Findings& findings);
/// Residuals of joints, spans, drives and contacts, and complementarity of gap and force:
/// spans.cpp, joints.cpp.
void check_spans(const Evidence& evidence, Findings& findings);
void check_joints(const Evidence& evidence, Findings& findings);
void check_body_drives(const Evidence& evidence, Findings& findings);
void check_contacts(const Evidence& evidence, Findings& findings);
/// Bounds and directions of friction: friction.cpp.
void check_friction(const Evidence& evidence, Findings& findings);
/// Largest tension [N] that the link carries on one side while the span `held` has its tension on
/// the other; the first and the second part of the tension with the wrap angle of its time.
[[nodiscard]] double carried(const PassEvidence& pass, const SpanEvidence& held);
/// Energy that no work explains: energy.cpp. `leaks`: the result of check_momentum().
void check_energy(const Evidence& evidence, const std::vector<double>& leaks, Findings& findings);
/// Geodesics of a cable over smooth bodies: surfaces.cpp.
void check_surfaces(const Evidence& evidence, const CableEvidence& cable, Findings& findings);
/// Whether a cable lies along a geodesic on a cone, a torus or an ellipsoid: curved_body.cpp.
[[nodiscard]] bool lies_on_curved_body(const Evidence& evidence, const LinkReport& link);
/// Bounds of the rope in sheaths: sheaths.cpp.
void check_sheaths(const Evidence& evidence, const CableEvidence& cable, Findings& findings);
/// The forces of the inertia of ropes against the change of their motion: rope_motion.cpp.
void check_rope_motion(const Evidence& evidence, Findings& findings);
/// Kinetic energy of ropes with inertia at the end of the substep [J].
[[nodiscard]] double rope_energy(const Evidence& evidence);
/// Invariants of cable lengths: length.cpp.
void check_lengths(const Evidence& evidence, Findings& findings);

/// Length that rolling gives to a span at its first and its second end, as travel of the links'
/// rims past the contacts in the substep, from the poses alone [m]. `rolled`, as in unrolled(),
/// chooses among whole turns.
[[nodiscard]] std::array<double, 2> rim_travels(const Evidence& evidence,
                                                const CableEvidence& cable,
                                                const SpanEvidence& span, double rolled);

/// Completes the evidence of an arc over which cable with a material slides: the length that the
/// surface carries, from the poses alone, and the ends of the spans beside the arc.
void find_carried(const Evidence& evidence, CableEvidence& cable, PassEvidence& pass);

/// Mean strain beside a link in the substep; 0 if the cable has no material.
[[nodiscard]] double mean_strain(const CableEvidence& cable, const PassEvidence& pass);

/// Difference between the rest length that a span has gained by rolling, `rolled` [m], and the
/// travel of its rims [m].
[[nodiscard]] double unrolled(const Evidence& evidence, const CableEvidence& cable,
                              const SpanEvidence& span, double rolled);

/// Cable with a material: the length A whose strain changes when the span is stretched in the
/// substep [m], the span's own length and half of the cable that was wound on
/// (cable/cable_material.cpp). On outlines the wound length counts as at least the missing length.
/// `rolled` as in unrolled().
[[nodiscard]] double spring_length(const Evidence& evidence, const CableEvidence& cable,
                                   const SpanEvidence& span, double rolled);

/// Mean stretch over a substep of `rattle` of a spring that acts above 0 only. Times the way, it is
/// half the difference of the squares above 0: the spring stores the work that it takes.
[[nodiscard]] inline double acting_mean(double first, double last) {
  const double before = std::max(first, 0.0);
  const double now = std::max(last, 0.0);
  if ((before > 0.0) == (now > 0.0)) return 0.5 * (before + now);
  return 0.5 * (now * now - before * before) / (last - first);
}

}  // namespace sheave::certify
