// The kinds of generated scenes, one line each, and the choice among them by name.

#include <algorithm>

#include <fmt/format.h>

#include "scenes/field_reader.h"
#include "scenes/generators.h"
#include "scenes/json/pointer.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

template <class Options, Result<Scene> (*generate)(const Options&)>
constexpr GeneratorKind kind(std::string_view name, std::string_view meaning) {
  return {name, meaning, &Options::field_table,
          [] { return std::shared_ptr<void>(std::make_shared<Options>()); },
          [](const void* options) { return generate(*static_cast<const Options*>(options)); }};
}

SceneResult failure(std::string_view origin, const Errors& errors) {
  SceneResult result;
  result.status = SceneStatus::invalid;
  for (const Error& error : errors) {
    result.errors.push_back({std::string(origin), 0, 0, error.path, error.message, {}, {}});
  }
  return result;
}

}  // namespace

std::span<const GeneratorKind> generator_kinds() {
  static constexpr std::array kinds{
      kind<WheelTrainOptions, &generate_wheel_train>(
          "wheel-train", "one cable over a row of wheels, with a weight at each end"),
      kind<BlockAndTackleOptions, &generate_block_and_tackle>(
          "block-and-tackle", "a load on several parts of one rope, and the effort at its end"),
      kind<HilbertOptions, &generate_hilbert>(
          "hilbert", "one cable along a Hilbert curve in space, a wheel at every turn, a motor"),
      kind<ChainOptions, &generate_chain>(
          "chain", "rigid links with ball joints and a heavy ball, let go from a straight line"),
      kind<NaiveRopeOptions, &generate_naive_rope>(
          "naive-rope", "a rope as rigid segments over two wheels, or one cable in its place"),
  };
  return kinds;
}

SceneResult generate_scene(std::string_view kind, const std::vector<GeneratorSetting>& settings) {
  const auto kinds = generator_kinds();
  const auto chosen = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const GeneratorKind& k) { return k.name == kind; });
  const std::string origin = fmt::format("generate {}", kind);
  if (chosen == kinds.end()) {
    Suggestion suggestion(kind);
    std::string allowed;
    for (const GeneratorKind& k : kinds) {
      suggestion.consider(k.name);
      allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", k.name);
    }
    return failure("generate", {{"", fmt::format("there is no kind of scene \"{}\"{}; allowed: {}",
                                                 kind, suggestion.question(), allowed)}});
  }
  // Options are read like an object of a scene file, with the same checks and messages.
  const json::Limits limits;
  json::Faults faults(limits.faults);
  json::Document document = json::Document::parse("{}", origin, limits, faults);
  for (const GeneratorSetting& setting : settings) {
    document.set("/" + json::escape(setting.option), setting.value, origin, {}, limits, faults);
  }
  const std::shared_ptr<void> options = chosen->make_options();
  const ObjectFormat format{
      chosen->name, chosen->meaning, false, {{chosen->fields(), nullptr}}, {}, {}, {}};
  FieldReader(document, faults).read_object(document.root(), format, std::array{options.get()});
  Errors errors;
  for (const json::Fault& fault : faults.in_order()) {
    std::string message = fault.value.empty() ? "" : fmt::format("value {}: ", fault.value);
    message += fault.message;
    if (!fault.allowed.empty() && message.find(fault.allowed) == std::string::npos) {
      message += "; allowed: " + fault.allowed;
    }
    errors.push_back({fault.pointer, std::move(message)});
  }
  if (!errors.empty()) return failure(origin, errors);
  const Result<Scene> scene = chosen->generate(options.get());
  if (!scene) return failure(origin, scene.errors());
  return {*scene, {}, SceneStatus::ok};
}

std::string generator_option(std::string_view field) {
  std::string name = "--" + std::string(field);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string generator_comment(std::string_view kind,
                              const std::vector<GeneratorSetting>& settings) {
  std::string text = fmt::format("// sheave generate {}", kind);
  for (const GeneratorSetting& setting : settings) {
    text += fmt::format(" {} {}", generator_option(setting.option), setting.value);
  }
  return text + "\n";
}

}  // namespace sheave
