// Dampers of spans that share a tension.
//
// A span is a spring and a damper in parallel: with the stretch x = l - L, the compliance a and the
// damping b its tension is T = x / a + b x'. Cable that passes over a link changes x, too, and the
// damper resists this change like any other, because it stretches the same material. In a run with
// the tensions T_i = k_i T each span therefore has its own law. By implicit Euler, with the stretch
// x0_i at the start and g_i = a_i b / h, it is
//
//   a_i k_i T = x_i + g_i (x_i - x0_i)     =>     x_i = (a_i k_i T + g_i x0_i) / (1 + g_i).
//
// Before T is known, only the sum X of the x_i is known, because passing cable does not change it.
// The sum determines T:
//
//   sum of x_i = X     =>     T sum of a_i k_i / (1 + g_i) = X - sum of g_i x0_i / (1 + g_i),
//
// which engine/solvers/row_system.h solves (Row::past). T then determines each x_i and the cable
// that passes. The sum behaves like one damped spring only if all g_i are equal; with a material,
// g_i = L_i b / (EA h) is proportional to the length. If a run used the g of the sum but strains in
// the ratio of the tensions, spans that slide would get another force than the same spans with the
// link held, and there would be states in which a link can neither hold nor slide.
//
// With a material the same holds for strains, with e for x, 1 / EA for a, and g_i of the length
// that the span has before cable passes: k_i T / EA = e_i + g_i (e_i - e0_i). Passing cable comes
// in with the strain of the span, as in cable/cable_material.cpp. A span that shares no tension has
// the same law: its damper sees A (e - e0), not the motion of its ends, because cable that comes off
// a link brings the strain with which it lay there.
//
// `rattle` uses the force F at the middle of the substep, F = T there:
//
//   2 a_i k_i F = x_i + x0_i + 2 g_i (x_i - x0_i)
//     =>     x_i = (a_i k_i F + (g_i - 1/2) x0_i) / (1 + (g_i - 1/2)).
//
// The form is the law above with g_i - 1/2 for g_i. For g_i < 1/2 the span's time constant a_i b is
// shorter than half a substep, and x_i would oscillate about the ratio of the tensions from one
// substep to the next. The share is then 0, and the strain has that ratio at once, as without
// dampers. The sum, and with it the force, obeys the law with g_i in any case. The x_i found with
// that F do not add up to X then; the code uses those of the F for which they do.
//
// Whether a link with friction holds depends on the mean tensions of both ends, however. If a span
// began with another strain, because the link held, the ratio at the end may be reachable only by
// sliding back while the mean requires sliding on. The run then slides by the law itself, with g_i
// - 1/2 < 0: the passing cable brings the mean to the link's bound. The strain at the end exceeds
// the ratio, so the link holds in the next substep.
//
// The damper of a span that is slack at the start, x0 < 0, begins where the span becomes taut: x0 =
// 0. If no span of a run has a tension, each loses its stretch at the speed that its damper allows,
// x_i = x0_i g_i / (1 + g_i), and takes the cable for that from slack spans.

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Length that a span gains at its first link from the rim of a massless wheel that keeps turning
/// [m], and loses at its second, if the span's row does not contain it.
double spun_off(const Substep& substep, const LinkGeometry& link, const Row& row) {
  if (!link.massless || link.wheel >= 0) return 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (term.body == link.body) return 0.0;
  }
  const Vector3 normal = rotated(substep.orientation(link.carrier), link.normal);
  return link.signed_radius * dot(normal, substep.moving[at(link.body)].turn);
}

}  // namespace

bool CableSystem::by_means(Run run) const {
  if (!knows_start_) return false;
  const CompiledCable& cable = cables_[at(spans_[at(run.first)].cable)];
  for (int i = 1, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    if (run_work_.means[at(spans_[at(k)].second)] != 0) return true;
  }
  return false;
}

CableSystem::SpanDamping CableSystem::damping_of(const Substep& substep, const CompiledCable& cable,
                                                 bool means, int span, const Row& row) const {
  SpanDamping damping;
  if (!cable.is_damped() && !means) return damping;
  if (substep.at_rest || !(row.compliance > 0.0)) return damping;
  damping.share = row.compliance * row.damping / substep.h;
  double start = row.value;
  if (knows_start_) {
    damping.share -= 0.5;
    if (!means) damping.share = std::max(damping.share, 0.0);
    const auto [value, compliance] = start_values_[at(span)];
    // The strain of a material does not depend on the length at either end.
    start = compliance > 0.0 ? value * (row.compliance / compliance) : value;
  } else if (cable.inverse_stiffness > 0.0) {
    damping.start = strains_[at(span)];
    return damping;
  } else {
    const SpanSetup& setup = spans_[at(span)];
    start -= substep_change(row, substep.moving);
    start -= spun_off(substep, links_[at(setup.first)], row);
    start += spun_off(substep, links_[at(setup.second)], row);
  }
  damping.start = std::max(-start, 0.0);
  if (cable.inverse_stiffness > 0.0) damping.start *= cable.inverse_stiffness / row.compliance;
  return damping;
}

void CableSystem::damp_row(const CompiledCable& cable, const StretchedSpan* material,
                           const SpanDamping& damping, Row& row) {
  if (!(row.damping > 0.0)) return;
  const double spring_length =
      cable.inverse_stiffness > 0.0 ? row.compliance / cable.inverse_stiffness : 1.0;
  row.past = -damping.start * spring_length;
  // The same g, for the length before cable passes.
  if (material != nullptr && spring_length > 0.0) {
    row.damping = cable.damper(material->spring_length) * (material->spring_length / spring_length);
  }
}

}  // namespace sheave
