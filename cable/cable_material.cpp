// Cable with a material (`axial_stiffness` EA) that comes onto wheels and off them with its strain.
//
// Lengths in the state are unstretched: L of a span, s of a link. A rim that turns by an arc moves
// the unstretched length arc / (1 + strain). For cable that comes onto the link, the strain is that
// of the span, e = l / L - 1; for cable that comes off, it is the strain w with which the cable
// lies there (cable/stored_strain.h). With the arcs `on`, and G = the unstretched length of the
// arcs `off` (for cable that slides over the rim see cable/strained_arcs.cpp),
//   dL = dG - d(on) / (1 + e)     =>     L de = dl + d(on) - (1 + e) dG.
// Energy: EA e^2 L / 2 of the span, and EA / 2 times the integral of w^2 over the unstretched
// length of the stored cable. With the tension T = EA e and d(off) = (1 + w) dG,
//   d(energy) = T (dl + d(on) - d(off)) - EA (e - w)^2 / 2 dG.
// The force is therefore T along the span's direction and T R on the rims, as for a rigid cable:
// the row's gradient is the same. Cable that comes off with another strain than that of the span
// loses EA (e - w)^2 / 2 per unstretched length: the creep of belts (Grashof). The rim of a driving
// wheel runs with the tight side, that of a driven wheel with the slack side, so the rims' speeds
// have the ratio (1 + e_slack) / (1 + e_tight), 1 - (T1 - T2) / EA to first order. `creep_loss` is
// the sum of these losses.
//
// Over a substep, with e0 and L0 at its start and both `on` and G linear in between (trapezoidal
// rule, second order),
//   A (e1 - e0) = l1 - l0 + on - (1 + e0) G,   A = L0 + G - on / (2 (1 + e0)).
// The law is a spring of length A: the row's value is -A e1 and its compliance A / EA. L1 = l1 /
// (1 + e1) then makes the force law and the geometry agree exactly. With y = on / (2 (1 + e0)) and
// B = L0 + G, A is written as B^2 / (B + y), which is the same to second order and positive however
// much is wound on. For on = 0 this is A = L0 + G and the value is L0 + G - l1. A slack span has e
// = 0; its value is L0 + G - on - l1, as for a rigid cable.
//
// Spans of a run share one strain e, times the weights k_i that friction gives their tensions. All
// share one equation, too: the length of the run after it has run on and off its links equals the
// sum of its spans' lengths at the end,
//   F(e) = sum (L0_i + G_i - on_i / (1 + (e0_i + k_i e) / 2) - l_i / (1 + k_i e)) = 0.
// Their rows have the lengths at the end, A_i = L1_i = l_i / (1 + k_i e), and the values -A_i k_i
// e, and finish() gives the spans exactly these. (With the A of each span by itself, and cable
// passed on afterwards, the sum of A_i e_i would differ from that of L1_i e_i: the passed cable
// makes a difference of strain times slip, which is 1 % of a small stretch or more.) If F(0) > 0
// the run is slack. If spans are damped, k_i e is the strain that springs alone would have;
// cable/cable_damping.cpp gives the strain that replaces it.
//
// With a law T(e) instead of EA (cable/tension_law.h) nothing of this changes but the energies, U(e)
// per unstretched length for EA e^2 / 2, the loss by creep, U(w) - U(e) - T(e) (w - e) >= 0, and the
// numbers of the row (cable/span_law.h). The weights k_i are 1, because friction is left out.
//
// If attachments keep their places for the substep, the rolled cable still lies between them. The
// length that a span gets afterwards is then not the one on which the tension acted, and the strain
// of the wound cable follows from the law that has acted.
//
// The residual value + compliance T, whose zero the solvers seek, changes by -(dl + d(on) - d(off))
// for T = EA e0 and w = e0, and otherwise by an additional fraction e1 - e0 or w - e0 of the arcs.
// Newton's method with the row's gradient is therefore exact except for changes of strain, which
// vanish for stiff cables.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/massless_wheels.h"
#include "cable/sheaths.h"
#include "cable/span_law.h"
#include "engine/index.h"

namespace sheave {
namespace {

using End = StoredStrain::End;

}  // namespace

double creep_loss(const CompiledCable& cable, const StoredStrain::Piece& off, double strain) {
  const double scale = 0.5 / cable.inverse_stiffness;
  if (!cable.law) {
    return scale * (off.square - 2.0 * strain * off.stretch + strain * strain * off.length);
  }
  return scale * off.square - cable.law->energy(strain) * off.length -
         cable.law->tension(strain) * (off.stretch - strain * off.length);
}

double CableSystem::strain_of(const CompiledCable& cable, double length, double rest_length) {
  if (cable.inverse_stiffness == 0.0 || !(rest_length > 0.0)) return 0.0;
  return std::max(length / rest_length - 1.0, 0.0);
}

StoredStrain CableSystem::stored_strain(const FeatureState& own, int link) const {
  const int place = strain_places_[at(link)];
  if (place < 0) return {};
  return StoredStrain(std::span(own.reals).subspan(strain_index(place), StoredStrain::real_count));
}

void CableSystem::save_strain(const StoredStrain& stored, int link, FeatureState& own) const {
  const int place = strain_places_[at(link)];
  if (place < 0) return;
  stored.save(std::span(own.reals).subspan(strain_index(place), StoredStrain::real_count));
}

double CableSystem::stored_arc(const FeatureState& own, int link) const {
  const double length = own.reals[stored_length_index(link)];
  return strain_places_[at(link)] < 0 ? length : length + stored_strain(own, link).total().stretch;
}

void CableSystem::fit_strain(int link, End end, double strain, FeatureState& own) const {
  if (strain_places_[at(link)] < 0) return;
  StoredStrain stored = stored_strain(own, link);
  stored.fit(end, own.reals[stored_length_index(link)], strain,
             cable_of(cables_, link).strain_energy());
  save_strain(stored, link, own);
}

CableSystem::StretchedSpan CableSystem::stretched(int span, const SpanTransport& arcs,
                                                  double length) const {
  const SpanSetup& setup = spans_[at(span)];
  const SpanReference& reference = references_[at(span)];
  const double strain = strains_[at(span)];
  StretchedSpan result;
  result.arcs = {arcs.from_first, arcs.from_second};
  const auto gain = [&](double arc, int link, End end) {
    if (slides_on(link)) return 0.0;  // cable/strained_arcs.cpp
    if (!(arc > 0.0)) {
      result.on -= arc;
      return 0.0;
    }
    const int place = strain_places_[at(link)];
    return place < 0 ? arc : stored_[at(place)].rest_of(end, arc, strain);
  };
  result.gained[0] = gain(arcs.from_first, setup.first, End::outgoing);
  result.gained[1] = gain(arcs.from_second, setup.second, End::incoming);
  const double before = reference.rest_length + result.gained[0] + result.gained[1];
  result.before = before;
  result.start_strain = strain;
  if (!memories_.empty()) result.memory = memories_[at(span)][0];
  result.length = length;
  const double half = 0.5 * result.on / (1.0 + strain);
  result.spring_length = before > 0.0 && half > 0.0 ? before * (before / (before + half)) : before;
  result.value = before + strain * (before - result.spring_length) - result.on - length;
  return result;
}

std::optional<double> CableSystem::run_strain(std::span<const StretchedSpan> spans,
                                              std::span<const double> weights) const {
  // F is concave and rises, so Newton's method approaches its zero from below.
  constexpr double rounding = 1e-15;
  constexpr int most_rounds = 50;
  double strain = 0.0;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    double missing = 0.0;
    double slope = 0.0;
    double whole = 0.0;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      const StretchedSpan& span = spans[i];
      const double own = span.damping.end(weights[i] * strain);
      const double rest_length = span.length / (1.0 + own);
      const double onto = span.on / (1.0 + 0.5 * (span.start_strain + own));
      missing += rest_length - (span.before - onto);
      whole += rest_length;
      slope += weights[i] / (1.0 + span.damping.share) *
               (rest_length / (1.0 + own) + 0.5 * onto / (1.0 + 0.5 * (span.start_strain + own)));
    }
    for (const SlidingArc& arc : run_work_.arcs) {
      if (arc.link < 0) continue;
      const cable_parts::ArcSum sum = arc_with(arc, strain);
      missing += sum.unstretched - arc.before.length;
      whole += sum.unstretched;
      slope += sum.slope;
    }
    if (run_work_.has_wheels) {
      const MasslessWheels::Kept kept = MasslessWheels::kept(*this, weights, strain);
      missing += kept.length;
      slope += kept.slope;
    }
    const bool above = run_work_.has_wheels && strain > 0.0 && missing < -rounding * whole;
    if (!(missing > rounding * whole) && !above) return strain;
    if (!(slope > 0.0)) return std::nullopt;
    const double change = missing / slope;
    // Cable on wheels may be strained in pieces, so that F has corners. The last digits are those of
    // the rounding of F.
    constexpr double nearly = 1e-12;
    const double size = std::abs(change);
    if (run_work_.has_wheels && size >= 0.5 * last && size <= nearly * whole / slope) return strain;
    last = size;
    strain = std::max(strain + change, 0.0);
    if (!std::isfinite(strain)) return std::nullopt;
  }
  return std::nullopt;
}

void CableSystem::strain_rows(const Substep& substep, const CompiledCable& cable, Run run,
                              std::span<const double> weights, std::span<Row> rows) {
  const std::span<const StretchedSpan> spans = run_work_.stretched;
  find_arcs(substep, cable, run, weights);
  const std::optional<double> strain = run_strain(spans, weights);
  if (!strain) return;
  double slack = 0.0;  // of the run at the start of a substep of `rattle`, as a strain
  if (cable.law && knows_start_) {
    double whole = 0.0;
    for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
      slack += start_values_[at(k)][0];
      whole += spans[at(i)].length;
    }
    slack = whole > 0.0 ? std::max(slack, 0.0) * (1.0 + *strain) / whole : 0.0;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double own = spans[i].damping.end(weights[i] * *strain);
    const double spring_length = spans[i].length / (1.0 + own);
    rows[i].value = -own * spring_length;
    if (!(*strain > 0.0)) {
      const double longer = 1.0 + slack_strain(cable, {0.0, 0.0, spans[i].memory});
      rows[i].value += longer * (spans[i].rest_length_at(own) - spring_length);
    }
    if (cable.law) {
      follow_law(cable, law_step(substep, knows_start_),
                 {spans[i].start_strain, slack, spans[i].memory}, own, spring_length, rows[i]);
      continue;
    }
    rows[i].compliance = compliance_of(cable, spring_length);
    damp_row(cable, &spans[i], spans[i].damping, rows[i]);
  }
  add_arcs(substep, cable, weights, *strain, rows);
}

std::optional<double> CableSystem::end_strain(const Substep& substep, const CompiledCable& cable,
                                              Run run) {
  run_work_.stretched.resize(at(run.count));
  run_work_.weights.resize(std::max(run_work_.weights.size(), at(run.count)));
  double heaviest = 0.0;
  Row row;
  const bool means = by_means(run);
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    row.clear();
    StretchedSpan& span = run_work_.stretched[at(i)];
    evaluate(substep, k, row, &span);
    span.damping = damping_of(substep, cable, means, k, row);
    run_work_.weights[at(i)] = multipliers_[at(k)];
    heaviest = std::max(heaviest, multipliers_[at(k)]);
  }
  const std::span weights = std::span(run_work_.weights).first(at(run.count));
  for (double& weight : weights) weight = heaviest > 0.0 ? weight / heaviest : 1.0;
  find_arcs(substep, cable, run, weights);
  std::optional<double> strain = run_strain(run_work_.stretched, weights);
  // A run that would be stretched without a tension keeps the strains of its spans.
  if (!(heaviest > 0.0) && strain != 0.0) strain.reset();
  settle_arcs(strain);
  run_work_.strain = strain;
  return strain;
}

void CableSystem::keep_end_strains(const Substep& substep) {
  for (const CompiledCable& cable : cables_) {
    if (cable.inverse_stiffness > 0.0 && cable.frozen) {
      for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
        const double rest_length = std::max(references_[at(k)].rest_length, 0.0);
        double share = (cable.damping * rest_length + cable.axial_damping) *
                       cable.inverse_stiffness / substep.h;
        if (knows_start_) share -= 0.5;  // see cable/cable_damping.cpp
        const double pull = multipliers_[at(k)] * cable.inverse_stiffness / (substep.h * substep.h);
        end_strains_[at(k)] = std::max(SpanDamping{strains_[at(k)], share}.end(pull), 0.0);
      }
      continue;
    }
    if (cable.has_sheaths) Sheaths(*this).keep_end_strains(substep, cable);
    if (!cable.shares || !strains_runs(cable) || weighs_now(substep, cable)) continue;
    std::fill_n(end_strains_.begin() + cable.first_span, cable.span_count, -1.0);
    for_each_run(cable, [&](Run run) {
      if (run.count == 1) return;
      const std::optional<double> strain = end_strain(substep, cable, run);
      if (!strain) return;
      for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
        end_strains_[at(k)] =
            run_work_.stretched[at(i)].damping.end(run_work_.weights[at(i)] * *strain);
      }
    });
  }
}

double CableSystem::rest_length_of(const CompiledCable& cable, const Row& row, double length) {
  if (cable.inverse_stiffness == 0.0 || row.value >= 0.0) return row.value + length;
  return rest_length_under(row.value, row.compliance / cable.inverse_stiffness, length);
}

double CableSystem::rest_length_under(double value, double spring_length, double length) {
  // l1 / (1 + e1) with e1 = -value / A; the rest length of a slack span is value + length.
  if (value >= 0.0) return value + length;
  return spring_length > 0.0 ? length * (spring_length / (spring_length - value)) : 0.0;
}

SpanTransport CableSystem::material_transport(const CompiledCable& cable, int span,
                                              const SpanTransport& arcs, double length,
                                              FeatureState& next) {
  const SpanSetup& setup = spans_[at(span)];
  const StretchedSpan result = stretched(span, arcs, length);
  const double shared = end_strains_[at(span)];
  SpanTransport moved{result.gained[0], result.gained[1]};
  double onto = 0.0;  // unstretched length of `on`
  if (result.on > 0.0) {
    onto = result.before - (shared < 0.0
                                ? rest_length_under(result.value, result.spring_length, length)
                                : result.rest_length_at(shared));
    const auto share = [&](double arc, int link) {
      return arc < 0.0 && !slides_on(link) ? onto * (arc / result.on) : 0.0;
    };
    if (arcs.from_first < 0.0) moved.from_first = share(arcs.from_first, setup.first);
    if (arcs.from_second < 0.0) moved.from_second = share(arcs.from_second, setup.second);
  }
  double end_strain =
      result.spring_length > 0.0 ? std::max(-result.value, 0.0) / result.spring_length : 0.0;
  if (shared >= 0.0) end_strain = shared;
  const double mean = 0.5 * (strains_[at(span)] + end_strain);
  const double on_strain = onto > 0.0 ? std::max(result.on / onto - 1.0, 0.0) : 0.0;
  const auto wind = [&](int link, End end, double gained) {
    const int place = strain_places_[at(link)];
    if (place < 0 || gained == 0.0) return;
    StoredStrain& stored = stored_end_[at(place)];
    if (gained < 0.0) {
      stored.put(end, -gained, on_strain, cable.strain_energy());
      return;
    }
    next.reals[creep_index(place)] +=
        creep_loss(cable, stored.take(end, gained, cable.strain_energy()), mean);
  };
  wind(setup.first, End::outgoing, moved.from_first);
  wind(setup.second, End::incoming, moved.from_second);
  return moved;
}

void CableSystem::keep_strains(FeatureState& next) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const int place = strain_places_[i];
    if (place < 0) continue;
    const auto link = static_cast<int>(i);
    // The part below the quantum stays with the spans.
    StoredStrain& stored = stored_end_[at(place)];
    stored.fit(End::outgoing, next.reals[stored_length_index(link)], stored.strain_at(1.0),
               cable_of(cables_, link).strain_energy());
    save_strain(stored, link, next);
  }
}

double CableSystem::stored_energy(const FeatureState& own) const {
  double energy = 0.0;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    if (cable.inverse_stiffness == 0.0 || own.integers[cut_index(static_cast<int>(c))] != 0) {
      continue;
    }
    for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
      if (const int sheath = sheath_places_[at(i)]; sheath >= 0) {
        const SheathProfile profile(
            std::span(own.reals).subspan(sheath_index(at(sheath)), SheathProfile::real_count));
        energy += profile.energy(sheaths_[at(sheath)].law);
      }
      // The cable on a link of a rope with memory counts with a span.
      if (strain_places_[at(i)] < 0 || cable.memory) continue;
      energy += 0.5 / cable.inverse_stiffness * stored_strain(own, i).total().square;
    }
  }
  return energy;
}

}  // namespace sheave
