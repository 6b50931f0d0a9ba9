// sheave modes
#include <CLI/CLI.hpp>

#include "tools/command.h"

namespace sheave::tools {
Action declare_modes(CLI::App& app) {
  app.allow_extras();
  return [] { return ExitCode::done; };
}
}  // namespace sheave::tools
