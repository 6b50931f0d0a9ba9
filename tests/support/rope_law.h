#pragma once
// Machines whose ropes have the hardening law T = k1 e + k3 e^3.
//
// The law is tabulated at 400 points, between which the monotone cubic has the error d^3 / 10 T''' or
// less, 1e-9 of the tension. Its energy per length is U = k1 e^2 / 2 + k3 e^4 / 4.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::test::rope_law {

inline constexpr double k1 = 2000.0;  // [N]
inline constexpr double k3 = 4e5;     // [N]

inline double hardening(double e) { return k1 * e + k3 * e * e * e; }
inline double hardening_energy(double e) { return 0.5 * k1 * e * e + 0.25 * k3 * e * e * e * e; }

inline void give_law(CableDef& cable) {
  constexpr int points = 400;
  constexpr double last = 0.4;
  for (int i = 0; i <= points; ++i) {
    const double e = last * i / points;
    cable.strain_table.push_back(e);
    cable.tension_table.push_back(hardening(e));
  }
}

/// A weight of 20 kg, body 0, on 2 m of rope below the world's origin, stretched to `strain`.
inline Machine bouncer(double strain, double gravity = g) {
  Machine m;
  m.model.gravity = {0.0, -gravity, 0.0};
  m.model.bodies = {weight("load", {0.0, -2.0 * (1.0 + strain), 0.0}, 20.0)};
  m.cables = {cable("rope", {attach(BodyId::world()), attach(BodyId{0})})};
  m.cables[0].rest_lengths = {2.0};
  give_law(m.cables[0]);
  return m;
}

inline double total(const Simulation& s) {
  const Energy energy = s.world.energy();
  return energy.kinetic + energy.potential + energy.elastic;
}

/// Largest change of the energy up to `time`, with the loss by creep [J].
inline double drift(const Machine& machine, double time) {
  Simulation s = start(machine);
  const double start = total(s);
  double worst = 0.0;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
    worst = std::max(worst, std::abs(total(s) + s.cable_reports()[0].creep_loss - start));
  }
  return worst;
}

inline StepSettings step_of(const Combination& c, int substeps) {
  StepSettings step = settings(0.01, substeps, 60);
  step.solver = c.solver;
  step.integrator = c.integrator;
  return step;
}

}  // namespace sheave::test::rope_law
