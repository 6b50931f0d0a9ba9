// The interface of imports: which text is a model, reports, places of errors.

#include "scenes/import/import.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/import/caspr/reader.h"
#include "scenes/import/log.h"
#include "scenes/import/mjcf/reader.h"
#include "scenes/import/mjcf/scene.h"
#include "scenes/import/opensim/reader.h"
#include "scenes/import/urdf/reader.h"
#include "scenes/import/xml.h"
#include "scenes/json/pretty.h"

namespace sheave::import {
namespace {

std::size_t count(const Outcome& made, Taken kind) {
  return static_cast<std::size_t>(std::count_if(
      made.notes.begin(), made.notes.end(), [&](const Note& note) { return note.taken == kind; }));
}

std::string elements(std::size_t number) {
  return fmt::format("{} element{}", number, number == 1 ? "" : "s");
}

/// Sets the place of an error to the element from which the part at its pointer was made.
void move_to_element(SceneError& error, const Outcome& made) {
  const Origin* best = nullptr;
  for (const Origin& origin : made.origins) {
    const std::string_view pointer = origin.pointer;
    if (!error.pointer.starts_with(pointer)) continue;
    if (error.pointer.size() > pointer.size() && error.pointer[pointer.size()] != '/') continue;
    if (best == nullptr || pointer.size() > best->pointer.size()) best = &origin;
  }
  error.line = best == nullptr ? 1 : best->line;
  error.column = 1;
  if (best != nullptr) error.file = best->file;
}

/// The pointer of the first number that is not finite; empty if all are.
std::string first_overflow(const mjcf::Json& value, const std::string& pointer) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) return pointer;
  if (!value.is_structured()) return {};
  for (const auto& [key, part] : value.items()) {
    std::string found = first_overflow(part, pointer + "/" + key);
    if (!found.empty()) return found;
  }
  return {};
}

/// The model by the format of its first element; none if the format is not known.
std::optional<mjcf::Model> read_any(const xml::Element& root, const Options& options, Log& log) {
  if (root.tag == "mujoco") return mjcf::read_model(root, log, options.folder);
  if (root.tag == "robot") return urdf::read_model(root, log, options.folder);
  if (root.tag == "OpenSimDocument") return opensim::read_model(root, log);
  return {};
}

}  // namespace

bool is_model(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '<';
}

Outcome import_model(std::string_view text, const std::string& file_name, const Options& options,
                     const Limits& limits) {
  const xml::Tree tree = xml::parse(text, file_name, limits, options.folder);
  if (tree.fault) return {{}, {*tree.fault}, {}, {}};
  Log log(limits);
  const xml::Element& root = *tree.root;
  xml::Tree other;  // its elements must live as long as the model
  if (caspr::is_part(root)) {
    other = caspr::other_part(root, file_name, options, limits);
    if (other.fault) return {{}, {*other.fault}, {}, {}};
  }
  std::optional<mjcf::Model> read =
      other.root ? caspr::read_model(root, *other.root, log) : read_any(root, options, log);
  if (!read) {
    log.error(root,
              "no model that is known here: the first element of a model is <mujoco> in MJCF, "
              "<robot> in URDF, <OpenSimDocument> in OpenSim, <bodies_system> or <cables> in "
              "CASPR",
              {}, FaultCode::unknown_choice);
    return log.take();
  }
  mjcf::Model& model = *read;
  if (!log.failed()) mjcf::mend_masses(options, model, log);
  if (log.failed()) return log.take();
  const mjcf::Json scene = mjcf::scene_of(std::move(model), options, file_name, log);
  Outcome made = log.take();
  if (!made.errors.empty()) return made;
  const std::string pointer = first_overflow(scene, "");
  if (pointer.empty()) {
    made.json = json::pretty(scene);
    return made;
  }
  made.errors.push_back({file_name,
                         1,
                         1,
                         pointer,
                         "the numbers of the model are so large that a number of the scene is not "
                         "finite; give smaller ones",
                         {},
                         {},
                         FaultCode::number_range});
  move_to_element(made.errors.back(), made);
  return made;
}

std::string summary(const Outcome& made) {
  return fmt::format("{} taken as they are, {} with another meaning, {} skipped",
                     elements(count(made, Taken::same)), count(made, Taken::changed),
                     count(made, Taken::skipped));
}

std::string notice(const Outcome& made, const std::string& file_name) {
  const std::size_t changed = count(made, Taken::changed);
  const std::size_t skipped = count(made, Taken::skipped);
  if (changed + skipped == 0) return {};
  return fmt::format(
      "{} of the model skipped, {} taken with another meaning; `sheave import {} --report` lists "
      "them",
      elements(skipped), changed, file_name);
}

std::string report(const Outcome& made) {
  static constexpr std::array<std::pair<Taken, std::string_view>, 3> groups{
      {{Taken::skipped, "skipped"},
       {Taken::changed, "taken with another meaning"},
       {Taken::same, "taken as they are"}}};
  std::string text;
  for (const auto& [kind, heading] : groups) {
    if (count(made, kind) == 0) continue;
    text += fmt::format("{}:\n", heading);
    for (const Note& note : made.notes) {
      if (note.taken != kind) continue;
      text += fmt::format("  {}:{}: {}: {}\n", note.file, note.line, note.element, note.text);
    }
  }
  return text + summary(made) + "\n";
}

void locate(std::vector<SceneError>& errors, const std::string& file_name, const Outcome& made) {
  for (SceneError& error : errors) {
    if (error.file != file_name || error.line == 0) continue;
    error.message += fmt::format(" (made scene: line {}, column {})", error.line, error.column);
    move_to_element(error, made);
  }
}

}  // namespace sheave::import
