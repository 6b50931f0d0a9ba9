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

/// Evaluates a program; calls `imported` with every imported file.
[[nodiscard]] Evaluation run_program(std::string_view text, const std::string& file_name,
                                     const JsonnetOptions& options, const Limits& limits,
                                     const std::function<void(const Source&)>& imported);

}  // namespace sheave::jsonnet
