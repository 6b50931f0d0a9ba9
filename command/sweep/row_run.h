#pragma once
// One row of a sweep or of a tune: its scene, its run or search, its measures.

#include <atomic>
#include <string>
#include <vector>

#include "command/sweep/run.h"
#include "command/sweep/table.h"

namespace sheave::command {

/// The scene with the values of a row, one per axis.
[[nodiscard]] SceneOptions with_values(const SweepOptions& options,
                                       const std::vector<std::string>& values);

/// Does the run or the search of a row with `row.values`; a fault is stored in the row. `done` grows
/// by 1 meanwhile. False if a signal ended the row. A Failure (66, 74) if the scene cannot be read.
[[nodiscard]] bool do_row(const SweepOptions& options, SweepRow& row, std::atomic<double>& done);

/// The measures of a machine at its equilibrium, for do_row().
void measure_at_rest(const SweepOptions& options, Scene scene, SweepRow& row);

/// Adds why a measure has no value.
void add_message(SweepRow& row, const std::string& text);

/// Fails before hours of runs if a measure exists neither in the first nor in the last of `points`.
/// Fills in the units. Returns the texts of these two scenes. A Failure: 2 that names `option`, and
/// as of load() if neither scene is valid.
[[nodiscard]] std::vector<std::string> find_measures(
    SweepOptions& options, const std::vector<std::vector<std::string>>& points);

/// The hash of everything that decides the rows.
[[nodiscard]] std::string key_of(const SweepOptions& options,
                                 const std::vector<std::vector<std::string>>& points,
                                 const std::vector<std::string>& scenes);

/// The head of a table, without key and number of runs.
[[nodiscard]] SweepHead head_of(const SweepOptions& options);

}  // namespace sheave::command
