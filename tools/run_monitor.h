#pragma once
// What the summary of a run tells about its course, and not only about its end.

#include <cstdint>
#include <vector>

#include "cable/simulation.h"

namespace sheave::tools {

/// Extremes of one cable over a run.
struct CableCourse {
  double length_error = 0.0;  ///< relative error of the length invariant, the largest in size
  double max_stretch = 0.0;   ///< the largest CableReport::max_stretch
  double length = 0.0;        ///< CableReport::total_length at the end [m]
  /// How much longer than allowed all its spans together are at the end, if it is rigid [m].
  double excess = 0.0;
  double excess_at_half = 0.0;  ///< the same after half of the run [m]
  /// The farthest that a body which it is on has moved from where it was at first, or that a wheel's rim has turned [m].
  double way = 0.0;
};

/// Follows a simulation: energy in every step; cables, whose reports cost as much as a solver
/// iteration, in every step of short runs and at about 2000 moments of long ones.
class RunMonitor {
 public:
  /// For a run of so many steps.
  explicit RunMonitor(std::int64_t steps);
  /// To be called at the start and after every step.
  void observe(const Simulation& simulation);
  /// To be called at the end.
  void finish(const Simulation& simulation);

  [[nodiscard]] const Energy& initial_energy() const { return initial_; }
  [[nodiscard]] const Energy& final_energy() const { return final_; }
  /// The largest |total energy - its value at the start| [J].
  [[nodiscard]] double max_energy_drift() const { return max_drift_; }
  /// One per cable.
  [[nodiscard]] const std::vector<CableCourse>& cables() const { return cables_; }

 private:
  void observe_cables(const Simulation& simulation);
  [[nodiscard]] double way_of(const World& world, const LinkReport& link) const;

  std::int64_t stride_;        // steps between looks at the cables
  std::int64_t half_;          // of the steps
  std::int64_t observed_ = 0;  // calls of observe()
  Energy initial_;
  Energy final_;
  double max_drift_ = 0.0;
  std::vector<CableCourse> cables_;
  std::vector<BodyState> start_;  // what observe() saw first
};

}  // namespace sheave::tools
