// Ropes with weight that part: the energy of their weight leaves the machine with them.

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/checked_run.h"

namespace sheave::heavy_cut {
namespace {

/// 100 kg on 30 m of rope of 1 kg/m, which is cut after 0.5 s.
test::Machine hoist() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 120.0, 2);
  m.model.add(test::weight("load", {0.0, -30.0, 0.0}, 100.0));
  CableDef rope =
      test::cable("rope", {test::attach(BodyId::world(), {0.0, 0.0, 0.0}), test::attach({0})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  rope.cut_time = 0.5;
  m.cables.push_back(rope);
  return m;
}

TEST(HeavyCut, IsNoGainOfEnergy) {
  const Certificate certificate = test::checked_run(hoist(), 1.0);
  EXPECT_TRUE(certificate.clean(1e-6)) << certificate.worst()->sentence();
}

TEST(HeavyFold, OfARopeShorterThanItsOwnStretchIsNoFault) {
  // The rest length is the chord, so the rope hangs in a fold until the load has fallen by the stretch
  // of its own weight, 5 mm, and again after each bounce.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine m = hoist();
    m.model.step.integrator = integrator;
    m.cables[0].cut_time.reset();
    m.cables[0].axial_stiffness = 1e5;
    const Certificate certificate = test::checked_run(m, 1.0);
    EXPECT_TRUE(certificate.clean(1e-3)) << certificate.worst()->sentence();
  }
}

TEST(HeavyCut, HidesNoGainAfterIt) {
  // A load that is kicked by the program, after the cut, is a gain.
  const Certificate certificate = test::checked_run(hoist(), 1.0, 0.75, 1.5);
  EXPECT_FALSE(certificate.clean(1e-3));
}

}  // namespace
}  // namespace sheave::heavy_cut
