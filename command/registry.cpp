// The subcommands of `sheave`.

#include "command/registry.h"

#include <array>
#include <string>

#include <sheave_version.h>

#include <CLI/CLI.hpp>

#include "command/command_line.h"

namespace sheave::command {

std::span<const Command> commands() {
  static constexpr auto table = std::to_array<Command>({
      {"run", "Simulate a scene; write tables, print a summary", declare_run},
      {"live", "Run a world that another program controls by lines of JSON", declare_live},
      {"render", "Simulate a scene; write a video or pictures", declare_render},
      {"view", "Simulate a scene; write a page that shows it in a browser", declare_view},
      {"bench", "Measure the paper's scenes: time per frame, with the error", declare_bench},
      {"trade", "Measure speed against accuracy of a scene; choose a setting", declare_trade},
      {"stress", "Map the extreme numbers at which machines, or a scene, fail", declare_stress},
      {"sweep", "Run a scene with many values of its settings; tables, charts", declare_sweep},
      {"merge", "Merge the parts of a sharded sweep", declare_merge},
      {"tune", "Search the settings of a scene that are best for a measure", declare_tune},
      {"plot", "Draw quantities of runs over time, or over one another", declare_plot},
      {"statics", "Find the equilibrium of a scene, its forces and its stability", declare_statics},
      {"modes", "Find natural frequencies, damping and mode shapes at rest", declare_modes},
      {"validate", "Check scenes without running them", declare_validate},
      {"new", "Write a scene to begin with: crane, elevator, hand, robot", declare_new},
      {"explain", "Tell in sentences what is in a scene", declare_explain},
      {"import", "Make a scene from a model of another program (MJCF, URDF, OpenSim, CASPR)",
       declare_import},
      {"generate", "Write a scene of a given kind and size", declare_generate},
      {"schema", "Print the JSON Schema of scenes", declare_schema},
      {"reference", "Print the reference of the scene format (Markdown)", declare_reference},
      {"completion", "Print a script for completion in a shell", declare_completion},
  });
  return table;
}

Action declare_without_renderer(CLI::App& app) {
  app.allow_extras();
  return []() -> ExitCode {
    throw Failure(ExitCode::internal,
                  "this build has no renderer: configure with -DSHEAVE_RENDER=ON");
  };
}

CommandLine::CommandLine()
    : app(std::make_unique<CLI::App>("Rigid bodies and cables that run over wheels.", "sheave")) {
  use_wrapped_help(*app);
  app->set_help_flag("-h,--help", "print this help");
  app->set_version_flag("--version", std::string("sheave ") + version_string, "print the version");
  app->require_subcommand(1);
  app->footer(R"(Example:
  sheave run scenes/paper/simple.json

See sheave SUBCOMMAND --help for options and examples.)");
  for (const Command& command : commands()) {
    actions.push_back(command.declare(*app->add_subcommand(command.name, command.meaning)));
  }
}

CommandLine::~CommandLine() = default;

}  // namespace sheave::command
