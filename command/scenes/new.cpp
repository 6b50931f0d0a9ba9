// sheave new: a scene to begin with. The scenes are those of scenes/starters.h.

#include <filesystem>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/failure.h"
#include "command/output/file.h"
#include "command/registry.h"
#include "command/terminal.h"
#include "scenes/starters.h"

namespace sheave::command {
namespace {

ExitCode write_starter(const Starter& starter, const std::string& out) {
  if (out == "-") {
    print(starter.text);
    return ExitCode::done;
  }
  if (std::filesystem::path(out).extension() != ".jsonnet") {
    throw Failure(ExitCode::usage,
                  fmt::format("--out {}: the scene is a program in Jsonnet; give a "
                              "name that ends with .jsonnet",
                              out));
  }
  std::error_code code;
  if (std::filesystem::exists(out, code)) {
    throw Failure(ExitCode::io, out + ": exists, and may have been edited; choose another name");
  }
  write_file(out, starter.text);
  print_note(fmt::format("{} is ready; sheave run {} --check runs it", out, out));
  return ExitCode::done;
}

}  // namespace

Action declare_new(CLI::App& app) {
  app.require_subcommand(1);
  app.footer(R"(Examples:
  sheave new crane -o crane.jsonnet
  sheave new elevator --out elevator.jsonnet && sheave run elevator.jsonnet --check

The scene is a program in Jsonnet with comments, and has parameters: sheave run crane.jsonnet --param
load=2000.)");
  auto out = std::make_shared<std::string>("-");
  for (const Starter& starter : starters()) {
    CLI::App* sub = app.add_subcommand(std::string(starter.name), std::string(starter.meaning));
    sub->add_option("-o,--out", *out, "file to write; default: standard output")
        ->option_text("FILE");
  }
  return [&app, out] {
    for (const Starter& starter : starters()) {
      if (app.got_subcommand(std::string(starter.name))) return write_starter(starter, *out);
    }
    return ExitCode::internal;
  };
}

}  // namespace sheave::command
