#pragma once
// Evaluates the checks of a scene during a run.

#include <string>
#include <vector>

#include "scenes/quantity_list.h"
#include "scenes/scene.h"

namespace sheave {

/// Outcome of one check.
struct CheckResult {
  CheckDef check;
  double measured = 0.0;   ///< NaN if nothing could be measured
  double error = 0.0;      ///< measured - equals
  double tolerance = 0.0;  ///< largest |error| that passes
  bool passed = false;
  std::string message;  ///< one line: the measured and the required value, or why the check failed
};

/// Follows a simulation and evaluates the checks of its scene as it goes: no history is kept.
class CheckRecorder {
 public:
  /// A check whose quantity does not exist fails. No loaded scene has such a check.
  CheckRecorder(const Scene& scene, const Simulation& simulation);

  /// To be called at time 0 and after every step.
  void record(const Simulation& simulation);
  [[nodiscard]] std::vector<CheckResult> results() const;

 private:
  /// The samples in the window of a check.
  struct Window {
    CheckDef check;
    std::string fault;      ///< why there is no quantity; empty if there is one
    std::size_t value = 0;  ///< index in quantities_
    double from = 0.0;      ///< the window [s]; for the statistic `at` both members are its time
    double to = 0.0;
    Course course;  ///< of the samples; for `at` the one sample nearest to `from`

    void add(double time, double sample, double margin);
    [[nodiscard]] double measured() const;
  };

  [[nodiscard]] CheckResult result(const Window& window) const;

  QuantityList quantities_;  // of the checks that have one
  double dt_;
  double last_time_ = -1.0;      // of the last sample; < 0: none yet
  std::vector<double> values_;   // of the quantities
  std::vector<Course> courses_;  // of statistics in them
  std::vector<Window> windows_;  // one per check
};

}  // namespace sheave
