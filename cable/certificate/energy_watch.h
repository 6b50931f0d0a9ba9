#pragma once
// The energy of a whole run, step by step: what single substeps cannot tell.
//
// Each substep may be right by the rule of its integrator, and the run still gain or lose energy
// that no law of nature gives or takes: by what the rule is off in each of many steps, or in a step
// that nobody has looked at. So the total energy E of every step is followed, which takes a few
// operations per body.
//
// - A machine into which nothing puts energy (sources_of_energy.h) never has more than it had. What
//   counts is E - R, where R falls with E but not for what comes back: an integrator that is its
//   own inverse lets E swing about its value by (w h)^2, within the period of a motion w. R is the
//   least, so far, of the largest E of the last 16 to 32 steps; what swings more slowly than that
//   swings by less than (2 pi / 32)^2 / 8 = 0.5 % of its energy.
// - A machine that takes none either (keeps_energy()) loses only what `xpbd` takes from a smooth
//   motion (integrator_loss.h), which is known to first order, so that twice as much is explained;
//   and what impacts take: steps in which a span is slack, or the course of a cable changes, do not
//   count.
// - No machine has 10^6 times the energy that was put in. How much that is of a machine with drives
//   only drives know; what all its mass would have at the speed of the fastest of them, and the
//   work of forces that are known, is looked at anew whenever the energy has doubled.
//
// All of it is measured by the largest sum of kinetic and elastic energy of the run.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "cable/certificate.h"
#include "cable/certificate/integrator_loss.h"
#include "cable/simulation.h"

namespace sheave::certify {

class EnergyWatch {
 public:
  /// From the state that the simulation has now.
  explicit EnergyWatch(const Simulation& simulation);

  /// To be called after every step, with what it told. A state that does not follow from the last
  /// one by a step begins anew.
  void observe(const Simulation& simulation, const StepStatistics& statistics);
  /// Whether the last step made energy, or took some, by more than a hundredth of what there is: it
  /// wants to be checked.
  [[nodiscard]] bool is_suspicious() const { return suspicious_; }
  /// Of the state that was observed last.
  [[nodiscard]] const Energy& energy() const { return energy_; }
  /// What is wrong with the run so far; nothing if there is nothing to judge it by.
  [[nodiscard]] std::optional<CertificateItem> finding() const;

 private:
  void begin(const Simulation& simulation);
  void follow_gain(double total, double time);
  void follow_loss(const Simulation& simulation, double loss, const StepStatistics& statistics);
  void follow_input(const Simulation& simulation, const StepStatistics& statistics);
  /// What drives and loads can have put in by now [J].
  [[nodiscard]] double most_put_in(const Simulation& simulation) const;
  /// Below which differences of energies are rounding [J].
  [[nodiscard]] double rounding() const;

  bool passive_;
  bool keeps_;
  double mass_ = 0.0;     ///< of all that moves [kg]
  double weight_ = 0.0;   ///< of it, times the size of the scene [J]
  double size_ = 0.0;     ///< of the scene [m]
  double springs_ = 0.0;  ///< what all of them store that are drawn out by that [J]

  std::int64_t steps_ = 0;  ///< State::steps of what was observed last
  Energy start_;
  Energy energy_;
  double vivid_ = 0.0;    ///< the largest kinetic + elastic energy
  double highest_ = 0.0;  ///< the largest total energy
  double highest_time_ = 0.0;
  bool suspicious_ = false;

  // Gains.
  double reference_ = 0.0;     ///< R
  double block_ = 0.0;         ///< the largest E of the block of steps that has begun
  double block_before_ = 0.0;  ///< and of the one before
  std::int64_t in_block_ = 0;  ///< steps
  double gain_ = 0.0;          ///< the largest E - R
  double gain_time_ = 0.0;
  // Losses.
  IntegratorLoss integrator_;
  std::int64_t fallbacks_ = 0;
  std::size_t events_ = 0;
  int taut_steps_ = 0;      ///< in a row, so far
  double lost_ = 0.0;       ///< in steps without impacts
  double most_lost_ = 0.0;  ///< in one step
  double most_lost_time_ = 0.0;
  // What has been put in.
  double put_in_ = 0.0;
  double worked_ = 0.0;     ///< by forces that have been set, to and fro
  double looked_at_ = 0.0;  ///< the largest energy when put_in_ was found
};

}  // namespace sheave::certify
