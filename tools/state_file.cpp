#include "tools/state_file.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "tools/failure.h"
#include "tools/input_file.h"

namespace sheave::tools {
namespace {

/// A world of a million bodies with everything that features carry has a tenth of that.
constexpr std::size_t most_state_bytes = std::size_t{256} << 20U;

}  // namespace

void load_state(World& world, const std::string& path) {
  const Result<State> state = state_from_bytes(read_input(path, most_state_bytes));
  if (!state) throw Failure(ExitCode::bad_scene, path + ": " + to_text(state.errors()));
  const double dt = world.model().step.dt;
  constexpr std::int64_t most_steps = std::int64_t{1} << 53;
  const double time = static_cast<double>(state->steps) * dt;
  const bool counted = state->steps >= 0 && state->steps <= most_steps &&
                       std::abs(state->time - time) <= 1e-6 * dt + 1e-12 * time;
  if (!counted) {
    throw Failure(
        ExitCode::bad_scene,
        fmt::format("{}: its time {} s is not that of {} steps of {} s: it was saved with "
                    "another dt, or in the middle of a step",
                    path, number_text(state->time), state->steps, number_text(dt)));
  }
  const Errors errors = world.restore(*state);
  if (!errors.empty()) throw Failure(ExitCode::bad_scene, path + ": " + to_text(errors));
}

}  // namespace sheave::tools
