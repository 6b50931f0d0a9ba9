#pragma once
// Machines whose ropes remember how they were stretched, with straight curves, for which all ways have
// a closed form: U = k e when stretched, V = k' e when let off with the transition strain w, or the
// line of slope E. Integrals of the tension over the strain:
//
//   from the slack to e >= w          k e^2 / 2 - (k - k') w^2 / 6
//   from e back to the slack          k' e^2 / 2 + (k - k') ((e - w) w / 2 + w^2 / 3)
//   from a turn at a, on V, to b      k (b^2 - a^2) / 2 - (k - k') (a w / 2 + w^2 / 6)
//   from a turn at b, on U, to a      k' (b^2 - a^2) / 2 + (k - k') ((b - w) w / 2 + w^2 / 3)

#include <cmath>

#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::test::rope_memory {

inline constexpr double mass = 20.0;      // [kg]
inline constexpr double length = 2.0;     // [m], unstretched
inline constexpr double loading = 2e4;    // k [N]
inline constexpr double letting = 1.4e4;  // k' [N]
inline constexpr double width = 0.004;    // w
inline constexpr double steep = 5e4;      // E [N]

enum class Law { yields, has_two_curves };

inline void give_law(CableDef& cable, Law law) {
  cable.strain_table = {0.0, 0.4};
  cable.tension_table = {0.0, 0.4 * loading};
  if (law == Law::yields) {
    cable.unloading_stiffness = steep;
  } else {
    cable.unloading_table = {0.0, 0.4 * letting};
    cable.transition_strain = width;
  }
}

/// A weight, body 0, on a rope below the world's origin; `strain` may be below 0.
inline Machine hanging(Law law, double strain) {
  Machine m;
  m.model.gravity = down;
  m.model.bodies = {weight("load", {0.0, -length * (1.0 + strain), 0.0}, mass)};
  m.cables = {cable("rope", {attach(BodyId::world()), attach(BodyId{0})})};
  m.cables[0].rest_lengths = {length};
  give_law(m.cables[0], law);
  return m;
}

/// The larger solution x of a x^2 / 2 + b x + c = 0.
inline double larger_root(double a, double b, double c) {
  return (-b + std::sqrt(b * b - 2.0 * a * c)) / a;
}

inline StepSettings step_of(const Combination& c, double dt, int substeps) {
  StepSettings step = settings(dt, substeps, 60);
  step.solver = c.solver;
  step.integrator = c.integrator;
  return step;
}

/// Kinetic, potential and elastic energy, with the loss by the law of the first cable [J].
inline double total_with_loss(const Simulation& s) {
  const Energy energy = s.world.energy();
  return energy.kinetic + energy.potential + energy.elastic + s.cable_reports()[0].hysteresis_loss;
}

}  // namespace sheave::test::rope_memory
