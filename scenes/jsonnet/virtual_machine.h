#pragma once
// Jsonnet's own evaluator, with imports that cannot leave their folders.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/jsonnet/evaluate.h"

namespace sheave::jsonnet {

/// The outcome of one evaluation, within this process.
struct Evaluation {
  bool good = false;
  std::string text;  ///< the JSON, or what Jsonnet says of the fault
};

/// Evaluates; `imported` is told every file that is imported.
[[nodiscard]] Evaluation run_program(std::string_view text, const std::string& file_name,
                                     const JsonnetOptions& options, const Limits& limits,
                                     const std::function<void(const Source&)>& imported);

}  // namespace sheave::jsonnet
