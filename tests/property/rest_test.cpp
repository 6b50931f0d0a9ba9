// Machines with all that there is (wide_machine.h): where statics calls them at rest, they are, so a
// step from there leaves them there.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "statics/equilibrium.h"
#include "tests/property/campaign.h"
#include "tests/property/machine_at_rest.h"
#include "tests/property/shrink.h"
#include "tests/property/wide_machine.h"
#include "tests/support/effort.h"

namespace sheave::test {
namespace {

using Json = nlohmann::json;

/// The largest acceleration of the first step from the machine's equilibrium [m/s2], with both
/// integrators.
Finding rest(const Machine& machine) {
  // Statics ends at residuals of 1e-8 of forces, of which those of rigid rows count up to a hundred
  // times the loads.
  Finding finding{false, 0.0, 1e-5 * 9.81, "the acceleration at rest"};
  Json scene = Json::parse(scene_of(machine));
  take_out_sources(scene);
  std::optional<State> at_rest;
  for (const char* integrator : {"rattle", "xpbd"}) {
    scene["step"] = {{"dt", 1e-3},
                     {"substeps", 1},
                     {"iterations", 100},
                     {"solver", "direct"},
                     {"integrator", integrator}};
    const SceneResult loaded = load_scene_text(scene.dump(), "rest");
    if (!loaded.errors.empty()) return finding;
    Result<Simulation> simulation = create_simulation(*loaded);
    if (!simulation) return finding;
    if (!at_rest) {
      if (!find_equilibrium(*simulation).converged) return finding;
      at_rest = simulation->world.state();
    } else if (!simulation->world.restore(*at_rest).empty()) {
      return {true, INFINITY, finding.limit, "the state of the rest was refused"};
    }
    finding.checked = true;
    double fastest = simulation->world.step().ok() ? 0.0 : INFINITY;
    for (const BodyState& body : simulation->world.state().bodies) {
      fastest = std::max(fastest, body.velocity.norm());
    }
    finding.worsen(fastest / 1e-3, finding.limit, "at rest: " + scene.dump());
  }
  return finding;
}

TEST(Property, WideMachinesStayWhereStaticsFindsThemAtRest) {
  run_campaign_on(
      "rest", instrumented || !optimised ? 10 : 24,
      [](std::uint64_t seed) {
        return RandomMachine{wide_machine(seed), 0, {}};
      },
      [](const Machine& machine, std::uint64_t) { return rest(machine); });
}

}  // namespace
}  // namespace sheave::test
