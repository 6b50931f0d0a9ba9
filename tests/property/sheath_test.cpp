// Properties of random machines with ropes in sheaths, which wide_machine.h does not draw.

#include "cable/links/sheath.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/state.h"
#include "tests/property/campaign.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

std::shared_ptr<SheathLink> random_sheath(Random& random, BodyId body, const Vector3& middle) {
  auto sheath = std::make_shared<SheathLink>();
  const Vector3 half = random.vector(0.2);
  sheath->body = body;
  sheath->points = {middle - half, middle + half};
  sheath->length = 2.0 * half.norm() * random.between(1.01, 3.0);
  sheath->bend = random.chance(0.2) ? 0.0 : random.between(0.0, 9.0);
  sheath->friction = random.chance(0.2) ? 0.0 : random.between(0.0, 0.3);
  return sheath;
}

/// Bodies that swing on elastic ropes through one to three sheaths each, on the world and on bodies.
RandomMachine sheathed(std::uint64_t seed) {
  Random random(seed);
  RandomMachine result;
  Machine& m = result.machine;
  m.model.gravity = down;
  m.model.step = settings(1.0 / 240.0, 1 + random.below(8), 60);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = random.chance(0.5) ? IntegratorKind::xpbd : IntegratorKind::rattle;
  const int bodies = 1 + random.below(3);
  for (int i = 0; i < bodies; ++i) {
    BodyDef body = lump("", {0.8 * i, random.between(-2.0, -1.0), random.between(-0.3, 0.3)},
                        random.between(0.5, 5.0));
    body.name = "body" + std::to_string(i);
    body.velocity = random.vector(1.0);
    m.model.add(body);
  }
  for (int i = 0; i < bodies; ++i) {
    CableDef rope =
        cable("rope" + std::to_string(i), {attach(BodyId::world(), {0.8 * i, 1.0, 0.0})});
    const int count = 1 + random.below(3);
    for (int k = 0; k < count; ++k) {
      const bool on_body = random.chance(0.3) && bodies > 1;
      const BodyId body = on_body ? BodyId{(i + 1) % bodies} : BodyId::world();
      const Vector3 middle =
          on_body ? random.vector(0.1) : Vector3(0.8 * i + random.between(-1.0, 1.0), 0.5 * k, 0.5);
      rope.links.push_back(random_sheath(random, body, middle));
    }
    rope.links.push_back(attach(BodyId{i}));
    rope.axial_stiffness = std::pow(10.0, random.between(3.0, 5.0));
    rope.pretension = random.between(1.0, 50.0);
    m.cables.push_back(rope);
  }
  return result;
}

/// The certificate of every step is clean with `xpbd`. With `rattle` it tells of substeps in which the
/// whole rope of a sheath begins or ceases to slide (docs/reference/known-faults.md).
Finding certified(const Machine& machine) {
  if (machine.model.step.integrator == IntegratorKind::rattle) return {false, 0.0, 0.0, ""};
  Simulation s = start(machine);
  Certificate all;
  for (int i = 0; i < 60; ++i) {
    if (!s.world.step().ok()) return {true, INFINITY, 1.0, "the motion diverges"};
    all.merge(*s.certificate());
  }
  const CertificateItem* worst = all.worst();
  if (worst == nullptr) return {true, INFINITY, 0.01, "nothing was checked"};
  return {true, worst->relative, 0.01, worst->sentence()};
}

/// Ropes keep their lengths to the last bit, and the friction of a sheath never gives energy.
Finding takes_energy(const Machine& machine) {
  Simulation s = start(machine);
  double lost = 0.0;
  double energy = 0.0;
  // The loss of a substep is that of a trapezoidal rule, with an error of second order: up to 6e-6 of
  // the energy here, with one substep per step. Friction with the wrong sign gave 1e-3 and more.
  Finding finding{true, 0.0, 1e-4, "friction gives energy"};
  for (int i = 0; i < 60; ++i) {
    if (!s.world.step().ok()) return {true, INFINITY, 1.0, "the motion diverges"};
    double now = 0.0;
    for (const CableReport& rope : s.cable_reports()) {
      now += rope.sheath_loss;
      if (rope.length_error != 0.0) return {true, INFINITY, 1.0, "the length of a rope"};
    }
    energy = std::max(energy, s.world.energy().kinetic);
    finding.worsen((lost - now) / energy, finding.limit, finding.what);
    lost = now;
  }
  return finding;
}

TEST(Property, FrictionOfSheathsTakesEnergy) {
  run_campaign_on("sheaths-energy", instrumented || !optimised ? 10 : 100, sheathed,
                  [](const Machine& machine, std::uint64_t) { return takes_energy(machine); });
}

TEST(Property, RopesInSheathsAreCertified) {
  run_campaign_on("sheaths", instrumented || !optimised ? 10 : 100, sheathed,
                  [](const Machine& machine, std::uint64_t) { return certified(machine); });
}

TEST(Property, RopesInSheathsContinueToTheLastBit) {
  run_campaign_on("sheaths-snapshot", instrumented || !optimised ? 5 : 50, sheathed,
                  [](const Machine& machine, std::uint64_t) {
                    Simulation s = start(machine);
                    for (int i = 0; i < 20; ++i) static_cast<void>(s.world.step());
                    const Result<State> middle = state_from_bytes(to_bytes(s.world.state()));
                    Simulation fresh = start(machine);
                    if (!middle || !fresh.world.restore(*middle).empty()) {
                      return Finding{true, 1.0, 0.0, "a state that is refused"};
                    }
                    for (int i = 0; i < 20; ++i) {
                      static_cast<void>(s.world.step());
                      static_cast<void>(fresh.world.step());
                    }
                    const bool same = hash(s.world.state()) == hash(fresh.world.state());
                    return Finding{true, same ? 0.0 : 1.0, 0.5, "other bits"};
                  });
}

}  // namespace
}  // namespace sheave::test
