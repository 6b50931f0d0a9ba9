#pragma once
// The load history of the ropes of a run, as a JSON file (docs/explanation/ropes.md).

#include <optional>
#include <string>

#include "measure/rope_history.h"

namespace sheave::command {

/// Options of `sheave run` as given by the user.
struct RopeHistoryOptions {
  std::string path;  ///< empty: no history is kept
  int sections = 100;
  std::optional<double> diameter;  ///< of the ropes, for the ratio D/d [m]
};

/// The observer of the run; nullopt if no history is kept.
[[nodiscard]] inline std::optional<measure::RopeHistory> watch_ropes(
    const RopeHistoryOptions& options) {
  if (options.path.empty()) return {};
  return measure::RopeHistory(options.sections);
}

/// Writes the whole file at once; a Failure (74) if it cannot be written.
void write_rope_history(const RopeHistoryOptions& options, const measure::RopeHistory& history);

}  // namespace sheave::command
