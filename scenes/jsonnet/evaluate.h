#pragma once
// Scenes in Jsonnet (https://jsonnet.org): from a program to JSON.

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace sheave::jsonnet {

/// Bounds on an evaluation, far above any sensible scene.
struct Limits {
  unsigned stack = 500;                        ///< nested calls
  unsigned seconds = 20;                       ///< of CPU time
  std::size_t memory = std::size_t{2} << 30U;  ///< more than the process has [bytes]
  std::size_t text = std::size_t{64} << 20U;   ///< of the JSON, and of each imported file [bytes]
};

/// One file that took part.
struct Source {
  std::string name;  ///< as errors call it
  std::string text;
};

struct Outcome {
  std::string json;                ///< empty if there are errors
  std::vector<SceneError> errors;  ///< located in the source where that is known
  std::vector<Source> sources;     ///< the program first, then what it imports
};

/// Whether a file of this name is a program.
[[nodiscard]] inline bool is_program(std::string_view file_name) {
  return file_name.ends_with(".jsonnet");
}
/// Whether this build can evaluate programs.
[[nodiscard]] bool is_available();

/// Evaluates a program. Imports come from the program's folder (and below), from the library
/// "sheave.libsonnet", which is built in, and from options.import_folders, and from nowhere else;
/// symbolic links that leave these folders are refused. Runs in a process of its own, so that no
/// program can exhaust or end this one.
[[nodiscard]] Outcome evaluate(std::string_view text, const std::string& file_name,
                               const JsonnetOptions& options, const Limits& limits = {});

/// Moves errors that are located in the made JSON to the source: to the one place where the name of
/// the body, joint, cable, ... is written, if there is only one. Both places are told.
void locate(std::vector<SceneError>& errors, const std::string& file_name, const Outcome& made);

}  // namespace sheave::jsonnet
