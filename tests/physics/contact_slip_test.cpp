// Friction takes energy by the way that points of contact slip, and never gives any back.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/certificate/evidence.h"
#include "engine/shapes/capsule.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::Heap;

/// What friction gives at points of contact by their ways [J], in substeps of `rattle` without an
/// impact or of `xpbd`.
double friction_gives(const Heap& heap, int steps) {
  Simulation simulation = test::start(test::Machine{heap.model, {}});
  double given = 0.0;
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(simulation.world.step().ok());
    const certify::Evidence evidence(simulation, *simulation.world.last_substep());
    // Impacts are none of the way's.
    if (heap.surface.restitution > 0.0 && !evidence.rattle) continue;
    for (const certify::ContactEvidence& contact : evidence.contacts) {
      const Vector3 drag = contact.drag[0] + contact.drag[1];
      const Vector3& way = contact.slip;
      given += std::max(drag.dot(way - contact.normal * contact.normal.dot(way)), 0.0);
    }
  }
  return given;
}

/// Energy of motion at the start [J], of which Row::softness gives some 1e-7 back.
double starts_with(const BodyDef& body) {
  return 0.5 * body.mass.value() * body.velocity.squaredNorm();
}

void put_tilted_box(Heap& heap, double height, double angle) {
  heap.put(test::box({0.3, 0.3, 0.3}), {0.0, height, 0.0}, 2.0);
  heap.last().mobility = Mobility::planar;
  heap.last().axis = Vector3::UnitZ();
  heap.last().orientation = rotation_by({0.0, 0.0, angle});
}

// A tilted box lands on a spring, slides and stops. Where the second half of a substep of `rattle`
// stops what has slid in the first one, it has slid all the same.
TEST(ContactSlip, ABoxThatHasStoppedStaysInPlace) {
  for (const test::Method& method : test::methods) {
    if (method.solver != SolverKind::direct) continue;
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.step = test::direct_settings(method.integrator, 0.0012);
    heap.surface.friction = 0.65;
    heap.surface.compliance = 2e-5;
    heap.floor();
    put_tilted_box(heap, 0.15, 0.0984);
    heap.last().velocity = {-0.11, -0.025, 0.0};
    EXPECT_LT(friction_gives(heap, 60), 1e-6 * starts_with(heap.last()));
  }
}

// So has what the impulse of an impact stops: one corner bounces while the other one slides.
TEST(ContactSlip, ACornerStoppedByAnImpactStaysInPlace) {
  Heap heap(SolverKind::direct, IntegratorKind::rattle);
  heap.model.step = test::direct_settings(IntegratorKind::rattle, 0.003);
  heap.surface.friction = 0.908693;
  heap.surface.restitution = 0.157536;
  heap.floor();
  put_tilted_box(heap, 0.152, 0.0261552);
  heap.last().velocity = {-0.54975, -0.737364, 0.0};
  heap.last().angular_velocity = {0.0, 0.0, -1.98073};
  EXPECT_LT(friction_gives(heap, 10), 1e-6 * starts_with(heap.last()));
}

// A rod that leans in z lands while it moves in x: what slides in one direction has friction
// against it and none across. The floor's push turns it about its middle, so that its end slips in
// z in that substep; friction that holds it from then on does not bring that back.
TEST(ContactSlip, SlipAcrossFrictionIsNotReversed) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.step = test::direct_settings(method.integrator, 0.003);
    heap.model.step.solver = method.solver;
    heap.surface.friction = 1.5;
    heap.surface.compliance = 2e-5;
    heap.floor();
    const auto rod = test::make<Capsule>([](Capsule& s) {
      s.radius = 0.05;
      s.length = 0.4;
    });
    heap.put(rod, {0.0, 0.055 + 0.2 * std::sin(0.63), 0.0}, 1.3);
    heap.last().orientation = rotation_by({0.63, 0.0, 0.0});
    heap.last().velocity = {0.124, -1.48, 0.0};
    EXPECT_LT(friction_gives(heap, 60), 1e-6 * starts_with(heap.last()));
  }
}

}  // namespace
}  // namespace sheave
