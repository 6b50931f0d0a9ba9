// The cable passes stations in a row (or, a belt, on a ring) that are far enough apart for tangents
// to exist. At each station stands one link on a body of its own or on one that an earlier link
// uses, too.

#include "tests/property/random_machine.h"

#include <cmath>
#include <sstream>

#include "cable/links/pinhole.h"
#include "tests/property/random_links.h"

namespace sheave::test {
namespace {

Vector3 station(Random& random, const Traits& traits, bool closed, int index, int count) {
  const double spacing = traits.spacing * random.between(1.0, 1.5);
  if (!closed) return {index * 1.5 * traits.spacing, random.between(-0.4, 0.4), 0.0};
  // Chords of the ring are as long as the spacing asks for.
  const double radius = 0.5 * spacing / std::sin(pi / std::max(count, 3)) + 0.1;
  const double angle = 2.0 * pi * index / count;
  return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

/// Which way the cable turns at station i, so that it wraps the wheel by the smaller arc.
Winding natural_winding(const std::vector<Vector3>& stations, bool closed, int i) {
  const auto count = static_cast<int>(stations.size());
  const auto point = [&](int k) { return stations[static_cast<std::size_t>((k + count) % count)]; };
  if (!closed && (i == 0 || i + 1 == count)) return Winding::counter_clockwise;
  const double turn = (point(i) - point(i - 1)).cross(point(i + 1) - point(i)).z();
  return turn > 0.0 ? Winding::counter_clockwise : Winding::clockwise;
}

void add_cable_settings(Random& random, const Traits& traits, CableDef& cable) {
  cable.name = "rope";
  if (traits.elastic && random.chance(0.4)) {
    if (random.chance(0.5)) {
      cable.compliance = std::pow(10.0, random.between(-6.0, -2.0));
    } else {
      cable.axial_stiffness = std::pow(10.0, random.between(2.0, 6.0));
    }
    if (random.chance(0.3)) cable.damping = random.between(0.0, 50.0);
  }
  if (traits.frozen && random.chance(0.15)) cable.tangent_update = TangentUpdate::substep;
}

/// Rest lengths other than the lengths at time 0, which `simulation` tells.
void change_rest_lengths(Random& random, const Simulation& simulation, CableDef& cable) {
  const CableReport report = simulation.cable_reports().front();
  const bool elastic = cable.compliance || cable.axial_stiffness;
  for (const SpanReport& span : report.spans) {
    const double factor = elastic ? random.between(0.97, 1.15) : random.between(1.0, 1.2);
    cable.rest_lengths.push_back(factor * span.length);
  }
}

Machine draw(Random& random, const Traits& traits) {
  Machine machine;
  machine.model.gravity = {0.0, -g, 0.0};
  machine.model.step.substeps = 1 + random.below(5);
  machine.model.step.dt = machine.model.step.substeps * traits.longest * random.between(0.1, 1.0);
  machine.model.step.iterations = 1 + random.below(20);
  const bool closed = random.chance(0.2);
  const int count = closed ? 2 + random.below(5) : 2 + random.below(7);
  CableDef cable;
  cable.closed = closed;
  add_cable_settings(random, traits, cable);
  const bool skew = traits.skew && random.chance(0.4);
  const Quaternion frame =
      traits.skew && random.chance(0.3) ? random.orientation() : Quaternion(Quaternion::Identity());
  std::vector<Vector3> stations;
  for (int i = 0; i < count; ++i) {
    stations.push_back(station(random, traits, closed, i, count));
    if (skew) stations.back().z() += random.between(-0.3, 0.3);
  }
  LinkMaker maker(random, traits, machine);
  for (int i = 0; i < count; ++i) {
    Place place;
    place.center = frame * stations[static_cast<std::size_t>(i)];
    place.frame = skew ? Quaternion(frame * rotation_by(random.vector(0.3))) : frame;
    place.flat = !skew;
    place.open = !closed;
    place.winding = natural_winding(stations, closed, i);
    if (random.chance(0.2)) place.winding = random.chance(0.5) ? left : right;
    const bool end = !closed && (i == 0 || i + 1 == count);
    cable.links.push_back(end ? maker.end_link(place) : maker.middle_link(place));
  }
  machine.cables.push_back(std::move(cable));
  return machine;
}

}  // namespace

void choose_method(std::uint64_t seed, StepSettings& step) {
  Random random(seed ^ 0x9e3779b97f4a7c15U);
  step.solver = random.chance(0.5) ? SolverKind::direct : SolverKind::gauss_seidel;
  step.integrator = random.chance(0.5) ? IntegratorKind::rattle : IntegratorKind::xpbd;
}

RandomMachine random_machine(Random& random, const Traits& traits) {
  RandomMachine result;
  constexpr int most_draws = 100;
  while (result.refused < most_draws) {
    result.machine = draw(random, traits);
    const bool slack = random.chance(traits.slack);
    Result<Simulation> simulation = Simulation::create(result.machine.model, result.machine.cables);
    if (simulation && slack) {
      change_rest_lengths(random, *simulation, result.machine.cables.front());
      simulation = Simulation::create(result.machine.model, result.machine.cables);
    }
    if (simulation) return result;
    if (result.refused++ == 0) result.first_refusal = text(simulation.errors());
  }
  throw std::runtime_error("no machine is accepted: " + result.first_refusal);
}

RandomMachine random_machine(std::uint64_t seed, const Traits& traits) {
  Random random(seed);
  RandomMachine result = random_machine(random, traits);
  choose_method(seed, result.machine.model.step);
  return result;
}

std::string describe(const Machine& machine) {
  std::ostringstream out;
  const StepSettings& step = machine.model.step;
  out << "dt " << step.dt << " / " << step.substeps << " x " << step.iterations << ' '
      << solver_names[static_cast<std::size_t>(step.solver)] << ' '
      << integrator_names[static_cast<std::size_t>(step.integrator)] << "; bodies:";
  for (const BodyDef& body : machine.model.bodies) {
    out << ' ' << body.name << '(' << mobility_names[static_cast<std::size_t>(body.mobility)];
    if (body.mount) out << " on " << body.mount->index;
    if (body.spin_inertia) out << " J=" << *body.spin_inertia;
    out << ')';
  }
  for (const CableDef& cable : machine.cables) {
    out << "; " << (cable.closed ? "closed " : "") << "cable";
    if (cable.compliance) out << " compliance " << *cable.compliance;
    if (cable.axial_stiffness) out << " EA " << *cable.axial_stiffness;
    if (cable.damping > 0.0) out << " damping " << cable.damping;
    if (cable.tangent_update == TangentUpdate::substep) out << " frozen";
    if (!cable.rest_lengths.empty()) out << " rest lengths given";
    out << ":";
    for (const auto& link : cable.links) out << ' ' << describe(*link);
  }
  return out.str();
}

}  // namespace sheave::test
