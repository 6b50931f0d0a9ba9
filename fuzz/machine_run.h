#pragma once
// Properties that must hold for every run of every machine.

#include "cable/simulation.h"

namespace sheave::fuzz {

/// Checks the state after a step and its reports; a violation is a BrokenPromise.
class StepCheck {
 public:
  /// For runs of `simulation`. `ordinary`: the machine has ordinary sizes, so its energy is finite.
  StepCheck(const Simulation& simulation, bool ordinary);

  /// To be called after every step that does not diverge.
  void check(const Simulation& simulation);

 private:
  void check_cables(const Simulation& simulation, bool clean);
  void check_joints(const Simulation& simulation) const;
  void check_contacts(const Simulation& simulation) const;
  void check_energy(const Simulation& simulation);

  bool ordinary_;
  bool driven_;        ///< some part does work on the machine that its energy does not include
  Simulation before_;  ///< a second simulation, which is set to states of this run
  std::vector<double>
      rounding_;  ///< per cable: bound of the relative rounding error of its total length
  std::size_t events_ = 0;
  int quiet_ = 2;  ///< steps since the last event of a cable
};

}  // namespace sheave::fuzz
