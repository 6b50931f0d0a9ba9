#pragma once
// Quantities of the muscles of a simulation, for ObservableSet.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "scenes/control/load.h"

namespace sheave {

class SceneSupervisor;

/// Names of the muscles among the loads of a scene, in their order.
[[nodiscard]] std::vector<std::string> muscle_names(
    std::span<const std::shared_ptr<const LoadDef>> loads);
/// The same for a simulation; empty if no scene's supervisor acts in it.
[[nodiscard]] std::vector<std::string> muscle_names(const Simulation& simulation);

/// Evaluates quantities of muscles at one moment. `muscle` is an index in muscle_names(). A muscle
/// that the simulation does not have gives NaN.
class MuscleSampler {
 public:
  explicit MuscleSampler(const Simulation& simulation) : simulation_(simulation) {}

  /// The quantity of this index in muscle_quantities.
  [[nodiscard]] double value(int muscle, int quantity);
  /// The quantity of this index in fibre_quantities; NaN when the cable of the muscle is cut.
  /// `cables` are the reports of this moment.
  [[nodiscard]] double fibre(int muscle, int quantity, std::span<const CableReport> cables) const;

 private:
  const Simulation& simulation_;
  std::vector<MuscleState> states_;  // found at the first use
};

}  // namespace sheave
