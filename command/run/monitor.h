#pragma once
// What the summary of a run tells about its course, and not only about its end.

#include <array>
#include <cstdint>
#include <vector>

#include "cable/certificate/integrator_loss.h"
#include "cable/simulation.h"
#include "command/run/simulate.h"

namespace sheave::command {

/// Extremes of one cable over a run.
struct CableCourse {
  double length_error = 0.0;  ///< relative error of the length invariant, the largest in size
  double max_stretch = 0.0;   ///< the largest CableReport::max_stretch
  double max_strain = 0.0;    ///< the largest CableReport::max_strain
  double length = 0.0;        ///< CableReport::total_length at the end [m]
  /// How much longer than allowed all its spans together are at the end, if it is rigid [m].
  double excess = 0.0;
  // In the first and in the second half of the run:
  std::array<double, 2> stretching{};  ///< by how much that has changed, to and fro all in all [m]
  /// The way of the body on it that has moved farthest at each time, or of a wheel's rim [m].
  std::array<double, 2> way{};
};

/// The worst of one joint over a run.
struct JointCourse {
  double error = 0.0;             ///< the largest JointReport::error [m]
  double error_time = 0.0;        ///< and when [s]
  double angle_error = 0.0;       ///< the largest JointReport::angle_error [rad]
  double angle_error_time = 0.0;  ///< [s]
  /// Of the drive that has kept least to what its values ask for: sums over the looks of
  /// |drive_error| and of |what was asked for, to and fro| [m, m/s, rad or rad/s].
  double drive_error = 0.0;
  double drive_asked = 0.0;
};

/// Follows a simulation: energy in every step; cables in every step of short runs and at about 2000
/// moments of long ones; joints at about 200 moments.
class RunMonitor {
 public:
  /// For a run of so many steps.
  explicit RunMonitor(std::int64_t steps);
  /// To be called at the start and after every step, with what the steps did so far.
  void observe(const Simulation& simulation, const RunStatistics& statistics);
  /// To be called at the end; `conservative`: measure::is_conservative(scene).
  void finish(const Simulation& simulation, bool conservative);

  /// Whether the energy has always been a finite number.
  [[nodiscard]] bool is_finite() const { return finite_; }
  [[nodiscard]] const Energy& initial_energy() const { return initial_; }
  [[nodiscard]] const Energy& final_energy() const { return final_; }
  /// The largest sum of kinetic and elastic energy [J].
  [[nodiscard]] double most_vivid_energy() const { return most_vivid_; }
  /// The largest total energy less its value at the start [J], >= 0.
  [[nodiscard]] double max_energy_gain() const { return max_gain_; }
  /// The largest |total energy - its value at the start| [J].
  [[nodiscard]] double max_energy_drift() const { return max_drift_; }
  /// What the integrator took from the motion, vibrations of elastic cables included, about [J], >=
  /// 0.
  [[nodiscard]] double integrator_loss() const { return integrator_loss_; }
  /// What it is compared with: the largest sum of kinetic and elastic energy, and what drives,
  /// friction, damping and impacts have put in and taken out [J].
  [[nodiscard]] double energy_flow() const { return most_vivid_ + loss_.exchanged(); }
  /// One per cable.
  [[nodiscard]] const std::vector<CableCourse>& cables() const { return cables_; }
  /// One per joint.
  [[nodiscard]] const std::vector<JointCourse>& joints() const { return joints_; }

 private:
  void observe_cables(const Simulation& simulation);
  void observe_joints(const Simulation& simulation);
  /// A link of a cable: the body, and the radius that the cable has there at the start [m].
  struct Touched {
    BodyId body;
    double radius = 0.0;
  };
  /// What the link has moved since the last look [m].
  [[nodiscard]] double way_of(const World& world, const Touched& link) const;

  std::int64_t stride_;        // steps between looks at the cables
  std::int64_t half_;          // of the steps
  std::int64_t observed_ = 0;  // calls of observe()
  Energy initial_;
  Energy final_;
  bool finite_ = true;
  double max_drift_ = 0.0;
  double max_gain_ = 0.0;
  double most_vivid_ = 0.0;
  double min_energy_ = 0.0;
  certify::IntegratorLoss loss_;
  double vibration_loss_ = 0.0;
  double integrator_loss_ = 0.0;
  std::int64_t joint_stride_;  // steps between looks at the joints
  std::vector<CableCourse> cables_;
  std::vector<JointCourse> joints_;
  std::vector<std::vector<Touched>> links_;  // of each cable
  std::vector<CableGauge> gauges_;
  std::vector<BodyState> last_seen_;  // at the last look at the cables
};

}  // namespace sheave::command
