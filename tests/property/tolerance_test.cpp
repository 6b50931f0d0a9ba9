// Random machines with a tolerance against finer ones. No run may be off by more than three tolerances
// without a word, and none may take more attempts than its bound. Machines whose motion amplifies
// errors, or whose friction leaves a choice, are for people to examine, so this campaign runs on request:
//   dev/campaign CASES SEED '*KeepTheTolerance'
// With SHEAVE_FAULTS=FOLDER it writes machines that fail as scenes.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cable/run_check.h"
#include "engine/body_set.h"
#include "engine/step_size.h"
#include "tests/property/campaign.h"
#include "tests/property/impossible.h"
#include "tests/property/shrink.h"
#include "tests/property/wide_machine.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

constexpr int tolerant_steps = 30;
constexpr double coarse = 1e-3;  // [m]
constexpr double fine = 1e-5;

struct TolerantCourse {
  std::vector<Vector3> places;  // of all bodies after each step
  bool silent = true;           // nothing says that the run is not to be trusted
  std::int64_t most_attempts = 0;
};

/// Nothing if the machine is refused.
std::optional<TolerantCourse> tolerant_course(Machine machine, double tolerance) {
  StepSettings& step = machine.model.step;
  step.solver = SolverKind::direct;
  step.integrator = IntegratorKind::rattle;
  step.tolerance = tolerance;
  Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  if (!made) return std::nullopt;
  Simulation& simulation = *made;
  RunCheck check(simulation);
  TolerantCourse course;
  for (int i = 0; i < tolerant_steps; ++i) {
    const StepReport report = simulation.step({}, check.within(simulation), {});
    const StepStatistics& done = report.statistics;
    course.most_attempts =
        std::max(course.most_attempts, done.kept_substeps + done.undone_substeps);
    const bool told = done.compromises > 0 || done.impossible > 0 || done.dead_ends > 0;
    if (!report.ok() || told) course.silent = false;
    if (!report.ok()) break;
    check.observe(simulation, done, i + 1 == tolerant_steps);
    for (const BodyState& body : simulation.world.state().bodies) {
      course.places.push_back(body.position);
    }
  }
  course.silent = course.silent && check.certificate().clean();
  return course;
}

TEST(Property, DISABLED_WideMachinesKeepTheTolerance) {
  run_campaign_on(
      "wide-tolerance", 100,
      [](std::uint64_t seed) {
        return RandomMachine{wide_machine(seed), 0, {}};
      },
      [](const Machine& machine, std::uint64_t seed) {
        const Finding nothing{false, 0.0, 0.0, ""};
        if (asks_the_impossible(machine)) return nothing;
        const std::optional<TolerantCourse> run = tolerant_course(machine, coarse);
        if (!run) return nothing;
        // Attempts at substeps, and for each one kept at most a look ahead and its repetition.
        constexpr auto bound = static_cast<double>(4 * StepSizeControl::most_attempts);
        const auto attempts = static_cast<double>(run->most_attempts);
        if (attempts > bound) return Finding{true, attempts, bound, "attempts in a step"};
        if (!run->silent) return nothing;
        const std::optional<TolerantCourse> right = tolerant_course(machine, fine);
        if (!right || !right->silent) return nothing;
        double off = 0.0;
        for (std::size_t i = 0; i < std::min(run->places.size(), right->places.size()); ++i) {
          off = std::max(off, (run->places[i] - right->places[i]).norm());
        }
        const char* folder = std::getenv("SHEAVE_FAULTS");
        if (folder != nullptr && off > 3.0 * coarse) {
          std::ofstream(fmt::format("{}/wide-tolerance-{}.json", folder, seed))
              << scene_of(machine, fmt::format("wide-tolerance, seed {}: {} m", seed, off));
        }
        return Finding{true, off, 3.0 * coarse, "distance from the finer run [m]"};
      });
}

}  // namespace
}  // namespace sheave::test
