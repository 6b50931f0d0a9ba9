#pragma once
// Load cases of the command line: --case and --cases.

#include <string>
#include <vector>

#include "command/input/case_table.h"
#include "command/scene_options.h"

namespace sheave::command {

struct CaseOptions {
  std::vector<std::string> cases;  ///< of --case, as given
  std::string table;               ///< of --cases

  [[nodiscard]] bool empty() const { return cases.empty() && table.empty(); }
};

/// Adds --case, which may be repeated, and --cases. To be called before add_scene_options(), which
/// adds a --case for one case to commands without this one.
void add_case_options(CLI::App& app, CaseOptions& options);

/// Parses "NAME:/pointer=value;parameter=value". A Failure (2) names the fault.
[[nodiscard]] LoadCase parse_case(const std::string& text);
/// The cases of --case, then those of --cases. A Failure (2) if two have one name; that of
/// read_cases().
[[nodiscard]] std::vector<LoadCase> load_cases(const CaseOptions& options);
/// Adds the settings of a case to those of the scene; the last setting of a pointer counts.
void apply_case(const LoadCase& one, SceneOptions& scene);

}  // namespace sheave::command
