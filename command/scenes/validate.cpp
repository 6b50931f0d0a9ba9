// sheave validate: check scenes without running them.

#include <algorithm>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command/input/file.h"
#include "command/registry.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "scenes/json/document.h"
#include "scenes/jsonnet/evaluate.h"
#include "scenes/start_warnings.h"

namespace sheave::command {
namespace {

struct ValidateOptions {
  std::vector<std::string> paths;
  SceneOptions jsonnet;  ///< parameters and imports of the scenes in Jsonnet
  bool json = false;
  bool made = false;
};

// Keeps the keys in order.
using ValidateJson = nlohmann::ordered_json;

ValidateJson text_or_null(const std::string& text) {
  return text.empty() ? ValidateJson() : ValidateJson(text);
}
ValidateJson place_or_null(int place) { return place > 0 ? ValidateJson(place) : ValidateJson(); }

ValidateJson faults_json(const std::vector<SceneError>& errors) {
  ValidateJson list = ValidateJson::array();
  for (const SceneError& error : errors) {
    list.push_back({{"code", code_name(error.code)},
                    {"severity", "error"},
                    {"pointer", error.pointer},
                    {"line", place_or_null(error.line)},
                    {"column", place_or_null(error.column)},
                    {"value", text_or_null(error.value)},
                    {"allowed", text_or_null(error.allowed)},
                    {"message", error.message}});
  }
  return list;
}

/// The document in which a warning's setting is located; nullopt for standard input, which cannot
/// be read twice.
std::optional<json::Document> document_of(const std::string& path) {
  if (path == "-") return {};
  json::Faults faults;
  const json::Limits limits;
  json::Document document =
      json::Document::parse(read_input(path, limits.bytes), path, limits, faults);
  if (document.root() == json::no_node) return {};
  return document;
}

ValidateJson warnings_json(const std::string& path, const std::vector<Warning>& warnings) {
  ValidateJson list = ValidateJson::array();
  if (warnings.empty()) return list;
  const std::optional<json::Document> document = document_of(path);
  for (const Warning& warning : warnings) {
    ValidateJson line;
    ValidateJson column;
    ValidateJson value;
    const bool located = document && warning.subject.starts_with('/');
    const auto target = located ? document->find(warning.subject) : json::Document::Target{};
    if (target.exact) {
      const json::Location place = document->location(document->offset(target.node));
      line = place.line;
      column = place.column;
      value = document->excerpt(target.node);
    }
    std::string code = warning.kind;
    std::replace(code.begin(), code.end(), '_', '-');
    list.push_back({{"code", code},
                    {"severity", "warning"},
                    {"pointer", warning.subject},
                    {"line", line},
                    {"column", column},
                    {"value", value},
                    {"allowed", ValidateJson()},
                    {"message", warning.message}});
  }
  return list;
}

/// The result for one scene as JSON.
ValidateJson scene_json(const std::string& path, const SceneResult& result) {
  return {{"path", path},
          {"valid", static_cast<bool>(result)},
          {"faults", faults_json(result.errors)},
          {"warnings", result ? warnings_json(path, scene_warnings(*result))
                              : ValidateJson(ValidateJson::array())}};
}

ExitCode validate_json(const ValidateOptions& options) {
  const JsonnetOptions jsonnet = jsonnet_options(options.jsonnet);
  ExitCode code = ExitCode::done;
  ValidateJson scenes = ValidateJson::array();
  for (const std::string& path : options.paths) {
    const SceneResult result = load_file_or_stdin(path, {}, jsonnet);
    scenes.push_back(scene_json(path, result));
    if (!result && code != ExitCode::bad_scene) code = exit_code(result);
  }
  const ValidateJson object{{"format", "sheave-validation/1"}, {"scenes", std::move(scenes)}};
  // File names need not be UTF-8.
  print(showable_json(object.dump(-1, ' ', false, ValidateJson::error_handler_t::replace)) + "\n");
  return code;
}

/// Prints the scenes that Jsonnet programs generate, whether or not they are valid.
ExitCode print_made(const ValidateOptions& options) {
  ExitCode code = ExitCode::done;
  for (const std::string& path : options.paths) {
    if (!jsonnet::is_program(path)) {
      throw Failure(ExitCode::usage, path + ": --made is for scenes in Jsonnet (.jsonnet)");
    }
    const std::string text = read_input(path, json::Limits{}.bytes);
    const jsonnet::Outcome made = jsonnet::evaluate(text, path, jsonnet_options(options.jsonnet));
    if (made.errors.empty()) {
      print(showable_json(made.json));
      continue;
    }
    print_error(to_text(SceneResult{{}, made.errors, SceneStatus::invalid}));
    code = ExitCode::bad_scene;
  }
  return code;
}

ExitCode validate(const ValidateOptions& options) {
  const JsonnetOptions jsonnet = jsonnet_options(options.jsonnet);
  ExitCode code = ExitCode::done;
  for (const std::string& path : options.paths) {
    const SceneResult result = load_file_or_stdin(path, {}, jsonnet);
    if (result) {
      print(printable(path + ": ok\n"));
      if (!result.notice.empty()) print_warning(printable_line(path + ": " + result.notice));
      for (const Warning& warning : scene_warnings(*result)) {
        print_warning(path + ": " + warning.message);
      }
      continue;
    }
    print_error(to_text(result));
    // A fault of a scene takes precedence over a file that could not be read.
    if (code != ExitCode::bad_scene) code = exit_code(result);
  }
  return code;
}

}  // namespace

Action declare_validate(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  app.add_option("scenes", options->paths, "Scene files; - reads standard input")
      ->required()
      ->option_text("SCENE...");
  app.add_flag("--json", options->json,
               "print one JSON object with all faults and warnings of each scene; their codes "
               "never change meaning (scenes/REFERENCE.md)");
  add_jsonnet_options(app, options->jsonnet);
  app.add_flag("--made", options->made, "only print the JSON that a scene in Jsonnet produces");
  app.footer(R"(Examples:
  sheave validate crane.json
  sheave validate scenes/*/*.json

Prints "ok" for each valid scene, and its warnings on standard error. For any other scene it prints
all faults, each with file, line, column and JSON pointer. Exit codes: 0 all scenes are valid, 65 a
scene is not valid, 66 no such file, 74 a file cannot be read.)");
  return [options] {
    if (options->made) return print_made(*options);
    return options->json ? validate_json(*options) : validate(*options);
  };
}

}  // namespace sheave::command
