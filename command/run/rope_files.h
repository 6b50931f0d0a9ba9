#pragma once
// The load history of the ropes of a run as files (docs/explanation/ropes.md), and their life by
// formulas of the user.

#include <optional>
#include <string>
#include <vector>

#include "command/output/faults.h"
#include "command/output/paths.h"
#include "measure/rope_history.h"

namespace sheave::command {

inline constexpr int default_rope_sections = 100;

/// Options of `sheave run` as given by the user.
struct RopeOptions {
  std::vector<std::string> files;  ///< of the history: .csv is a table, all others are JSON
  std::string chart;               ///< .png, .svg or .pdf; empty: none
  std::string life;                ///< file of formulas; empty: none
  std::optional<int> sections;     ///< of each cable; default_rope_sections
  std::optional<double> diameter;  ///< of the ropes, for the ratio D/d [m]

  /// Whether a history is kept.
  [[nodiscard]] bool wanted() const { return !files.empty() || !chart.empty() || !life.empty(); }
};

/// Throws a Failure (2) if the options do not fit together. Appends the files.
void check_rope_options(const RopeOptions& options, std::vector<NamedPath>& inputs,
                        std::vector<NamedPath>& outputs);

/// The observer of the run; nullopt if no history is kept. A Failure (65, 66, 74) if the file of
/// formulas cannot be used.
[[nodiscard]] std::optional<measure::RopeHistory> watch_ropes(const RopeOptions& options);

/// Formulas of a file (docs/explanation/ropes.md). A Failure: 65 with all faults, 66, 74.
[[nodiscard]] measure::RopeLife read_rope_life(const std::string& path, double rope_diameter);

/// Writes all files of the options, each as a whole; `title` stands above the chart.
void write_rope_files(const RopeOptions& options, const std::vector<measure::CableHistory>& cables,
                      const std::string& title, OutputFaults& faults);

/// One file each. A Failure (74) if it cannot be written.
void write_rope_json(const std::string& path, const RopeOptions& options,
                     const std::vector<measure::CableHistory>& histories);
/// A line for each section of each cable that was followed.
void write_rope_table(const std::string& path, const RopeOptions& options,
                      const std::vector<measure::CableHistory>& cables);
/// Bends, tensions and damage along each cable.
void draw_rope_chart(const RopeOptions& options, const std::vector<measure::CableHistory>& cables,
                     const std::string& title);

}  // namespace sheave::command
