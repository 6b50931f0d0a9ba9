// Maps positions in the generated JSON to positions in the source.

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/jsonnet/evaluate.h"

namespace sheave::jsonnet {
namespace {

using Json = nlohmann::json;

/// The name of the innermost named object on the path to `pointer`; empty if there is none.
std::string innermost_name(const Json& root, const std::string& pointer) {
  std::string name;
  const Json* node = &root;
  std::size_t at = 0;
  while (node != nullptr && at < pointer.size()) {
    const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
    const std::string step = pointer.substr(at + 1, end - at - 1);
    at = end;
    if (node->is_array()) {
      const bool digits = !step.empty() && step.find_first_not_of("0123456789") == step.npos;
      const std::size_t index = digits && step.size() < 10 ? std::stoul(step) : node->size();
      node = index < node->size() ? &(*node)[index] : nullptr;
    } else {
      node = node->is_object() && node->contains(step) ? &(*node)[step] : nullptr;
    }
    if (node == nullptr || !node->is_object() || !node->contains("name")) continue;
    if (const Json& found = (*node)["name"]; found.is_string()) name = found.get<std::string>();
  }
  return name;
}

struct Place {
  const Source* source = nullptr;
  std::size_t offset = 0;
};

/// Position of the name as a separate string, if there is only one.
Place only_place(const std::vector<Source>& sources, const std::string& name) {
  Place place;
  for (const Source& source : sources) {
    for (const char quote : {'"', '\''}) {
      const std::string literal = quote + name + quote;
      for (std::size_t at = source.text.find(literal); at != std::string::npos;
           at = source.text.find(literal, at + 1)) {
        if (place.source != nullptr) return {};
        place = {&source, at};
      }
    }
  }
  return place;
}

}  // namespace

void locate(std::vector<SceneError>& errors, const std::string& file_name, const Outcome& made) {
  const Json root = Json::parse(made.json, nullptr, false);
  for (SceneError& error : errors) {
    if (error.file != file_name || error.line == 0) continue;
    const std::string name = root.is_discarded() ? "" : innermost_name(root, error.pointer);
    const Place place = name.empty() ? Place{} : only_place(made.sources, name);
    if (place.source == nullptr) {
      error.file += " (made JSON)";
      continue;
    }
    error.message += fmt::format(" (made JSON: line {}, column {})", error.line, error.column);
    error.file = place.source->name;
    const std::string before = place.source->text.substr(0, place.offset);
    error.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    error.column = 1;
    for (std::size_t i = before.rfind('\n') + 1; i < before.size(); ++i) {
      // Counts characters, not bytes.
      if ((static_cast<unsigned char>(before[i]) & 0xc0U) != 0x80U) ++error.column;
    }
  }
}

}  // namespace sheave::jsonnet
