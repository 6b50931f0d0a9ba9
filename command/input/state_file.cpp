#include "command/input/state_file.h"

#include "command/failure.h"
#include "command/input/file.h"
#include "command/terminal.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/saved_state.h"

namespace sheave::command {
namespace {

/// The state of a million bodies with all features takes a tenth of this.
constexpr std::size_t most_state_bytes = std::size_t{256} << 20U;

}  // namespace

std::string read_state_bytes(const std::string& path) { return read_input(path, most_state_bytes); }

std::shared_ptr<const State> read_state(const Scene& scene, const std::string& path, bool warns) {
  const std::string bytes = read_state_bytes(path);
  Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) throw Failure(ExitCode::internal, to_text(simulation.errors()));
  const Result<std::vector<std::string>> warnings = load_saved_state(*simulation, bytes);
  if (!warnings) throw Failure(ExitCode::bad_scene, path + ": " + to_text(warnings.errors()));
  for (const std::string& warning : *warnings) {
    if (warns) print_warning(path + ": " + warning);
  }
  return std::make_shared<const State>(simulation->world.state());
}

}  // namespace sheave::command
