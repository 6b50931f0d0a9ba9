// The work of sources in the balance of a run's energy: sources that do no work leave the balance
// as strict as without them, and the work of all others is accounted for.

#include "cable/certificate/source_work.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "cable/run_check.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"

namespace sheave {
namespace {

using test::checked_run;
using test::g;

std::string worst_of(const Certificate& certificate) {
  return certificate.worst() == nullptr ? "" : certificate.worst()->sentence();
}

/// Relative error of the run's energy; 0 if another figure is the worst of its kind.
double off_by(const Certificate& certificate) {
  const CertificateItem* item = certificate.find(CertificateItem::Kind::energy);
  return item != nullptr && item->name == "the whole run" ? item->relative : 0.0;
}

BodyDef far_wheel() { return test::wheel("far wheel", {50.0, 0.0, 0.0}, 0.1, 0.005); }

/// Adds one kind of source that no force connects with the machine.
using Source = std::function<void(Model&)>;
std::vector<std::pair<std::string, Source>> idle_sources() {
  return {{"speed drive",
           [](Model& model) {
             BodyDef wheel = far_wheel();
             wheel.drive = DriveKind::speed;
             wheel.drive_values = {1.0};
             model.bodies.insert(model.bodies.begin(), wheel);
           }},
          {"torque drive of 0",
           [](Model& model) {
             BodyDef wheel = far_wheel();
             wheel.drive = DriveKind::torque;
             wheel.drive_values = {0.0};
             model.bodies.insert(model.bodies.begin(), wheel);
           }},
          {"moving body", [](Model& model) {
             BodyDef body = test::lump("moving", {50.0, 0.0, 0.0}, 1.0);
             body.mobility = Mobility::kinematic;
             body.oscillation = {0.0, 1.0, 0.0};
             body.oscillation_frequency = 1.0;
             model.bodies.insert(model.bodies.begin(), body);
           }}};
}

/// A pendulum of 1 m and 1 kg from 1 rad, beside a source. It is lowest at 0.537 s.
test::Machine pendulum_beside(const Source& source, IntegratorKind integrator, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(integrator, 1.0 / 60.0, substeps);
  source(m.model);
  m.model.add(test::lump("bob", {std::sin(1.0), -std::cos(1.0), 0.0}, 1.0));
  const int bob = static_cast<int>(m.model.bodies.size()) - 1;
  m.cables.push_back(test::cable("rope", {test::attach(BodyId::world()), test::attach({bob})}));
  return m;
}

TEST(SourceWork, AnIdleSourceHidesNoGain) {
  // A fifth of the swing is added, of which there is 1.2 then: a sixth. The energy of `rattle`
  // swings by (3.1 / 60)^2 / 8 = 3e-4, and a step beside the lowest point less is in motion.
  for (const auto& [name, source] : idle_sources()) {
    for (const int substeps : {1, 4}) {
      SCOPED_TRACE(name + ", " + std::to_string(substeps));
      const test::Machine m = pendulum_beside(source, IntegratorKind::rattle, substeps);
      EXPECT_TRUE(checked_run(m, 2.0).clean()) << worst_of(checked_run(m, 2.0));
      const Certificate all = checked_run(m, 1.0, 0.537, std::sqrt(1.2));
      EXPECT_NEAR(off_by(all), 1.0 / 6.0, 0.01);
      EXPECT_FALSE(all.clean());
    }
  }
}

TEST(SourceWork, AnIdleSourceHidesNoLoss) {
  for (const auto& [name, source] : idle_sources()) {
    SCOPED_TRACE(name);
    const test::Machine m = pendulum_beside(source, IntegratorKind::rattle, 4);
    EXPECT_NEAR(off_by(checked_run(m, 1.0, 0.537, std::sqrt(0.5))), 0.5, 0.01);
  }
}

TEST(SourceWork, ALightCartBesideAnIdleDriveIsDoubtful) {
  // The sweeps stop the bob below the cart, and the energy of its swing is gone.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 60.0, 8, 20);
  m.model.step.solver = SolverKind::gauss_seidel;
  m.model.step.integrator = IntegratorKind::xpbd;
  idle_sources()[0].second(m.model);
  BodyDef cart = test::weight("cart", Vector3::Zero(), 1e-4);
  cart.axis = Vector3::UnitX();
  m.model.add(cart);
  m.model.add(test::lump("bob", {std::sin(1.0), -std::cos(1.0), 0.0}, 1.0));
  m.cables.push_back(test::cable("rope", {test::attach({1}), test::attach({2})}));
  const Certificate all = checked_run(m, 2.0);
  EXPECT_GT(off_by(all), 0.5);
  EXPECT_FALSE(all.clean());
}

TEST(SourceWork, AnUnconnectedForceHidesNoGain) {
  const Source stone = [](Model& model) {
    model.bodies.insert(model.bodies.begin(), test::weight("stone", {50.0, 0.0, 0.0}, 1.0));
  };
  Simulation s = test::start(pendulum_beside(stone, IntegratorKind::rattle, 4));
  RunCheck check(s);
  for (int i = 0; i < 60; ++i) {
    if (i == 5) {
      // The stone falls by g t^2 / 2 = 5 m in 1 s, so the work is 0.5 J.
      ASSERT_TRUE(s.world.set_force({0}, {.force = Vector3(0.0, 0.1, 0.0)}).empty());
    }
    if (i == 32) {
      State state = s.world.state();
      state.bodies.back().velocity *= std::sqrt(1.5);
      ASSERT_TRUE(s.world.restore(state).empty());
    }
    const StepReport report = s.step({}, check.within(s), {});
    ASSERT_TRUE(report.ok());
    check.observe(s, report.statistics);
  }
  EXPECT_FALSE(check.certificate().clean());
}

/// A weight of 2 kg on a drum of 0.25 m.
test::Machine winch(DriveKind kind, const std::vector<double>& times,
                    const std::vector<double>& values) {
  test::Machine m = test::Atwood{}.machine();
  m.model.bodies[0].drive = kind;
  m.model.bodies[0].drive_times = times;
  m.model.bodies[0].drive_values = values;
  return m;
}

test::Machine shaken_pendulum() {
  test::Machine m;
  m.model.gravity = test::down;
  BodyDef hand = test::lump("hand", Vector3::Zero(), 1.0);
  hand.mobility = Mobility::kinematic;
  hand.oscillation = {0.1, 0.05, 0.0};
  hand.oscillation_frequency = 0.5;
  m.model.add(hand);
  m.model.add(test::lump("bob", {0.0, -1.0, 0.0}, 1.0));
  m.cables.push_back(test::cable("rope", {test::attach({0}), test::attach({1})}));
  return m;
}

test::Machine fed_weight() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.add(test::weight("weight", {0.0, -3.0, 0.0}, 2.0));
  auto end = test::attach(BodyId::world());
  end->feed_speed = -0.5;
  m.cables.push_back(test::cable("rope", {end, test::attach({0})}));
  return m;
}

test::Machine driven_hinge(CoordinateDrive kind, double value) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.add(test::lump("arm", {0.0, -1.0, 0.0}, 1.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = {0};
  hinge->angle.drive = kind;
  hinge->angle.drive_values = {value};
  hinge->angle.drive_amplitude = 0.5;
  hinge->angle.drive_frequency = 1.0;
  m.model.joints.push_back(hinge);
  return m;
}

TEST(SourceWork, WorkingSourcesAreNoFault) {
  const std::vector<std::pair<std::string, test::Machine>> machines{
      {"winch", winch(DriveKind::speed, {0.0, 0.5, 1.0, 1.5}, {0.0, 4.0, 4.0, -2.0})},
      {"winch that starts at once", winch(DriveKind::speed, {}, {4.0})},
      {"angle", winch(DriveKind::angle, {0.0, 0.5, 1.0}, {0.0, 1.0, -1.0})},
      {"torque table", winch(DriveKind::torque, {0.0, 0.5, 1.0}, {0.0, 6.0, 1.0})},
      {"shaken pendulum", shaken_pendulum()},
      {"feed", fed_weight()},
      {"hinge with a torque", driven_hinge(CoordinateDrive::force, 3.0)},
      {"hinge with a speed", driven_hinge(CoordinateDrive::speed, 2.0)}};
  for (const auto& [name, machine] : machines) {
    for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
      for (const int substeps : {1, 2, 4, 16, 64}) {
        SCOPED_TRACE(name + ", " + std::to_string(substeps) +
                     (integrator == IntegratorKind::xpbd ? ", xpbd" : ", rattle"));
        test::Machine m = machine;
        m.model.step = test::direct_settings(integrator, 1.0 / 60.0, substeps);
        // The winch that starts at once has its load at the wheel after 2 s.
        EXPECT_LT(off_by(checked_run(m, 1.9)), 0.01) << worst_of(checked_run(m, 1.9));
      }
    }
  }
}

TEST(SourceWork, AWorkingDriveHidesNoLargeGain) {
  // The drum lifts 1 kg by 1 m in 1 s and lowers 2 kg: it exchanges at most 30 J beside its own
  // start. The bob at its lowest point has 4.5 J, and 5 times as much afterwards.
  for (const int substeps : {1, 4, 16}) {
    test::Machine m = winch(DriveKind::speed, {}, {-4.0});
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
    m.model.add(test::lump("bob", {10.0 + std::sin(1.0), -std::cos(1.0), 0.0}, 1.0));
    m.cables.push_back(test::cable(
        "pendulum", {test::attach(BodyId::world(), {10.0, 0.0, 0.0}), test::attach({3})}));
    EXPECT_LT(off_by(checked_run(m, 1.0)), 0.01) << worst_of(checked_run(m, 1.0));
    const Certificate all = checked_run(m, 1.0, 0.537, std::sqrt(5.0));
    EXPECT_GT(off_by(all), 0.1);
    EXPECT_FALSE(all.clean());
  }
}

TEST(SourceWork, TheBoundOfAWinchIsItsWork) {
  // A drum of 0.25 m turns at 4 rad/s and lifts 2 kg: T r w = 19.6 W in steady motion.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  BodyDef drum = test::wheel("drum", Vector3::Zero(), 0.25, 0.05);
  drum.drive = DriveKind::speed;
  drum.drive_values = {4.0};
  m.model.add(drum);
  BodyDef load = test::weight("load", {0.25, -3.0, 0.0}, 2.0);
  load.velocity = {0.0, 1.0, 0.0};
  m.model.add(load);
  auto end = test::roll({0}, test::right);
  end->stored_length = 1.0;
  m.cables.push_back(test::cable("rope", {end, test::attach({1})}));
  Simulation s = test::start(m);
  certify::SourceWork work(s);
  ASSERT_TRUE(work.any());
  for (int i = 0; i < 30; ++i) {
    const double before = s.world.energy().total();
    int begun = 0;
    const StepReport report = s.step({},
                                     [&] {
                                       if (begun++ > 0) work.observe(s);
                                     },
                                     {});
    ASSERT_TRUE(report.ok());
    work.observe(s);
    const certify::SourceWork::Work done = work.take(s, report.statistics);
    ASSERT_TRUE(done.known);
    if (i < 5) continue;
    EXPECT_NEAR(done.most, 2.0 * g / 60.0, 1e-9);
    EXPECT_NEAR(std::abs(s.world.energy().total() - before), done.most, 1e-9);
  }
}

}  // namespace
}  // namespace sheave
