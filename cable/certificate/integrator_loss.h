#pragma once
// Energy that the integrator takes from a smooth motion.
//
// A substep h of implicit Euler, such as one of `xpbd`, follows x' = v + h/2 a, v' = a + h/2 a' to
// first order. With the forces M a, of whatever kind, their work along x' is less than the change
// of kinetic energy by
//   h/2 (M a . a - M v . a')   per time,   in all   h Integral M a . a dt - h/2 [M v . a].
// For free fall that is h m g^2 t / 2, which agrees with positions that are g h t / 2 too low. For
// a circle at w it is h m w^4 r^2, so w falls as w0 / sqrt(1 + 2 w0^2 h t). `rattle` is symmetric
// and has no such term: only its substeps that fall back to `xpbd` count.
//
// The sum uses the velocities at the ends of steps. An impact changes them by a finite amount
// within a step or two, and its loss is physical, not numerical. Therefore only that part of M a .
// a counts which three consecutive steps have in common. Driven rotors and bodies that move as a
// function of time are left out. Motion that turns round within a step (stiff springs) is not seen;
// for elastic cables the solver counts that loss itself (StepStatistics::numerical_damping).

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "engine/world.h"

namespace sheave::certify {

class IntegratorLoss {
 public:
  /// To be called at the start and after every step. `energy` is World::energy().total().
  /// `fallbacks`: number of substeps of `rattle` that fell back to `xpbd` so far
  /// (StepStatistics::integrator_fallbacks).
  void observe(const World& world, double energy, std::int64_t fallbacks);

  /// The energy taken so far [J]. For a short run it may be negative, because positions lag behind
  /// by half a substep.
  [[nodiscard]] double taken() const;
  /// Energy exchanged by drives, friction, damping and impacts: the sum of the absolute values of
  /// all changes that the integrator does not explain [J].
  [[nodiscard]] double exchanged() const;

 private:
  /// A body that moves freely and turns about an axis, with its momenta after the last step.
  struct Axial {
    int body;
    int mount;  ///< body that carries the axis; -1: none
    Vector3 axis;
    double inertia;        ///< about the axis [kg m2]
    double mass;           ///< 0 for a rotor [kg]
    Vector3 linear;        ///< momentum [kg m/s]
    double angular = 0.0;  ///< angular momentum about the axis [kg m2/s]
  };
  /// A body that moves freely in space, with its momenta after the last step.
  struct Spatial {
    int body;
    Vector3 linear;
    Vector3 angular;
  };
  struct Step {
    double square = 0.0;       ///< M a . a dt^2 [J]
    double first_power = 0.0;  ///< M v . a dt at its beginning [J]
    double power = 0.0;        ///< the same at its end [J]
    double energy = 0.0;       ///< at its end [J]
    double share = 0.0;        ///< h / dt, times the fraction of substeps done by `xpbd`
  };
  struct Sums {
    double taken = 0.0;
    double exchanged = 0.0;
    double energy = 0.0;  ///< before the next step [J]
    double power = 0.0;   ///< the same of the power [J]
    bool begun = false;

    /// `smooth`: the part of the step's square that its neighbours have in common with it.
    void add(const Step& step, double smooth);
  };

  void begin(const World& world);
  /// Replaces the momenta by the present ones and returns the change.
  [[nodiscard]] Step follow(const World& world);
  [[nodiscard]] double smooth_part(std::size_t step) const;
  [[nodiscard]] Sums sums() const;

  bool begun_ = false;
  std::vector<Axial> axial_;
  std::vector<Spatial> spatial_;
  std::int64_t fallbacks_ = 0;
  std::deque<Step> recent_;  // the last five steps, oldest first
  std::size_t counted_ = 0;  // number of them that are counted in sums_
  Sums sums_;
};

}  // namespace sheave::certify
