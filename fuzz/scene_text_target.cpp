#include <algorithm>

#include "cable/simulation.h"
#include "fuzz/target.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_compare.h"

namespace sheave::fuzz {
namespace {

/// The bytes of each line of a text, divided by the loader's rules for line ends.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (true) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

void check_place(const SceneError& error, const std::vector<std::string_view>& lines) {
  require(!error.message.empty(), "a fault without a message");
  const std::string told = to_string(error);
  require(error.line >= 1 && error.column >= 1, "a fault without a place: " + told);
  const auto line = static_cast<std::size_t>(error.line);
  require(line <= lines.size(), "a fault behind the last line: " + told);
  // A missing part is reported behind the last character.
  require(static_cast<std::size_t>(error.column) <= lines[line - 1].size() + 1,
          "a fault behind the end of its line: " + told);
}

}  // namespace

void try_scene_text(Bytes bytes) {
  const std::string text(bytes.begin(), bytes.end());
  const SceneResult scene = load_scene_text(text, "fuzzed");
  if (!scene) {
    require(!scene.errors.empty(), "refused without a fault");
    require(scene.status == SceneStatus::invalid,
            "a text that does not load is not called invalid");
    const std::vector<std::string_view> lines = lines_of(text);
    for (const SceneError& error : scene.errors) check_place(error, lines);
    return;
  }
  require(scene.errors.empty(), "loaded with a fault");
  require(Simulation::check(scene->model, scene->cables).empty(),
          "a scene that loads does not build");
  const SceneResult again = load_scene_text(write_scene(*scene), "written");
  if (!again) throw BrokenPromise("not loaded again: " + to_string(again.errors.front()));
  const std::string difference = test::difference(*scene, *again);
  require(difference.empty(), "not the same when loaded again: " + difference);
}

}  // namespace sheave::fuzz
