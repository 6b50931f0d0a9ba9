#pragma once
// The evaluator of Jsonnet, with imports restricted to their folders.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/jsonnet/evaluate.h"

namespace sheave::jsonnet {

/// The outcome of an evaluation within this process.
struct Evaluation {
  bool good = false;
  std::string text;  ///< the JSON, or Jsonnet's message
};

/// Evaluates a program; calls `imported` with every imported file. `known_function`: an earlier
/// evaluation has shown that the program takes parameters, which costs as much as the evaluation.
[[nodiscard]] Evaluation run_program(std::string_view text, const std::string& file_name,
                                     const JsonnetOptions& options, const Limits& limits,
                                     bool known_function,
                                     const std::function<void(const Source&)>& imported);

}  // namespace sheave::jsonnet
