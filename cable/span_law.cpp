#include "cable/span_law.h"

#include <algorithm>
#include <cmath>

namespace sheave {

const CompiledCable& cable_of(const std::vector<CompiledCable>& cables, int link) {
  return *std::find_if(cables.begin(), cables.end(), [&](const CompiledCable& cable) {
    return link < cable.first_link + cable.link_count;
  });
}

LawStep law_step(const Substep& substep, bool knows_start) {
  if (substep.at_rest) return {};
  // Only `rattle` linearises before bodies have moved.
  if (substep.time == substep.start.time) return {LawStep::Rule::start, 0.0};
  return {knows_start ? LawStep::Rule::mean : LawStep::Rule::end, substep.h};
}

namespace {

/// The law of a cable over strains from its slack on.
struct Curve {
  Curve(const CompiledCable& cable, double remembered)
      : law(*cable.law),
        memory(cable.memory.get()),
        m(remembered),
        slack(memory != nullptr ? memory->slack(m) : 0.0) {}

  [[nodiscard]] double tension(double e) const {
    return memory != nullptr ? memory->tension(slack + e, m) : law.tension(e);
  }
  [[nodiscard]] double stiffness(double e) const {
    return memory != nullptr ? memory->stiffness(slack + e, m) : law.stiffness(e);
  }
  [[nodiscard]] double mean(double from, double to) const {
    return memory != nullptr ? memory->mean(slack + from, slack + to, m) : law.mean(from, to);
  }
  [[nodiscard]] double mean_stiffness(double from, double to) const {
    return memory != nullptr ? memory->mean_stiffness(slack + from, slack + to, m)
                             : law.mean_stiffness(from, to);
  }
  /// Energy that the rope gives when it is let off, per unstretched length [N].
  [[nodiscard]] double returned(double e) const {
    return memory != nullptr ? memory->returned(slack + e, m) : law.energy(e);
  }

  const TensionLaw& law;
  const RopeMemory* memory;
  double m;
  double slack;
};

/// The row of a span that becomes taut, with the tension T* and its derivative.
LawRow taut_row(double tension, double stiffness, double strain, double slack) {
  // F and (dF / de) e / F
  const double mean = 0.5 * tension * strain / (slack + strain);
  const double power = stiffness * strain / tension + slack / (slack + strain);
  // (x + 2 g) / (x (g + x)) = power / e
  const double half = strain - power * slack;
  const double x = (half + std::sqrt(half * half + 8.0 * power * slack * strain)) / (2.0 * power);
  LawRow row;
  row.ratio = x / strain;
  row.yield = 0.5 * x * (x / (mean * (slack + x)));
  return row;
}

}  // namespace

double slack_strain(const CompiledCable& cable, const LawStart& start) {
  return cable.memory ? cable.memory->slack(start.memory) : 0.0;
}

LawRow law_row(const CompiledCable& cable, const LawStep& step, const LawStart& given,
               double given_strain, double damper) {
  const Curve law(cable, given.memory);
  const double strain = given_strain - law.slack;
  LawStart start = given;
  start.strain = std::max(given.strain - law.slack, 0.0);
  LawRow row;
  if (!(strain > 0.0)) {
    row.yield = 1.0 / law.stiffness(0.0);
    return row;
  }
  if (step.rule == LawStep::Rule::start) {
    row.yield = 0.5 * strain * (strain / law.returned(strain));
    return row;
  }
  const bool mean = step.rule == LawStep::Rule::mean;
  const double drag = step.h > 0.0 ? (mean ? 2.0 : 1.0) * damper / step.h : 0.0;
  double tension = drag * (strain - start.strain);
  double stiffness = drag;
  if (mean) {
    tension += 2.0 * law.mean(start.strain, strain);
    if (start.strain > 0.0) tension -= 2.0 * law.returned(start.strain) / start.strain;
    stiffness += 2.0 * law.mean_stiffness(start.strain, strain);
  } else {
    tension += law.tension(strain);
    stiffness += law.stiffness(strain);
  }
  row.pushes = !(tension > 0.0);
  if (mean && !(start.strain > 0.0) && !row.pushes) {
    return taut_row(tension, stiffness, strain, start.slack);
  }
  row.ratio = tension / stiffness / strain;
  row.yield = 1.0 / stiffness;
  return row;
}

void follow_law(const CompiledCable& cable, const LawStep& step, const LawStart& start,
                double strain, double spring_length, Row& row) {
  const double slack = slack_strain(cable, start);
  const double own = step.rule == LawStep::Rule::start ? start.strain : strain;
  const double damper = cable.axial_damping + cable.damping * spring_length;
  const LawRow law = law_row(cable, step, start, own, damper);
  if (own > slack) {
    row.value = -(own - slack) * law.ratio * spring_length;
  } else {
    row.value += slack * spring_length;
  }
  row.compliance = law.yield * spring_length;
  // The law contains the damper, except where statics asks for it.
  row.damping =
      step.h > 0.0 || step.rule == LawStep::Rule::start ? 0.0 : cable.damper(spring_length);
  row.judged = law.pushes;
}

}  // namespace sheave
