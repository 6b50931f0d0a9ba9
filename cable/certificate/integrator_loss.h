#pragma once
// How much energy the integrator takes from a motion that is smooth.
//
// A substep h of implicit Euler, of which `xpbd` is one, follows x' = v + h/2 a, v' = a + h/2 a' to
// first order. With the forces M a, of whatever kind, the work that they do along x' is less than
// the change of kinetic energy says, by
//   h/2 (M a . a - M v . a')   per time,   in all   h Integral M a . a dt - h/2 [M v . a].
// For free fall that is h m g^2 t / 2, as positions that are g h t / 2 too low say; for a circle at
// w it is h m w^4 r^2, so that w falls as w0 / sqrt(1 + 2 w0^2 h t). `rattle` is symmetric and has
// no such term: only substeps that it leaves to `xpbd` count.
//
// What is counted comes from the velocities at the ends of steps. An impact changes them by a
// finite amount within a step or two, whose energy no integrator has taken but nature: of M a . a
// only that much counts which three steps in a row have. Rotors that are driven and bodies that
// move as a function of time are left out. Motion that turns round within a step (stiff springs) is
// not seen; of elastic cables the solver counts that itself (StepStatistics::numerical_damping).

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "engine/world.h"

namespace sheave::certify {

class IntegratorLoss {
 public:
  /// To be called at the start and after every step. `energy` is World::energy().total();
  /// `fallbacks`: how many substeps `rattle` has left to `xpbd` so far
  /// (StepStatistics::integrator_fallbacks).
  void observe(const World& world, double energy, std::int64_t fallbacks);

  /// What was taken [J]; of a short run it may be negative, for positions lag behind by half a
  /// substep.
  [[nodiscard]] double taken() const;
  /// What went in and out by drives, friction, damping, impacts: the sum of all changes of the
  /// energy that the integrator does not explain, whatever their sign [J].
  [[nodiscard]] double exchanged() const;

 private:
  /// Of one body: m v, and the angular momentum, or that about its axis along x. 0 of bodies that do
  /// not move freely.
  struct Momentum {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
  };
  struct Step {
    double square = 0.0;       ///< M a . a dt^2 [J]
    double first_power = 0.0;  ///< M v . a dt at its beginning [J]
    double power = 0.0;        ///< and at its end [J]
    double energy = 0.0;       ///< at its end [J]
    double share = 0.0;        ///< h / dt, times the share of substeps that `xpbd` did
  };
  struct Sums {
    double taken = 0.0;
    double exchanged = 0.0;
    double energy = 0.0;  ///< before the next step [J]
    double power = 0.0;   ///< likewise
    bool begun = false;

    /// `smooth`: what of the step's square its neighbours have, too.
    void add(const Step& step, double smooth);
  };

  /// Makes `last_` those of now, and returns what has changed.
  [[nodiscard]] Step follow(const World& world);
  [[nodiscard]] double smooth_part(std::size_t step) const;
  [[nodiscard]] Sums sums() const;

  std::vector<Momentum> last_;
  std::int64_t fallbacks_ = 0;
  std::deque<Step> recent_;  // of the last five steps, the oldest first
  std::size_t counted_ = 0;  // of them
  Sums sums_;
};

}  // namespace sheave::certify
