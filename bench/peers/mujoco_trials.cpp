// Which settings suit MuJoCo best is not guessed but tried.

#include <algorithm>
#include <limits>

#include "bench/peers/mujoco_machine.h"
#include "measure/timing.h"

namespace sheave::peers {
namespace {

/// Best of three runs: enough to choose by.
double trial_time(const Problem& problem, const std::shared_ptr<Machine>& machine) {
  const measure::Contender contender = contender_of("", problem, machine);
  measure::TimingOptions options;
  options.repetitions = 3;
  options.least_sample = 1e-3;
  return measure::time_interleaved({contender}, options).front().seconds.minimum;
}

}  // namespace

std::vector<MujocoSettings> mujoco_settings() {
  std::vector<MujocoSettings> all;
  // The integrator "implicit" is Euler where no force depends on the velocity, for more work.
  for (const char* solver : {"Newton", "CG", "PGS"}) {
    for (const char* jacobian : {"dense", "sparse"}) {
      for (const char* integrator : {"Euler", "RK4"}) {
        for (const int iterations : {1, 3, 10, 30, 100, 1000}) {
          for (const double time_constant : {2.0, 0.0}) {
            for (const bool warm : {true, false}) {
              all.push_back(
                  {solver, jacobian, integrator, iterations, 1e-10, 0.9999, time_constant, warm});
              // A tolerance that only many iterations reach makes no difference to few.
              if (iterations >= 10) all.push_back(all.back()), all.back().tolerance = 1e-6;
            }
          }
        }
      }
    }
  }
  return all;
}

Result<std::vector<MujocoTrial>> mujoco_trials(const Problem& problem) {
  std::vector<MujocoTrial> trials;
  double best = std::numeric_limits<double>::infinity();
  for (const MujocoSettings& settings : mujoco_settings()) {
    const Result<std::shared_ptr<Machine>> machine = mujoco_machine(problem, settings);
    if (!machine) return machine.errors();
    const double start = measure::thread_time();
    const MachineError error = error_of(problem, **machine);
    double seconds = (measure::thread_time() - start) / problem.frames;
    // Only what may be chosen needs to be timed well: what is not far wrong and not far slower than
    // the best.
    constexpr double hopeless = 0.01;
    constexpr double far_slower = 3.0;
    if (error.speed < hopeless && seconds < far_slower * best) {
      seconds = trial_time(problem, *machine);
      if (error.speed < right_error) best = std::min(best, seconds);
    }
    trials.push_back({settings, error, seconds});
  }
  std::sort(trials.begin(), trials.end(),
            [](const MujocoTrial& a, const MujocoTrial& b) { return a.seconds < b.seconds; });
  return trials;
}

std::vector<MujocoTrial> best_trials(const std::vector<MujocoTrial>& trials) {
  double best = 1.0;
  for (const MujocoTrial& trial : trials) best = std::min(best, trial.error.position);
  const auto fast = std::find_if(trials.begin(), trials.end(), [](const MujocoTrial& trial) {
    return trial.error.speed <= right_error;
  });
  const auto exact = std::find_if(trials.begin(), trials.end(), [&](const MujocoTrial& trial) {
    return trial.error.position <= 2.0 * best;
  });
  std::vector<MujocoTrial> chosen;
  if (fast != trials.end()) chosen.push_back(*fast);
  if (exact != trials.end() && exact != fast) chosen.push_back(*exact);
  return chosen;
}

}  // namespace sheave::peers
