// Gradients of all rows of random machines against finite differences, at random configurations of
// random moments.
//
// Tolerance. Five-point differences with h = 1e-3 are wrong by h^4/30 f''''' and by the rounding of
// C, some 16 eps of the lengths and places that make it up (10 m at least), over h. The fifth
// derivative of a distance l under motions of unit speed is at most 60/l^4 and of a tangent's
// length the same with the tangent's length, so with the shortest span l: 2e-12/l^4 + 4e-12 size;
// one power of ten more for the several terms of skew spans and of a body with an arm.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "tests/property/campaign.h"
#include "tests/property/limits.h"
#include "tests/support/gradient_check.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

/// Largest number that a cable's rows are made of [m].
double size_of(const Simulation& simulation) {
  double size = 10.0;
  for (const CableReport& cable : simulation.cable_reports()) {
    for (const SpanReport& span : cable.spans) {
      size = std::max({size, span.start.norm(), span.end.norm(), std::abs(span.rest_length)});
    }
    for (const LinkReport& link : cable.links) size = std::max(size, link.center.norm());
  }
  return size;
}

/// Whether every span has a tangent where the bodies are now. Between outlines in skew planes there
/// may be no pair of corners that suits both (cable/span_row.cpp): such spans are counted and
/// warned of, and their values jump.
bool all_have_tangents(const World& world, Substep& substep, ConstraintBatch& batch) {
  FeatureState next = world.state().features.back();
  substep.next = world.state();
  batch.finish(substep, next);
  return substep.statistics.geometry_fallbacks == 0;
}

/// The row of a material has the gradient of its tension, not of its value, as
/// tests/cable/span_gradient_test.cpp compares: here such a cable has a compliance instead.
Machine without_material(Machine machine) {
  for (CableDef& cable : machine.cables) {
    if (!cable.axial_stiffness) continue;
    cable.compliance = 1.0 / *cable.axial_stiffness;
    cable.axial_stiffness.reset();
  }
  return machine;
}

Finding gradient_finding(const Machine& machine, std::uint64_t seed, double angle) {
  Simulation s = start(without_material(machine));
  Random random(seed + 1);
  for (int steps = random.below(20); steps > 0; --steps) {
    if (!s.world.step().ok()) return {false, 0.0, 0.0, ""};
  }
  World& world = s.world;
  // The shortest span after the displacement decides.
  constexpr double distance = 0.03;
  const double shortest = shortest_span(s) - 4.0 * distance;
  if (!(shortest > 0.1)) return {false, 0.0, 0.0, ""};
  Substep substep(world.bodies(), world.state(), 0.003, 1);
  ConstraintBatch& batch = *world.features().back();
  batch.begin(substep, world.state().features.back());
  displace(substep, distance, angle, static_cast<unsigned>(seed));
  const GradientCheck check = check_gradients(substep, batch, true);
  if (!all_have_tangents(world, substep, batch)) return {false, 0.0, 0.0, ""};
  return {check.compared > 0, check.error,
          10.0 * (2e-12 / std::pow(shortest, 4) + 4e-12 * size_of(s)), check.worst};
}

// A drum's radius follows its angle, and in skew planes its rows miss a little
// (cable/cable_layers.cpp); drums here have no layers.
Traits without_layers() {
  Traits traits;
  traits.layers = false;
  return traits;
}

TEST(Property, GradientsMatchDifferencesWithoutMountedRotors) {
  Traits traits = without_layers();
  traits.mounted = false;
  run_campaign("gradients", traits,
               [](const Machine& m, std::uint64_t seed) { return gradient_finding(m, seed, 0.1); });
}

// The absolute spin of a mounted rotor is a quasi-coordinate: its rows miss by the angle by which
// the carrier has turned in the substep (tests/engine/joint_gradient_test.cpp), so here nothing
// turns before the comparison.
TEST(Property, GradientsMatchDifferencesWithMountedRotorsAtTheStart) {
  run_campaign("gradients, mounted", without_layers(),
               [](const Machine& m, std::uint64_t seed) { return gradient_finding(m, seed, 0.0); });
}

}  // namespace
}  // namespace sheave::test
