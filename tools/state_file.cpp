#include "tools/state_file.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "tools/failure.h"

namespace sheave::tools {
namespace {

std::string read_file(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) {
    throw Failure(ExitCode::no_input, path + ": there is no such file");
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  // A folder opens, but does not read. An empty file sets a failure too, but is none.
  if (!file || std::filesystem::is_directory(path, code)) {
    throw Failure(ExitCode::io, path + ": cannot be read");
  }
  bytes << file.rdbuf();
  return bytes.str();
}

}  // namespace

void load_state(World& world, const std::string& path) {
  const Result<State> state = state_from_bytes(read_file(path));
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
