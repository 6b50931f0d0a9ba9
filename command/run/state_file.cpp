#include "command/run/state_file.h"

#include "command/failure.h"
#include "command/input/file.h"
#include "command/terminal.h"
#include "scenes/saved_state.h"

namespace sheave::command {
namespace {

/// The state of a million bodies with all features takes a tenth of this.
constexpr std::size_t most_state_bytes = std::size_t{256} << 20U;

}  // namespace

void load_state(Simulation& simulation, const std::string& path, bool warns) {
  const Result<std::vector<std::string>> warnings =
      load_saved_state(simulation, read_input(path, most_state_bytes));
  if (!warnings) throw Failure(ExitCode::bad_scene, path + ": " + to_text(warnings.errors()));
  if (!warns) return;
  for (const std::string& warning : *warnings) print_warning(path + ": " + warning);
}

}  // namespace sheave::command
