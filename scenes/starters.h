#pragma once
// Scenes to begin with: machines of the library of parts with comments, for `sheave new`.

#include <span>
#include <string_view>

namespace sheave {

/// A scene in Jsonnet, ready to run.
struct Starter {
  std::string_view name;     ///< "crane"
  std::string_view meaning;  ///< one line for the help
  std::string_view text;     ///< the program, with comments
};

/// All of them, in the order of the help. The texts are the files of scenes/starters/.
[[nodiscard]] std::span<const Starter> starters();

}  // namespace sheave
