#pragma once
// The interface of a subcommand. A new subcommand is a file here and a line in command/registry.cpp.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "command/failure.h"

namespace CLI {
class App;
}

namespace sheave::command {

/// The action of a subcommand, called after the command line has been read.
using Action = std::function<ExitCode()>;

/// One subcommand.
struct Command {
  const char* name;
  const char* meaning;               ///< one line of the help
  Action (*declare)(CLI::App& app);  ///< adds options and examples to `app`
};

/// All subcommands, in the order of the help.
[[nodiscard]] std::span<const Command> commands();

/// The command line with all subcommands.
struct CommandLine {
  std::unique_ptr<CLI::App> app;
  /// One per entry of commands(), in the same order; valid while `app` lives.
  std::vector<Action> actions;

  CommandLine();
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
};

/// Declares a subcommand that needs the renderer, in a build without it: accepts any arguments and
/// fails.
Action declare_without_renderer(CLI::App& app);
Action declare_run(CLI::App& app);
Action declare_live(CLI::App& app);
Action declare_render(CLI::App& app);
Action declare_statics(CLI::App& app);
Action declare_modes(CLI::App& app);
Action declare_view(CLI::App& app);
Action declare_validate(CLI::App& app);
Action declare_schema(CLI::App& app);
Action declare_reference(CLI::App& app);
Action declare_new(CLI::App& app);
Action declare_explain(CLI::App& app);
Action declare_generate(CLI::App& app);
Action declare_import(CLI::App& app);
Action declare_bench(CLI::App& app);
Action declare_trade(CLI::App& app);
Action declare_stress(CLI::App& app);
Action declare_completion(CLI::App& app);
Action declare_sweep(CLI::App& app);
Action declare_tune(CLI::App& app);
Action declare_merge(CLI::App& app);
Action declare_plot(CLI::App& app);

}  // namespace sheave::command
