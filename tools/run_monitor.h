#pragma once
// What the summary of a run tells about its course, and not only about its end.

#include <vector>

#include "cable/simulation.h"

namespace sheave::tools {

/// Extremes of one cable over a run.
struct CableCourse {
  double length_error = 0.0;  ///< relative error of the length invariant that was largest in size
  double max_stretch = 0.0;   ///< the largest CableReport::max_stretch
};

/// Follows a simulation.
class RunMonitor {
 public:
  /// To be called at the start and after every step.
  void observe(const Simulation& simulation);

  [[nodiscard]] const Energy& initial_energy() const { return initial_; }
  [[nodiscard]] const Energy& final_energy() const { return final_; }
  /// The largest |total energy - its value at the start| [J].
  [[nodiscard]] double max_energy_drift() const { return max_drift_; }
  /// One per cable.
  [[nodiscard]] const std::vector<CableCourse>& cables() const { return cables_; }

 private:
  bool started_ = false;
  Energy initial_;
  Energy final_;
  double max_drift_ = 0.0;
  std::vector<CableCourse> cables_;
};

}  // namespace sheave::tools
