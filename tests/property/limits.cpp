#include "tests/property/limits.h"

#include <algorithm>

namespace sheave::test {

double motion_bound(const World& world, const State& before) {
  constexpr double arm = 0.5;
  const StepSettings& step = world.model().step;
  double sum = 0.0;
  for (std::size_t i = 0; i < before.bodies.size(); ++i) {
    const BodyState& a = before.bodies[i];
    const BodyState& b = world.state().bodies[i];
    sum += std::max(a.velocity.norm(), b.velocity.norm()) +
           arm * std::max(a.angular_velocity.norm(), b.angular_velocity.norm());
  }
  return sum * step.dt / step.substeps;
}

double shortest_span(const Simulation& simulation) {
  double shortest = 1e300;
  for (const CableReport& cable : simulation.cable_reports()) {
    for (std::size_t k = 0; k < cable.spans.size(); ++k) {
      if (!cable.links[k].touched) continue;  // no span begins there
      const SpanReport& span = cable.spans[k];
      shortest = std::min(shortest, span.has_tangent ? span.length : 0.0);
    }
  }
  return shortest;
}

Machine with_single_substeps(Machine machine) {
  StepSettings& step = machine.model.step;
  step.dt /= step.substeps;
  step.substeps = 1;
  return machine;
}

}  // namespace sheave::test
