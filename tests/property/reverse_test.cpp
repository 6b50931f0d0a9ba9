// A cable moves the same from whichever end its links are counted.
//
// Counted from the other end the rows are visited in another order, so this holds for what the
// sweeps converge to (what is left of that is measured by twice the number of sweeps). And even
// that depends on the order a little: XPBD pushes along the gradient of the moment, and while
// things move by M a gradient turns by M times the second derivative of C, at most K = 8 (1/l +
// 1/a) for a span of length l and an arm a = 0.5 m (energy_test.cpp). So the motions M after some
// very short substeps from rest, about 1e-6 m, may differ by K M^2, a hundred-thousandth of M. A
// wrong force shows in M itself.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "tests/property/campaign.h"
#include "tests/property/limits.h"
#include "tests/property/mirror.h"
#include "tests/support/rounding.h"

namespace sheave::test {
namespace {

constexpr int reverse_steps = 4;
constexpr int reverse_sweeps = 1000;

/// Positions after some substeps of length h. Orientations count through the turn of a point at 0.5
/// m.
struct Poses {
  bool followed = false;
  std::vector<BodyState> bodies;
};

Poses poses_after(Machine machine, double h, int sweeps) {
  StepSettings& step = machine.model.step;
  step.dt = h;
  step.substeps = 1;
  step.iterations = sweeps;
  Simulation s = start(machine);
  for (int i = 0; i < reverse_steps; ++i) {
    if (!s.world.step().ok()) return {};
  }
  return {s.cables->tangent_warnings().empty(), s.world.state().bodies};
}

double distance(const Poses& a, const Poses& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    worst =
        std::max({worst, (a.bodies[i].position - b.bodies[i].position).norm(),
                  (a.bodies[i].orientation.coeffs() - b.bodies[i].orientation.coeffs()).norm()});
  }
  return worst;
}

Finding reverse_finding(const Machine& machine) {
  const Machine back = reversed(machine);
  constexpr double h = 2e-4;
  const Poses there = poses_after(machine, h, reverse_sweeps);
  const Poses here = poses_after(back, h, reverse_sweeps);
  if (there.followed != here.followed) return {true, 1.0, 0.0, "followed one way only"};
  const Simulation before = start(machine);
  const double shortest = shortest_span(before);
  if (!there.followed || !(shortest > 0.1)) return {false, 0.0, 0.0, ""};
  const double difference = distance(there, here);
  const double size = before.world.bodies().scale() + 1.0;
  const double rounding = 64.0 * eps * size * reverse_steps * reverse_steps;
  const double moved = distance(there, {true, before.world.state().bodies});
  const double limit = 8.0 * (1.0 / shortest + 2.0) * moved * moved + rounding;
  if (difference <= limit) return {true, difference, limit, "difference"};
  const double unconverged = distance(there, poses_after(machine, h, 2 * reverse_sweeps)) +
                             distance(here, poses_after(back, h, 2 * reverse_sweeps));
  if (unconverged > 1e-3 * moved) return {false, 0.0, 0.0, ""};  // says too little
  return {true, difference, limit + 2.0 * unconverged, "difference, not converged"};
}

TEST(Property, ReversedCableMovesTheSame) {
  Traits traits;
  traits.at_rest = true;
  traits.kinematic = false;
  // Which link begins to slide when several are at their limit is decided sweep by sweep.
  traits.friction = false;
  run_campaign("reversed cable", traits,
               [](const Machine& m, std::uint64_t) { return reverse_finding(m); });
}

}  // namespace
}  // namespace sheave::test
