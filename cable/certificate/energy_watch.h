#pragma once
// Balance of energy of a whole run, step by step, which checks of single substeps cannot give.
//
// Each substep may obey the rule of its integrator while the run gains or loses energy that no
// physical law gives or takes: by the integrator's error of many steps, or in a step that was not
// checked. The watch therefore follows the total energy E of every step, at the cost of a few
// operations per body.
//
// - A machine into which nothing puts energy (sources_of_energy.h) never has more than at its
//   start. The watch follows E - R. The reference R falls with E but does not follow short swings:
//   with an integrator that is its own inverse, E swings about its value by a fraction (w h)^2
//   within the period of a motion of angular frequency w. R is the least, so far, of the largest E
//   within the last 16 to 32 steps. A motion that swings more slowly changes E by less than
//   (2 pi / 32)^2 / 8 = 0.5 % of its energy.
// - A machine that dissipates none either (keeps_energy()) loses only the energy that `xpbd` takes
//   from a smooth motion (integrator_loss.h). The loss is known to first order, so twice as much
//   counts as explained. Impacts take energy, too: steps in which a span is slack, or the course of
//   a cable changes, do not count.
// - No machine has 10^6 times the energy that was put into it. The input of drives is not known
//   here. Its bound is the energy of the whole mass at the speed of the fastest drive plus the work
//   of the known forces; it is computed again whenever the energy has doubled.
//
// All figures are relative to the largest sum of kinetic and elastic energy of the run.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cable/certificate.h"
#include "cable/certificate/integrator_loss.h"
#include "cable/simulation.h"

namespace sheave::certify {

class EnergyWatch {
 public:
  /// Begins with the present state of the simulation.
  explicit EnergyWatch(const Simulation& simulation);

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
  void follow_gain(double total, double time);
  void follow_loss(const Simulation& simulation, double loss);
  void follow_input(const Simulation& simulation, const StepStatistics& statistics);
  /// Whether `xpbd` dissipates spin of a body in another way than that of smooth motion: a body with
  /// different moments of inertia turns far in a substep.
  [[nodiscard]] bool tumbles(const World& world) const;
  /// Bound of the energy that drives and loads have put in so far [J].
  [[nodiscard]] double most_put_in(const Simulation& simulation) const;
  /// Differences of energy below this are rounding [J].
  [[nodiscard]] double rounding() const;

  bool passive_;
  bool keeps_;
  double mass_ = 0.0;          ///< mass of all moving bodies [kg]
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
