#pragma once
// sheave tune: the settings as a unit cube, and the checks of a task.

#include <span>
#include <string>
#include <vector>

#include "command/tune/tune.h"

namespace sheave::command {

/// The values of all settings as parts of their ranges, in [0, 1] each; in the logarithm for :log.
using Place = std::vector<double>;

/// A Failure (2) if the settings are no ranges, too many, or named twice.
void check_axes(const TuneOptions& options);

/// The texts of the settings at a place.
[[nodiscard]] std::vector<std::string> values_at(const TuneOptions& options,
                                                 std::span<const double> place);

/// The place of --start; the middle of the ranges without it. A Failure (2).
[[nodiscard]] Place start_of(const TuneOptions& options);

/// The method that is asked for, or the one that suits the task. A Failure (2) if it does not.
[[nodiscard]] TuneMethod method_of(const TuneOptions& options);

/// The hash of everything that decides the runs.
[[nodiscard]] std::string key_of_tune(const TuneOptions& options, TuneMethod method,
                                      const Place& start, const std::vector<std::string>& scenes);

}  // namespace sheave::command
