#include "measure/stress_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/sources_of_energy.h"
#include "engine/body_set.h"

namespace sheave::measure {
namespace {

constexpr double length_error_limit = 1e-9;
constexpr double energy_gain_limit = 0.1;  // relative to the largest kinetic energy
/// Relative rounding of positions to the scene's size, and of potential energy: some thousand
/// roundings.
constexpr double rounding = 1e-12;
constexpr double slack_limit = 1e-6;      // relative to the required tension
constexpr double tolerance_share = 1e-3;  // tolerance of a generated check relative to its size

double moving_mass(const BodyProperties& body) { return yields(body.mobility) ? body.mass : 0.0; }

bool wants_pull(const CheckDef& check) {
  return check.quantity.ends_with(".tension") && check.statistic == Statistic::mean &&
         check.equals > check.allowed_error();
}

/// Excess length of a rigid cable relative to its length; 0 for elastic cables.
double stretch_of(const CableReport& cable) {
  if (!(cable.max_stretch > 0.0) || cable.cut) return 0.0;
  double excess = 0.0;
  for (const SpanReport& span : cable.spans) {
    excess += std::max(0.0, span.length - span.rest_length);
  }
  return excess / cable.total_length;
}

}  // namespace

bool is_conservative(const Scene& scene) {
  // Controllers and triggers may set drives and forces.
  if (!scene.controllers.empty() || !scene.triggers.empty() || !scene.loads.empty()) {
    return false;
  }
  // The energy of a rope's weight leaves the machine with the rope.
  const auto may_lose_weight = [](const CableDef& cable) {
    return cable.linear_density > 0.0 && (cable.breaking_tension || cable.cut_time);
  };
  if (std::any_of(scene.cables.begin(), scene.cables.end(), may_lose_weight)) return false;
  return certify::is_passive(scene.model, scene.cables);
}

StressJudge::StressJudge(const Scene& scene, const Simulation& simulation)
    : checks_(scene, simulation),
      checked_(!scene.checks.empty()),
      conservative_(is_conservative(scene)) {
  const BodySet& bodies = simulation.world.bodies();
  double mass = 0.0;
  for (int i = 0; i < bodies.count(); ++i) mass += moving_mass(bodies[i]);
  const StepSettings& step = scene.model.step;
  const double slowest = rounding * bodies.scale() * step.substeps / step.dt;
  rounding_energy_ = mass * slowest * slowest;
}

void StressJudge::observe(const Simulation& simulation) {
  checks_.record(simulation);
  const Energy energy = simulation.world.energy();
  if (!first_energy_) first_energy_ = energy.total();
  last_energy_ = energy.total();
  most_potential_ = std::max(most_potential_, std::abs(energy.potential) + energy.elastic);
  most_kinetic_ = std::max(most_kinetic_, energy.kinetic);
}

StressVerdict StressJudge::verdict(const Simulation& simulation,
                                   const std::optional<Divergence>& divergence) const {
  if (divergence) {
    return {StressKind::diverged, std::numeric_limits<double>::infinity(), divergence->message};
  }
  StressVerdict verdict;
  bool slack = false;
  for (const CheckResult& result : checks_.results()) {
    const double error = tolerance_share * std::abs(result.error) / result.tolerance;
    if (wants_pull(result.check) && result.measured < slack_limit * result.check.equals) {
      slack = true;
    }
    // Written so that NaN counts as large.
    if (!(error <= verdict.error)) {
      verdict.error = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
      verdict.detail = result.message;
    }
  }
  for (const CableReport& cable : simulation.cable_reports()) {
    if (!checked_ && stretch_of(cable) > verdict.error) {
      verdict.error = stretch_of(cable);
      verdict.detail = std::string(cable.name) + ": is longer than it can be";
    }
    if (std::abs(cable.length_error) <= length_error_limit) continue;
    verdict.kind = StressKind::lost_length;
    verdict.detail = std::string(cable.name) + ": its length no longer adds up";
    return verdict;
  }
  if (slack) {
    verdict.kind = StressKind::false_slack;
  } else if (conservative_ && first_energy_ &&
             last_energy_ - *first_energy_ > energy_gain_limit * most_kinetic_ +
                                                 rounding * most_potential_ + rounding_energy_) {
    verdict.kind = StressKind::energy_gain;
  } else if (verdict.error > stress_error_limit) {
    verdict.kind = StressKind::wrong;
  }
  return verdict;
}

}  // namespace sheave::measure
