#pragma once
// Balance of energy of a whole run, step by step, which checks of single substeps cannot give.
//
// Each substep may obey the rule of its integrator while the run gains or loses energy that no
// physical law gives or takes: by the integrator's error of many steps, or in a step that was not
// checked. The watch therefore follows the total energy E of every step, at the cost of a few
// operations per body.
//
// - A machine never has more energy than at its start plus the work of its sources
//   (source_work.h), whose bound is known. The watch follows E - R. The reference R rises by the
//   bound of that work. R falls with E but does not follow short swings:
//   with an integrator that is its own inverse, E swings about its value by a fraction (w h)^2
//   within the period of a motion of angular frequency w. R is the least, so far, of the largest E
//   within the last 16 to 32 steps. A motion that swings more slowly changes E by less than
//   (2 pi / 32)^2 / 8 = 0.5 % of its energy. In a step in which the work of a source is not known, R
//   rises with E.
// - A machine that dissipates none (keeps_energy()) loses only the energy that its sources take,
//   at most the same bound, and the energy that `xpbd` takes from a smooth motion
//   (integrator_loss.h). The loss is known to first order, so twice as much counts as explained.
//   Impacts take energy, too: steps in which a span is slack, or the course of a cable changes, do
//   not count.
// - No machine has 10^6 times the energy that was put into it. Where the work of drives is not
//   known, its bound is the energy of the whole mass at the speed of the fastest drive plus the work
//   of the known forces; it is computed again whenever the energy has doubled.
//
// All figures are relative to the largest sum of kinetic and elastic energy of the run, plus the
// bound of all work of sources.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cable/certificate.h"
#include "cable/certificate/integrator_loss.h"
#include "cable/certificate/source_work.h"
#include "cable/simulation.h"

namespace sheave::certify {

class EnergyWatch {
 public:
  /// Begins with the present state of the simulation.
  explicit EnergyWatch(const Simulation& simulation);

  /// Whether the work of sources has to be observed after each substep. observe() does so for the
  /// last substep of a step.
  [[nodiscard]] bool observes_substeps() const { return sources_.any(); }
  void observe_substep(const Simulation& simulation) { sources_.observe(simulation); }
  /// To be called after every step with its statistics. A state that does not follow from the last
  /// one by a step begins a new balance.
  void observe(const Simulation& simulation, const StepStatistics& statistics);
  /// Whether the last step gained or lost more than 1 % of the energy, so that the step should be
  /// checked.
  [[nodiscard]] bool is_suspicious() const { return suspicious_; }
  /// Energy of the last observed state.
  [[nodiscard]] const Energy& energy() const { return energy_; }
  /// The energy that the integrator has taken since the balance began.
  [[nodiscard]] const IntegratorLoss& integrator() const { return integrator_; }
  /// The worst fault of the run so far; nothing if the machine has no balance that could be
  /// checked.
  [[nodiscard]] std::optional<CertificateItem> finding() const;

 private:
  void begin(const Simulation& simulation);
  /// Whether a rope with weight has parted since the last look. Its weight, and the energy of this
  /// weight, leave the machine.
  [[nodiscard]] bool has_lost_rope(const Simulation& simulation) const;
  /// Bound of the work in the last step.
  [[nodiscard]] SourceWork::Work take_work(const Simulation& simulation,
                                           const StepStatistics& statistics);
  void follow_gain(double before, const SourceWork::Work& work, double time);
  void follow_loss(const Simulation& simulation, double loss, const SourceWork::Work& work);
  void follow_input(const Simulation& simulation, const StepStatistics& statistics);
  /// Whether `xpbd` dissipates spin of a body in another way than that of smooth motion: a body with
  /// different moments of inertia turns far in a substep.
  [[nodiscard]] bool tumbles(const World& world) const;
  /// Bound of the energy that drives and loads have put in so far [J].
  [[nodiscard]] double most_put_in(const Simulation& simulation) const;
  /// The energy to which gains and losses are compared [J].
  [[nodiscard]] double scale() const;
  /// Differences of energy below this are rounding [J].
  [[nodiscard]] double rounding() const;

  SourceWork sources_;
  Vector3 gravity_ = Vector3::Zero();  ///< of the last observed state [m/s2]
  double exchanged_ = 0.0;             ///< sum of the bounds of the work of all steps [J]
  bool passive_;
  bool keeps_;
  double mass_ = 0.0;          ///< mass of all moving bodies [kg]
  double still_ = 0.0;         ///< kinetic energy by the rounding of places, of bodies at rest [J]
  double weight_ = 0.0;        ///< weight of these bodies times the size of the scene [J]
  double size_ = 0.0;          ///< size of the scene [m]
  std::vector<int> tumbling_;  ///< bodies for tumbles()
  double springs_ = 0.0;       ///< energy of all springs when stretched by that size [J]

  std::int64_t steps_ = 0;  ///< State::steps of the last observed state
  Energy start_;
  Energy energy_;
  double vivid_ = 0.0;    ///< largest kinetic + elastic energy [J]
  double highest_ = 0.0;  ///< largest total energy [J]
  double highest_time_ = 0.0;
  bool suspicious_ = false;

  // Gains of energy.
  double reference_ = 0.0;     ///< R
  double block_ = 0.0;         ///< largest E of the present block of steps
  double block_before_ = 0.0;  ///< largest E of the block before
  std::int64_t in_block_ = 0;  ///< number of steps in the present block
  double gain_ = 0.0;          ///< the largest E - R
  double gain_time_ = 0.0;
  // Losses of energy.
  IntegratorLoss integrator_;
  std::int64_t fallbacks_ = 0;
  std::size_t events_ = 0;
  int taut_steps_ = 0;      ///< number of consecutive steps with all spans taut
  double lost_ = 0.0;       ///< loss in steps without impacts
  double most_lost_ = 0.0;  ///< largest loss in one step
  double most_lost_time_ = 0.0;
  // Energy input.
  double put_in_ = 0.0;
  double worked_ = 0.0;     ///< work of forces set by controls, absolute values summed
  double looked_at_ = 0.0;  ///< largest energy when put_in_ was computed
};

}  // namespace sheave::certify
