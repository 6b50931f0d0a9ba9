// Dampers of spans that share a tension.
//
// A span is a spring and a damper side by side: with the stretch x = l - L, the compliance a and
// the damping b its tension is T = x / a + b x'. Where cable passes over a link, x changes by what
// passes, too, and the damper resists that as it does any other change: it is the same material
// that is stretched. So in a run with the tensions T_i = k_i T each span has its own law, by
// implicit Euler with the stretch x0_i at the start and g_i = a_i b / h
//
//   a_i k_i T = x_i + g_i (x_i - x0_i)     =>     x_i = (a_i k_i T + g_i x0_i) / (1 + g_i).
//
// Of the x_i only the sum is known before T is, since what passes leaves that as it is. It gives T:
//
//   sum of x_i = X     =>     T sum of a_i k_i / (1 + g_i) = X - sum of g_i x0_i / (1 + g_i),
//
// which engine/solvers/row_system.h solves (Row::past), and then each x_i, so what passes. Only if
// all g_i are equal does the sum behave like one damped spring; a material's g_i = L_i b / (EA h)
// go with the lengths. With the g of a sum but strains in the ratio of the tensions, spans that
// slide get another force than the same spans would have with the link held, and there are states
// in which a link can neither hold nor slide.
//
// Of a material the same holds for strains, with e for x, 1 / EA for a, and g_i of the length that
// the span has before anything passes: k_i T / EA = e_i + g_i (e_i - e0_i). What passes comes in
// with the strain that is there, as cable/cable_material.cpp has it.
//
// `rattle` has the force of the middle of the substep, F = T there:
//
//   2 a_i k_i F = x_i + x0_i + 2 g_i (x_i - x0_i)
//     =>     x_i = (a_i k_i F + (g_i - 1/2) x0_i) / (1 + (g_i - 1/2)).
//
// That is the law above with g_i - 1/2 for g_i. Where g_i < 1/2, because the span's time constant
// a_i b is shorter than half a substep, it would swing about the ratio of the tensions from one
// substep to the next; there the share is 0, and the strain is in that ratio at once, as without
// dampers. The sum, and with it the force, has the law with g_i in any case. Then the x_i so found
// do not add up to X with that F; so they are those of the F for which they do.
//
// Whether a link with friction holds is asked of the means of both ends, though, and where a span
// began with another strain, because the link held, the ratio at the end can come about by sliding
// back alone while the mean asks for sliding on. Then the run slides by the law itself, with
// g_i - 1/2 < 0: what passes makes the mean what the link carries. It goes beyond the ratio, so that
// the link holds in the next substep.
//
// A span that is slack at the start, x0 < 0, has a damper that begins where it is taut: x0 = 0.
// Where no span of a run has a tension each comes out of its stretch at the speed that its damper
// allows, x_i = x0_i g_i / (1 + g_i), and takes what it needs for that from slack ones.

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// What a span that begins at the link gains from the rim of a massless wheel that goes on turning
/// [m], and one that ends there loses, where its row does not have it.
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
  if (!(cable.damping > 0.0) && !means) return damping;
  if (substep.at_rest || !(row.compliance > 0.0)) return damping;
  damping.share = row.compliance * cable.damping / substep.h;
  double start = row.value;
  if (knows_start_) {
    damping.share -= 0.5;
    if (!means) damping.share = std::max(damping.share, 0.0);
    const auto [value, compliance] = start_values_[at(span)];
    // A material's strain is the same, whatever the length is at either end.
    start = compliance > 0.0 ? value * (row.compliance / compliance) : value;
  } else if (const SpanSetup& setup = spans_[at(span)];
             slides_on(setup.first) || slides_on(setup.second)) {
    // What a tangent point moves along an arc is not in the value.
    damping.start = strains_[at(span)];
    return damping;
  } else {
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
  // The same g, of the length before anything passes.
  if (material != nullptr && spring_length > 0.0) {
    row.damping = cable.damping * (material->spring_length / spring_length);
  }
}

}  // namespace sheave
