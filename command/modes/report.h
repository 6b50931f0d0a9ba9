#pragma once
// The results of `sheave modes` as text, JSON and NPY.

#include <optional>
#include <string>
#include <vector>

#include "statics/equilibrium.h"
#include "statics/modes.h"

namespace sheave::command {

struct ModesFound {
  std::string name;  ///< of the load case; empty: none
  std::string scene;
  std::optional<Equilibrium> rest;  ///< empty: linearised about the given pose
  Modes modes;
  std::vector<std::string> freedoms;
  std::vector<std::string> motions;  ///< largest_motion() of each mode
  std::vector<std::string> bodies;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  Eigen::MatrixXd output_matrix;  ///< C of y = C x, outputs x states
};

/// Linear outputs by finite differences of the observables. A Failure (2) if one does not exist.
void take_outputs(Simulation& simulation, const std::vector<std::string>& names, ModesFound& found);
/// NAME.M.npy, .D.npy, .K.npy, .Z.npy, .A.npy, .B.npy, .C.npy
void write_matrices(const std::string& name, const ModesFound& found);
[[nodiscard]] std::string modes_text(const ModesFound& found, std::size_t count);
/// A row of frequencies for each load case: the first `count` modes.
[[nodiscard]] std::string modes_table(const std::vector<ModesFound>& cases, std::size_t count);
[[nodiscard]] std::string modes_json(const std::string& path, const ModesFound& found);
/// {"format", "scene", "cases": [...]} with the objects of modes_json().
[[nodiscard]] std::string modes_cases_json(const std::string& path,
                                           const std::vector<ModesFound>& cases);

}  // namespace sheave::command
