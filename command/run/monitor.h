#pragma once
// Extremes of a run for its summary, beyond its final state.

#include <array>
#include <cstdint>
#include <vector>

#include "cable/simulation.h"
#include "command/run/simulate.h"

namespace sheave::command {

/// Extremes of one cable over a run.
struct CableCourse {
  double length_error = 0.0;  ///< relative error of the length invariant, the largest in size
  double max_stretch = 0.0;   ///< the largest CableReport::max_stretch
  double max_strain = 0.0;    ///< the largest CableReport::max_strain
  double length = 0.0;        ///< CableReport::total_length at the end [m]
  /// If the cable is rigid: how much all its spans together exceed the allowed length at the end
  /// [m].
  double excess = 0.0;
  // For the first and the second half of the run:
  std::array<double, 2> stretching{};  ///< total variation of `excess` [m]
  /// Path of the body on the cable that moves farthest at each time, or of a wheel's rim [m].
  std::array<double, 2> way{};
};

/// The largest errors of one joint over a run.
struct JointCourse {
  double error = 0.0;             ///< the largest JointReport::error [m]
  double error_time = 0.0;        ///< time of that error [s]
  double angle_error = 0.0;       ///< the largest JointReport::angle_error [rad]
  double angle_error_time = 0.0;  ///< time of that error [s]
  /// For the drive with the largest relative error: sums over the samples of |drive_error| and of
  /// |drive_target| [m, m/s, rad or rad/s].
  double drive_error = 0.0;
  double drive_asked = 0.0;
  std::int64_t drive_samples = 0;  ///< the number of samples
};

/// Follows a simulation. The energy is sampled in every step. Cables are sampled in every step of
/// short runs and about 2000 times in long ones, joints about 200 times.
class RunMonitor {
 public:
  /// `steps`: number of steps of the run.
  explicit RunMonitor(std::int64_t steps);
  /// To be called at the start and after every step, with the statistics so far.
  void observe(const Simulation& simulation, const RunStatistics& statistics);
  /// To be called at the end, with the statistics of the whole run; `conservative`:
  /// measure::is_conservative(scene).
  void finish(const Simulation& simulation, const RunStatistics& statistics, bool conservative);

  /// Whether the energy has always been finite.
  [[nodiscard]] bool is_finite() const { return finite_; }
  [[nodiscard]] const Energy& initial_energy() const { return initial_; }
  [[nodiscard]] const Energy& final_energy() const { return final_; }
  /// The largest sum of kinetic and elastic energy [J].
  [[nodiscard]] double most_vivid_energy() const { return most_vivid_; }
  /// The largest increase of the total energy above its value at the start [J], >= 0.
  [[nodiscard]] double max_energy_gain() const { return max_gain_; }
  /// The largest |total energy - its value at the start| [J].
  [[nodiscard]] double max_energy_drift() const { return max_drift_; }
  /// Energy that the integrator removed from the motion, including vibrations of elastic cables;
  /// approximate [J], >= 0.
  [[nodiscard]] double integrator_loss() const { return integrator_loss_; }
  /// The scale for integrator_loss() [J]: the largest sum of kinetic and elastic energy, plus the
  /// energy that drives, friction, damping and impacts have added and removed.
  [[nodiscard]] double energy_flow() const { return most_vivid_ + exchanged_; }
  /// One per cable.
  [[nodiscard]] const std::vector<CableCourse>& cables() const { return cables_; }
  /// One per joint.
  [[nodiscard]] const std::vector<JointCourse>& joints() const { return joints_; }

 private:
  void observe_cables(const Simulation& simulation);
  void observe_joints(const Simulation& simulation);
  /// A link of a cable on a body that can move, with the place of the body at the last sample.
  struct Touched {
    BodyId body;
    double radius = 0.0;  ///< of the cable at the link at the start [m]
    Vector3 position = Vector3::Zero();
    double angle = 0.0;
  };
  /// The longest path of the links since the last sample [m].
  static double follow(const World& world, std::vector<Touched>& links);

  std::int64_t stride_;        // steps between samples of the cables
  std::int64_t half_;          // half the number of steps
  std::int64_t observed_ = 0;  // calls of observe()
  Energy initial_;
  Energy final_;
  bool finite_ = true;
  double max_drift_ = 0.0;
  double max_gain_ = 0.0;
  double most_vivid_ = 0.0;
  double min_energy_ = 0.0;
  double exchanged_ = 0.0;
  double integrator_loss_ = 0.0;
  std::int64_t joint_stride_;  // steps between samples of the joints
  std::vector<CableCourse> cables_;
  std::vector<JointCourse> joints_;
  std::vector<std::vector<Touched>> links_;  // links of each cable
  std::vector<CableGauge> gauges_;
};

}  // namespace sheave::command
