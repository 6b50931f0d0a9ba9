// sheave generate: scenes made by rules. Kinds and their options come from scenes/generators.h.

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/output/file.h"
#include "command/registry.h"
#include "command/terminal.h"
#include "engine/field_check.h"
#include "scenes/format.h"
#include "scenes/generators.h"

namespace sheave::command {
namespace {

/// The options of one kind as given by the user.
struct KindOptions {
  std::string_view kind;
  std::vector<std::string> values;  // one per field of the kind; empty: not given
  std::string out = "-";
};

std::string default_text(const FieldSlot& slot) {
  if (const auto* real = std::get_if<double*>(&slot)) return number_text(**real);
  if (const auto* integer = std::get_if<int*>(&slot)) return fmt::format("{}", **integer);
  return "";
}

std::string meaning(const Field& field, void* options) {
  const FieldSlot slot = field.slot(options);
  std::string text = fmt::format("{}: {}", field.meaning, describe(field, slot));
  const std::string standard = default_text(slot);
  if (!standard.empty()) text += ", default " + standard;
  return text;
}

ExitCode generate(const KindOptions& options, const GeneratorKind& kind) {
  std::vector<GeneratorSetting> settings;
  for (std::size_t i = 0; i < options.values.size(); ++i) {
    if (options.values[i].empty()) continue;
    settings.push_back({std::string(kind.fields()[i].name), options.values[i]});
  }
  const SceneResult result = generate_scene(kind.name, settings);
  if (!result) {
    std::string text;
    for (const SceneError& error : result.errors) {
      if (!text.empty()) text += '\n';
      text +=
          error.pointer.empty()
              ? ""
              : generator_option(error.pointer.substr(error.pointer.front() == '/' ? 1 : 0)) + ": ";
      if (!error.value.empty()) text += "value " + error.value + ": ";
      text += error.message;
    }
    throw Failure(ExitCode::usage, text);
  }
  const std::string text = generator_comment(options.kind, settings) + write_scene(*result);
  if (options.out == "-") {
    print(text);
  } else {
    write_file(options.out, text);
  }
  return ExitCode::done;
}

std::shared_ptr<KindOptions> declare_kind(CLI::App& app, const GeneratorKind& kind) {
  auto options = std::make_shared<KindOptions>();
  options->kind = kind.name;
  CLI::App* sub = app.add_subcommand(std::string(kind.name), std::string(kind.meaning));
  const std::shared_ptr<void> defaults = kind.make_options();
  options->values.resize(kind.fields().size());
  for (std::size_t i = 0; i < kind.fields().size(); ++i) {
    const Field& field = kind.fields()[i];
    sub->add_option(generator_option(field.name), options->values[i],
                    meaning(field, defaults.get()))
        ->option_text("X");
  }
  sub->add_option("-o,--out", options->out, "file to write; default: standard output")
      ->option_text("FILE");
  return options;
}

}  // namespace

Action declare_generate(CLI::App& app) {
  app.require_subcommand(1);
  app.footer(R"(Examples:
  sheave generate wheel-train --wheels 64 --out train.json
  sheave generate block-and-tackle --parts 6 | sheave run - --check
  sheave generate hilbert --order 3 | sheave render - --still hilbert.png --at 1

See sheave generate KIND --help for the options of each kind.)");
  std::vector<std::shared_ptr<KindOptions>> all;
  for (const GeneratorKind& kind : generator_kinds()) all.push_back(declare_kind(app, kind));
  return [&app, all] {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (app.got_subcommand(std::string(all[i]->kind))) {
        return generate(*all[i], generator_kinds()[i]);
      }
    }
    return ExitCode::internal;
  };
}

}  // namespace sheave::command
