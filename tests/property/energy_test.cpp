// No energy out of nothing: a conservative machine with a rigid cable loses energy or keeps it.
//
// With v' = v + h g + p (p: change by the constraints) and x' = x + h v', one substep changes the
// energy by
//   dE = v'.M p - |v' - v|^2_M / 2,     v'.M p = sum_k l_k/h^2 grad C_k.(x' - x)
// exactly, with the gradients where the sweeps took them. Were C linear, grad C.(x' - x) = C(x') -
// C(x) would be what the solver left over now less what it had left over before. It is not, and the
// gradients are taken elsewhere, by at most what the substep moves: s, and h^2 g. So with the
// tensions T = l/h^2
//   dE <= sum_k T_k (|r'| + |r| + K s (s + h^2 g)).
// K bounds the second derivative of C: 1/l for the ends of a span of length l, 1/a for an arm a
// that turns; s counts turns with a = 0.5 m; the factor 8 is for the up to four terms of a row,
// each counted from both. Free rotation is integrated to second order: (h w)^3 of the energy of
// rotation. Places are rounded by some 16 eps of the machine's size, which counts with the weight m
// g, the tensions, and through v = dx/h with the momentum over h.
//
// That is for xpbd with either solver. `rattle` does not damp, |v' - v|^2_M / 2 does not help it;
// but it takes each half of T along the gradient at one end of the substep, so on a smooth motion
// its work differs from T (C(x') - C(x)) only in the third order of the substep, and where a span
// goes taut it is inelastic: the same bound holds.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "tests/property/campaign.h"
#include "tests/property/limits.h"
#include "tests/support/rounding.h"

namespace sheave::test {
namespace {

/// Sum of the tensions [N], and the largest stretch of a span [m].
struct Pull {
  double tension = 0.0;
  double stretch = 0.0;
};

Pull pull_of(const Simulation& s) {
  Pull pull;
  for (const CableReport& cable : s.cable_reports()) {
    for (const SpanReport& span : cable.spans) {
      pull.tension += span.tension;
      pull.stretch = std::max(pull.stretch, span.length - span.rest_length);
      // A taut span whose length is short of its rest length is left over, too.
      if (span.tension > 0.0) pull.stretch = std::max(pull.stretch, span.rest_length - span.length);
    }
  }
  return pull;
}

double largest_spin(const State& state) {
  double spin = 0.0;
  for (const BodyState& body : state.bodies) spin = std::max(spin, body.angular_velocity.norm());
  return spin;
}

/// Largest rounding error of the energy of bodies and cables in a substep [J].
double energy_rounding(const World& world, double tension) {
  double forces = tension;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyState& body = world.state().bodies[static_cast<std::size_t>(i)];
    const double speed = body.velocity.norm() + 0.5 * body.angular_velocity.norm();
    forces += world.bodies()[i].mass * (g + speed / world.model().step.dt);
  }
  return 16.0 * eps * (world.bodies().scale() + 1.0) * forces;
}

Finding energy_finding(const Machine& random) {
  Machine machine = with_single_substeps(random);
  machine.model.step.iterations = 100;
  Simulation s = start(machine);
  const double h = machine.model.step.dt;
  Finding worst;
  for (int i = 0; i < 100; ++i) {
    const State before = s.world.state();
    const double energy = s.world.energy().total();
    const double kinetic = s.world.energy().kinetic;
    const double stretch = pull_of(s).stretch;
    const double shortest = shortest_span(s);
    if (!(shortest > 0.05) || !s.world.step().ok()) break;
    const Pull pull = pull_of(s);
    const double moved = motion_bound(s.world, before);
    const double spin = std::max(largest_spin(before), largest_spin(s.world.state()));
    const double curvature = 8.0 * (1.0 / shortest + 1.0 / 0.5);
    const double limit =
        pull.tension * (pull.stretch + stretch + curvature * moved * (moved + h * h * g)) +
        kinetic * std::pow(h * spin, 3) + energy_rounding(s.world, pull.tension);
    worst.worsen(s.world.energy().total() - energy, limit, "step " + std::to_string(i));
  }
  return worst;
}

Traits conservative() {
  Traits traits;
  traits.elastic = false;
  traits.kinematic = false;
  traits.friction = false;
  traits.frozen =
      false;  // tangent points that stay on the bodies are another machine in each substep
  return traits;
}

TEST(Property, EnergyDoesNotRiseOverWheels) {
  Traits traits = conservative();
  traits.outlines = false;
  run_campaign("energy, wheels", traits,
               [](const Machine& m, std::uint64_t) { return energy_finding(m); });
}

// Only in one plane: a cable that comes at an angle a to an outline's plane and goes over to the
// next corner takes the edge e between them at once, but its length changes by about e cos a, so C
// jumps by e (1 - cos a), and the solver makes motion of that.
TEST(Property, EnergyDoesNotRiseOverOutlinesInOnePlane) {
  Traits traits = conservative();
  traits.skew = false;
  run_campaign("energy, outlines", traits,
               [](const Machine& m, std::uint64_t) { return energy_finding(m); });
}

}  // namespace
}  // namespace sheave::test
