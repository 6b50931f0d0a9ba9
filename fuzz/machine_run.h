#pragma once
// What holds of every run, whatever the machine is.

#include "cable/simulation.h"

namespace sheave::fuzz {

/// What is wrong with the state that a step has left, or with what is reported of it: a
/// BrokenPromise.
class StepCheck {
 public:
  /// For runs of `simulation`. `ordinary`: a machine of ordinary sizes, whose energy is a number.
  StepCheck(const Simulation& simulation, bool ordinary);

  /// To be called after every step that does not diverge.
  void check(const Simulation& simulation);

 private:
  void check_cables(const Simulation& simulation, bool clean);
  void check_joints(const Simulation& simulation) const;
  void check_contacts(const Simulation& simulation) const;
  void check_energy(const Simulation& simulation);

  bool ordinary_;
  bool driven_;        ///< something does work on the machine, or takes energy from nowhere
  Simulation before_;  ///< another of the same, put into states of this run
  std::vector<double>
      rounding_;  ///< per cable, what the sum of its lengths may be off by, relative
  std::size_t events_ = 0;
  int quiet_ = 2;  ///< steps since the course of a cable has changed
};

}  // namespace sheave::fuzz
