#include <CLI/CLI.hpp>

#include "command/command_line.h"
#include "command/registry.h"
#include "fuzz/target.h"
#include "scenes/scene.h"

namespace sheave::fuzz {
namespace {

constexpr std::string_view small_scene = R"({
  "format": "sheave-scene/1", "name": "one body", "description": "falls", "duration": 0.1, "gravity": [0, -9.81, 0],
  "bodies": [{"name": "weight", "mass": 1, "shape": {"type": "box", "size": [0.1, 0.2, 0.3]}}]
})";

std::vector<std::string> words_of(Bytes bytes) {
  std::vector<std::string> words{"sheave"};
  words.emplace_back();
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      words.emplace_back();
    } else if (byte != 0) {  // ends a word of a command line
      words.back().push_back(static_cast<char>(byte));
    }
  }
  return words;
}

/// Tries a word as the value of --set.
void try_override(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || word.front() != '/') return;
  const SceneResult scene = load_scene_text(
      small_scene, "small", {{word.substr(0, equals), word.substr(equals + 1), ""}});
  for (const SceneError& error : scene.errors) {
    require(!error.message.empty(), "an override is refused without a message");
  }
  require(scene.errors.empty() == static_cast<bool>(scene),
          "an override is refused without a fault");
}

}  // namespace

void try_command_line(Bytes bytes) {
  const std::vector<std::string> words = words_of(bytes);
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  const command::CommandLine line;
  try {
    static_cast<void>(command::parse_command_line(*line.app, static_cast<int>(arguments.size()),
                                                  arguments.data()));
  } catch (const command::Failure& failure) {
    require(failure.code() == command::ExitCode::usage,
            "a command line is refused as if it were not");
    require(*failure.what() != '\0', "a command line is refused without a message");
  }
  for (const std::string& word : words) try_override(word);
}

}  // namespace sheave::fuzz
