// sheave schema and sheave reference: the scene format, for programs and for people.

#include <CLI/CLI.hpp>

#include "command/registry.h"
#include "command/terminal.h"
#include "scenes/scene.h"

namespace sheave::command {
namespace {

/// `text` with one line break at its end.
std::string line(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

}  // namespace

Action declare_schema(CLI::App& app) {
  app.footer(R"(Example:
  sheave schema > sheave-scene.schema.json

Editors that know JSON Schema (draft-07) then complete and check scenes while they are written.)");
  return [] {
    print(line(scene_schema()));
    return ExitCode::done;
  };
}

Action declare_reference(CLI::App& app) {
  app.footer(R"(Example:
  sheave reference > scene-format.md

Every key of a scene with its unit, allowed values, default and meaning.)");
  return [] {
    print(line(scene_reference()));
    return ExitCode::done;
  };
}

}  // namespace sheave::command
