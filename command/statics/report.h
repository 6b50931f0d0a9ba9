#pragma once
// The results of `sheave statics` as text and as JSON.

#include <memory>
#include <string>
#include <vector>

#include "command/scene_options.h"
#include "engine/joint_report.h"
#include "statics/equilibrium.h"
#include "statics/supports.h"

namespace sheave::command {

/// One load case.
struct StaticsCase {
  std::string name;  ///< empty: the scene without changes
  SceneOptions scene;
  bool tells_loads = true;  ///< warns of loads over time, which no rest has
};

struct StaticsResult {
  std::string name;
  std::string scene;  ///< its name
  Equilibrium rest;
  State state;
  std::vector<std::string> bodies;
  std::shared_ptr<const Simulation> simulation;  ///< at the equilibrium; reports refer to its names
  std::vector<CableReport> cables;
  std::vector<JointReport> joints;
  std::vector<SupportReaction> supports;
  std::vector<std::string> quantities;
  std::vector<std::string> units;  ///< of the quantities; empty: a pure number
  /// Values of the quantities; NaN where statics does not determine one.
  std::vector<double> values;
  bool cable_friction = false;  ///< a cable has links with friction or losses
  /// Whether friction leaves forces open within bounds.
  [[nodiscard]] bool is_open() const { return rest.friction_holds || cable_friction; }
};

/// Loads the scene and finds its equilibrium. A Failure (2) if a quantity does not exist.
[[nodiscard]] StaticsResult find_rest(const StaticsCase& one, const EquilibriumSettings& settings,
                                      const std::vector<std::string>& quantities);
/// One equilibrium in full, with its quantities if requested, or a table of cases.
[[nodiscard]] std::string statics_text(const std::vector<StaticsResult>& results, bool quantities);
[[nodiscard]] std::string statics_json(const std::string& path,
                                       const std::vector<StaticsResult>& results);

}  // namespace sheave::command
