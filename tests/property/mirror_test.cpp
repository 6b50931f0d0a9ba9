// The mirror image of a machine moves like the mirror image of its motion.
//
// Mirroring changes signs, and every rounding is the same for x and -x, so the motions agree to the
// last bit as long as every sum has its terms in the same order. That is so but for outlines: their
// corners are counted counter-clockwise from another corner, which rounds distances along them
// differently.

#include "tests/property/mirror.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "tests/property/campaign.h"
#include "tests/property/limits.h"
#include "tests/support/rounding.h"

namespace sheave::test {
namespace {

/// Largest difference of two states: positions [m], orientations, and velocities times h.
double state_difference(const State& state, const State& other, double h) {
  double worst = 0.0;
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const BodyState& a = state.bodies[i];
    const BodyState& b = other.bodies[i];
    worst = std::max({worst, (a.position - b.position).norm(),
                      (a.orientation.coeffs() - b.orientation.coeffs()).norm(),
                      h * (a.velocity - b.velocity).norm(),
                      h * (a.angular_velocity - b.angular_velocity).norm()});
  }
  return worst;
}

State mirrored_state(State state) {
  for (BodyState& body : state.bodies) {
    body.position = mirrored(body.position);
    body.orientation = mirrored(body.orientation);
    body.velocity = mirrored(body.velocity);
    body.angular_velocity = mirrored_axial(body.angular_velocity);
  }
  return state;
}

double mirror_difference(const State& state, const State& image, double h) {
  return state_difference(mirrored_state(state), image, h);
}

/// Follows a machine and its image; `limit` says how far apart they may be after so many steps.
Finding mirror_finding(const Machine& machine, int steps,
                       const std::function<double(int step)>& limit) {
  Simulation s = start(machine);
  Simulation image = start(mirrored(machine));
  Finding worst;
  for (int i = 0; i < steps; ++i) {
    const bool ok = s.world.step().ok();
    if (ok != image.world.step().ok()) return {true, 1.0, 0.0, "one fails, the other does not"};
    if (!ok || !s.cables->tangent_warnings().empty()) break;
    worst.worsen(mirror_difference(s.world.state(), image.world.state(), machine.model.step.dt),
                 limit(i), "step " + std::to_string(i));
  }
  return worst;
}

/// How many steps of at most so many end before a rolling end has used up its cable: its attachment
/// is kept as an angle.
int steps_without_attaching(const Machine& machine, int most_steps) {
  Simulation s = start(machine);
  for (int i = 0; i < most_steps; ++i) {
    if (!s.world.step().ok()) return i + 1;
    for (const CableEvent& event : s.cables->events()) {
      if (event.kind == CableEvent::Kind::attach) return i;
    }
  }
  return most_steps;
}

TEST(Property, MirrorImageMovesAlikeToTheLastBit) {
  Traits traits;
  traits.outlines = false;
  traits.changing_ends = false;
  run_campaign("mirror image, to the last bit", traits, [](const Machine& random, std::uint64_t) {
    const Machine machine = with_single_substeps(random);
    const int steps = steps_without_attaching(machine, 100);
    return mirror_finding(machine, steps, [](int) { return 0.0; });
  });
}

/// How far, step by step, a machine goes from itself if its rest lengths are changed by `change` at
/// time 0: what the solver's conditioning makes of a rounding error.
std::vector<double> sensitivity(const Machine& machine, int steps, double change) {
  Simulation s = start(machine);
  Simulation other = start(machine);
  State state = other.world.state();
  const auto spans = s.cable_reports()[0].spans.size();
  for (std::size_t k = 0; k < spans; ++k) {
    state.features.back().reals[k] += k % 2 == 0 ? change : -change;
  }
  static_cast<void>(other.world.restore(state));
  std::vector<double> result;
  double largest = change;
  for (int i = 0; i < steps; ++i) {
    // What diverges stays where it is, and so does the difference.
    static_cast<void>(s.world.step());
    static_cast<void>(other.world.step());
    const double h = machine.model.step.dt;
    largest = std::max(largest, state_difference(s.world.state(), other.world.state(), h));
    result.push_back(largest / change);
  }
  return result;
}

// With outlines and with hybrid ends, whose attachments are kept as angles, the value of each row
// is rounded differently, by some 16 eps of the size of the machine in each of a substep's sweeps.
// What that comes to is measured: the same machine with rest lengths changed by 1e-12 m. Errors of
// later substeps grow less than those of the first. A machine that makes a million times as much of
// the change is about to pass a dead centre, where rounding decides which way it goes; it is
// followed no further.
TEST(Property, MirrorImageOfOutlinesAndChangingEndsMovesAlike) {
  run_campaign("mirror image", {}, [](const Machine& random, std::uint64_t) {
    const Machine machine = with_single_substeps(random);
    constexpr int most_steps = 20;
    const std::vector<double> growth = sensitivity(machine, most_steps, 1e-12);
    const auto steps =
        std::find_if(growth.begin(), growth.end(), [](double factor) { return factor > 1e6; }) -
        growth.begin();
    const double size = start(machine).world.bodies().scale() + 1.0;
    const double rounding = 16.0 * eps * size * machine.model.step.iterations;
    return mirror_finding(machine, static_cast<int>(steps), [&](int i) {
      return (i + 1) * rounding * growth[static_cast<std::size_t>(i)];
    });
  });
}

}  // namespace
}  // namespace sheave::test
