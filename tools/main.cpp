// The `sheave` command: its subcommands, and how it ends.

#include <array>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <sheave_version.h>

#include <CLI/CLI.hpp>

#include "tools/command.h"
#include "tools/command_line.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

constexpr std::array<Command, 9> commands{{
    {"run", "Simulate a scene; write tables, print a summary", declare_run},
    {"render", "Simulate a scene; write a video or pictures", declare_render},
    {"bench", "Measure the paper's scenes: time per frame, with the error", declare_bench},
    {"trade", "Measure speed against accuracy of a scene; choose a setting", declare_trade},
    {"stress", "Map where extreme numbers break machines, or a scene", declare_stress},
    {"validate", "Check scenes without running them", declare_validate},
    {"generate", "Write a scene of a given kind and size", declare_generate},
    {"schema", "Print the JSON Schema of scenes", declare_schema},
    {"reference", "Print the reference of the scene format (Markdown)", declare_reference},
}};

ExitCode dispatch(int argc, char** argv) {
  CLI::App app{"Rigid bodies and cables that run over wheels.", "sheave"};
  use_wrapped_help(app);
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", std::string("sheave ") + version_string, "print the version");
  app.require_subcommand(1);
  app.footer(R"(Example:
  sheave run scenes/paper/simple.json

See sheave SUBCOMMAND --help for options and examples.)");
  std::vector<Action> actions;
  for (const Command& command : commands) {
    actions.push_back(command.declare(*app.add_subcommand(command.name, command.meaning)));
  }
  if (!parse_command_line(app, argc, argv)) return ExitCode::done;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (app.got_subcommand(commands[i].name)) return actions[i]();
  }
  return ExitCode::internal;
}

void print_internal_error(const char* what) {
  try {
    print_error(std::string("internal: ") + what);
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  }
}

/// Every way to end leads through here.
ExitCode run_command_line(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const Failure& failure) {
    print_error(failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_internal_error(error.what());
  }
  return ExitCode::internal;
}

/// An exception that a destructor or another function must not throw: libraries allocate in some. The way back is lost, the
/// reason is not.
[[noreturn]] void end_at_once() noexcept {
  try {
    if (const std::exception_ptr failure = std::current_exception()) {
      std::rethrow_exception(failure);
    }
    print_internal_error("terminated");
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_internal_error(error.what());
  } catch (...) {
    print_internal_error("unknown exception");
  }
  std::_Exit(static_cast<int>(ExitCode::internal));
}

}  // namespace
}  // namespace sheave::tools

int main(int argc, char** argv) {
  sheave::tools::turn_signals_into_errors();
  std::set_terminate(sheave::tools::end_at_once);
  return static_cast<int>(sheave::tools::run_command_line(argc, argv));
}
