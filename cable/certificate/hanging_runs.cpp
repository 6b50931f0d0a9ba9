// Ropes with weight that pass pinholes and massless wheels, computed independently of the solvers: the
// tension of the first span of a run and the poses give the tensions of all others. With `rattle` they
// differ between both ends of the substep, and the reported tension is their mean.

#include <cmath>

#include "cable/certificate/hanging.h"
#include "cable/links/pinhole.h"

namespace sheave::certify {
namespace {

using Ends = std::array<double, 2>;

/// Whether rope passes freely from span to span over the first link of a span.
bool passes_into(const Evidence& evidence, const CableEvidence& cable, const SpanEvidence& span) {
  const int place = span.from.place;
  const auto last = static_cast<int>(cable.definition->links.size()) - 1;
  if (place < 0 || (!cable.start.closed && (place == 0 || place == last))) return false;
  if (cable.definition->links[at(place)]->type() == PinholeLink::type_name) return true;
  return span.from.body < evidence.bodies.count() && evidence.bodies[span.from.body].massless();
}

SpanEvidence* span_behind(CableEvidence& cable, const SpanEvidence& span) {
  for (SpanEvidence& other : cable.spans) {
    if (other.from.link == span.to.link) return &other;
  }
  return nullptr;
}

/// Tensions at both points of the straight tangent.
Ends ends_of(const Evidence& evidence, const CableEvidence& cable, const SpanEvidence& span,
             End when, double tension) {
  const HungRope rope = rope_of(evidence, *cable.definition, span, when);
  const double length = span.rest_length[at(when)];
  if (ends_on_wheels(span)) return hung_on_wheels(rope, span, when, tension, length).tensions;
  const HangingForces forces = hanging_forces(rope, tension, length);
  return {forces.at_start.norm(), forces.at_end.norm()};
}

/// Rise of the tension over a massless wheel by the weight of the rope that lies on it [N].
double lift_over(const Evidence& evidence, const CableEvidence& cable, const SpanSide& in,
                 const SpanSide& out, End when) {
  if (!(in.radius[at(when)] > 0.0) || !(in.lies[at(when)] > 0.0)) return 0.0;
  const double density = cable.definition->linear_density * in.stored[at(when)] / in.lies[at(when)];
  return -density * evidence.gravity.dot(out.point[at(when)] - in.point[at(when)]);
}

/// The chord tension of a span with this tension at its first point, by the secant method.
double chord_tension(const Evidence& evidence, const CableEvidence& cable, const SpanEvidence& span,
                     End when, double wanted) {
  constexpr int most_rounds = 20;
  constexpr double rounding = 1e-14;
  double before = span.told;
  double off_before = ends_of(evidence, cable, span, when, before)[0] - wanted;
  double now = before - off_before;
  for (int round = 0; round < most_rounds && now > 0.0; ++round) {
    const double off = ends_of(evidence, cable, span, when, now)[0] - wanted;
    if (std::abs(off) <= rounding * wanted || off == off_before) break;
    const double next = now - off * (now - before) / (off - off_before);
    before = now;
    off_before = off;
    now = next;
  }
  return now;
}

}  // namespace

double share_of(const Evidence& evidence, End when) {
  if (evidence.rattle) return 0.5;
  return when == last_end ? 1.0 : 0.0;
}

void share_tensions(const Evidence& evidence, CableEvidence& cable) {
  for (SpanEvidence& first : cable.spans) {
    if (passes_into(evidence, cable, first)) continue;
    SpanEvidence* span = &first;
    std::array<double, 2> tensions{first.told, first.told};
    for (;;) {
      SpanEvidence* next = span_behind(cable, *span);
      if (next == nullptr || !passes_into(evidence, cable, *next) || !(span->told > 0.0)) break;
      for (const End when : {first_end, last_end}) {
        span->shares = next->shares = true;
        span->force[at(when)] = share_of(evidence, when) * tensions[at(when)];
        const double arrives = ends_of(evidence, cable, *span, when, tensions[at(when)])[1];
        const double wanted = arrives + lift_over(evidence, cable, span->to, next->from, when);
        tensions[at(when)] = chord_tension(evidence, cable, *next, when, wanted);
        next->force[at(when)] = share_of(evidence, when) * tensions[at(when)];
      }
      span = next;
    }
  }
}

double tension_at(const Evidence& evidence, const CableDef& cable, const SpanEvidence& span,
                  End when) {
  if (!span.shares) return spring_tension(evidence, cable, span);
  if (!evidence.rattle) return span.force[last_end];
  return 2.0 * span.force[at(when)];
}

}  // namespace sheave::certify
