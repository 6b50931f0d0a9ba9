#pragma once
// Scenes in Jsonnet (https://jsonnet.org): evaluates a program to JSON.

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace sheave::jsonnet {

/// Limits of an evaluation, far above any sensible scene.
struct Limits {
  unsigned stack = 500;   ///< nested calls
  unsigned seconds = 20;  ///< of CPU time
  /// memory in addition to that of the process [bytes]
  std::size_t memory = std::size_t{2} << 30U;
  std::size_t text = std::size_t{64} << 20U;  ///< of the JSON, and of each imported file [bytes]
};

/// A file that the evaluation has read.
struct Source {
  std::string name;  ///< as in error messages
  std::string text;
};

struct Outcome {
  std::string json;                ///< empty if there are errors
  std::vector<SceneError> errors;  ///< located in the source if that is known
  std::vector<Source> sources;     ///< the program first, then its imports
};

/// Whether a file of this name is a program.
[[nodiscard]] inline bool is_program(std::string_view file_name) {
  return file_name.ends_with(".jsonnet");
}
/// Whether this build can evaluate programs.
[[nodiscard]] bool is_available();

/// Evaluates a program. Imports come only from the program's folder (and below), from the built-in
/// library "sheave.libsonnet", and from options.import_folders; symbolic links out of these folders
/// are errors. The evaluation runs in a separate process, so no program can exhaust or end this
/// one.
[[nodiscard]] Outcome evaluate(std::string_view text, const std::string& file_name,
                               const JsonnetOptions& options, const Limits& limits = {});

/// Moves errors that are located in the generated JSON to the source, if the name of the body,
/// joint, cable, ... occurs there only once. The message then contains both places.
void locate(std::vector<SceneError>& errors, const std::string& file_name, const Outcome& made);

}  // namespace sheave::jsonnet
