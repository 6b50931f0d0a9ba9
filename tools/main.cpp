// The `sheave` command: its subcommands, and how it ends.

#include <array>
#include <new>
#include <string>

#include <CLI/CLI.hpp>
#include <sheave_version.h>

#include "scenes/suggestion.h"
#include "tools/command.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

constexpr std::array<Command, 6> commands{{
    {"run", "Simulate a scene; write tables, print a summary", declare_run},
    {"render", "Simulate a scene; write a video or pictures", declare_render},
    {"validate", "Check scenes without running them", declare_validate},
    {"generate", "Write a scene of a given kind and size", declare_generate},
    {"schema", "Print the JSON Schema of scenes", declare_schema},
    {"reference", "Print the reference of the scene format (Markdown)", declare_reference},
}};

/// An unknown subcommand gets a better answer than "unexpected argument".
void check_subcommand(const std::string& word) {
  if (word.empty() || word.front() == '-') return;
  Suggestion suggestion(word);
  for (const Command& command : commands) {
    if (word == command.name) return;
    suggestion.consider(command.name);
  }
  throw Failure(ExitCode::usage, "there is no subcommand \"" + word + "\"" +
                                     suggestion.question() + "\nsee sheave --help");
}

/// The nearest option of the chosen subcommand to the first argument that none understood.
std::string option_hint(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  const std::vector<std::string> rest = app.remaining(true);
  if (chosen.empty() || rest.empty()) return "";
  const std::string word = rest.front().substr(0, rest.front().find('='));
  Suggestion suggestion(word);
  std::vector<std::string> names;
  for (const CLI::Option* option : chosen.front()->get_options()) {
    if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
  }
  for (const std::string& name : names) suggestion.consider(name);
  return suggestion.question();
}

ExitCode dispatch(int argc, char** argv) {
  CLI::App app{"Rigid bodies and cables that run over wheels.", "sheave"};
  app.set_version_flag("--version", std::string("sheave ") + version_string, "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.get_formatter()->column_width(34);
  app.require_subcommand(1);
  app.footer(R"(Example:
  sheave run scenes/paper/simple.json

See sheave SUBCOMMAND --help for options and examples.)");
  std::vector<Action> actions;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.meaning);
    sub->get_formatter()->column_width(34);
    actions.push_back(command.declare(*sub));
  }
  if (argc > 1) check_subcommand(argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return ExitCode::done;
  } catch (const CLI::CallForVersion& version) {
    print(std::string(version.what()) + "\n");
    return ExitCode::done;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string name = chosen.empty() ? "" : chosen.front()->get_name() + " ";
    throw Failure(ExitCode::usage, error.what() + option_hint(app) + "\nsee sheave " + name +
                                       "--help");
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (app.got_subcommand(commands[i].name)) return actions[i]();
  }
  return ExitCode::internal;
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
    print_error(std::string("internal: ") + error.what());
  }
  return ExitCode::internal;
}

}  // namespace
}  // namespace sheave::tools

int main(int argc, char** argv) {
  sheave::tools::ignore_broken_pipes();
  return static_cast<int>(sheave::tools::run_command_line(argc, argv));
}
