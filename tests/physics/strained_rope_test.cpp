// Cable of a material comes onto wheels with its strain (cable/cable_material.cpp).
//
// A drum winds up a load at constant speed: strain e = M g / EA, and in the time t the rim takes in
// R w t of stretched cable, R w t / (1 + e) unstretched. What hangs has the length l = (1 + e) L,
// so the load rises by (1 + e) R w t / (1 + e) = R w t.
//
// A belt that runs steadily passes everywhere the same unstretched length q per second. Onto the
// driving wheel it comes with the strain e1 of the tight side, onto the driven one with e2 of the
// slack side, and each rim runs as what comes onto it: v1 = (1 + e1) q, v2 = (1 + e2) q, so (v1 -
// v2) / v1 = (e1 - e2) / (1 + e1), Grashof's (T1 - T2) / EA to first order. On each wheel EA (e1 -
// e2)^2 / 2 q is lost, together (T1 - T2) (v1 - v2).

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

struct Settings {
  SolverKind solver;
  IntegratorKind integrator;
};
constexpr std::array all_settings{Settings{SolverKind::direct, IntegratorKind::rattle},
                                  Settings{SolverKind::direct, IntegratorKind::xpbd},
                                  Settings{SolverKind::gauss_seidel, IntegratorKind::rattle},
                                  Settings{SolverKind::gauss_seidel, IntegratorKind::xpbd}};

StepSettings step_of(const Settings& settings, double h, int iterations = 20) {
  StepSettings step = test::settings(h, 1, iterations);
  step.solver = settings.solver;
  step.integrator = settings.integrator;
  return step;
}

constexpr double radius = 0.25;
constexpr double mass = 40.0;
constexpr double hang = 3.0;

std::shared_ptr<SpoolLink> drum_link(BodyId body, double stored) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = test::left;
  link->stored_length = stored;
  return link;
}

/// A drum, body 0, about z; counter-clockwise cable comes off on its left side downwards; the load,
/// body 1. The drum takes in when it turns clockwise.
test::Machine hoist(double strain, const Settings& settings, double h) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_of(settings, h);
  const BodyId drum = m.model.add(test::wheel("drum", Vector3::Zero(), radius, 2.0));
  const BodyId load = m.model.add(test::weight("load", {-radius, -hang, 0.0}, mass));
  m.cables.push_back(test::cable("rope", {drum_link(drum, 5.0), test::attach(load)}));
  m.cables[0].axial_stiffness = mass * g / strain;
  m.cables[0].rest_lengths = {hang / (1.0 + strain)};
  return m;
}

TEST(StrainedRope, ALoadRisesAsFastAsTheRim) {
  for (const Settings& settings : all_settings) {
    for (const double strain : {0.049, 0.3}) {
      test::Machine m = hoist(strain, settings, 0.01);
      m.model.bodies[0].drive = DriveKind::speed;
      m.model.bodies[0].drive_values = {-2.0};
      m.model.bodies[1].velocity = {0.0, 2.0 * radius, 0.0};
      Simulation s = test::start(m);
      for (int i = 0; i < 270; ++i) ASSERT_TRUE(s.world.step().ok());
      // Lift and rim travel: 1.35 m.
      EXPECT_NEAR(s.world.position({1}).y() + hang, 2.0 * radius * 2.7, 1e-8);
      const CableReport report = s.cable_reports()[0];
      EXPECT_NEAR(report.spans[0].tension, mass * g, 1e-6 * mass * g);
      EXPECT_NEAR(report.spans[0].rest_length, (hang - 1.35) / (1.0 + strain), 1e-8);
      EXPECT_NEAR(report.links[0].stored_stretch, strain * report.links[0].stored_length, 1e-8);
      EXPECT_NEAR(report.length_error, 0.0, 1e-15);
      EXPECT_NEAR(report.creep_loss, 0.0, 1e-8);
    }
  }
}

// What was wound up under the load comes off with the same strain, whatever lies below: the load is
// back where it was. (With the mean strain of all that is on the drum it would hang 1 m x 4.9 % x
// 5/6 = 41 mm lower.)
TEST(StrainedRope, ALoadReturnsToItsStart) {
  for (const Settings& settings : all_settings) {
    test::Machine m = hoist(0.049, settings, 0.01);
    m.cables[0].rest_lengths = {hang};  // 5 m have been wound on without tension
    m.model.bodies[0].drive = DriveKind::angle;
    m.model.bodies[0].drive_times = {0.0, 4.0, 6.0, 8.0, 10.0};
    m.model.bodies[0].drive_values = {0.0, 0.0, -4.0, -4.0, 0.0};
    m.model.bodies[1].damping = 650.0;  // settles like e^(-8 t)
    Simulation s = test::start(m);
    test::run(s.world, 4.0);
    const double before = s.world.position({1}).y();
    EXPECT_NEAR(before, -1.049 * hang, 1e-9);
    test::run(s.world, 8.0);
    // The rim's way, and what the strain of the remaining rope lets it rise less or more while it
    // swings.
    EXPECT_GT(s.world.position({1}).y(), before + 0.9 * 4.0 * radius);
    test::run(s.world, 14.0);
    EXPECT_NEAR(s.world.position({1}).y(), before, 1e-8);
  }
}

/// Largest |energy + creep - start| [J] over 1 s, and the creep.
struct Balance {
  double error = 0.0;
  double creep = 0.0;
  double least_tension = std::numeric_limits<double>::infinity();
};
Balance balance(test::Machine m, double h) {
  m.model.step = step_of(all_settings[0], h);
  Simulation s = test::start(m);
  const double start = s.world.energy().total();
  Balance result;
  while (s.world.state().time < 1.0 - 0.5 * h) {
    EXPECT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    result.creep = report.creep_loss;
    for (const SpanReport& span : report.spans) {
      result.least_tension = std::min(result.least_tension, span.tension);
    }
    result.error =
        std::max(result.error, std::abs(s.world.energy().total() + result.creep - start));
  }
  return result;
}

/// Of second order: halving the step divides the error by four, twice.
Balance expect_second_order(const test::Machine& machine, double h) {
  const double coarse = balance(machine, h).error;
  const double fine = balance(machine, 0.5 * h).error;
  const Balance finest = balance(machine, 0.25 * h);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
  EXPECT_GT(std::log2(fine / finest.error), 1.8);
  return finest;
}

/// A drum with a flywheel winds in a load that swings on its rope.
test::Machine swinging_hoist(double speed, double damping_of_rope) {
  test::Machine m = hoist(0.05, all_settings[0], 1e-3);
  m.cables[0].rest_lengths = {hang / 1.03};
  m.cables[0].damping = damping_of_rope;
  m.model.bodies[0].inertia = Vector3(8.0, 8.0, 8.0);
  m.model.bodies[0].angular_velocity = {0.0, 0.0, -speed};
  m.model.bodies[1].velocity = {0.0, speed * radius, 0.0};
  return m;
}

TEST(StrainedRope, WindingInUnderAChangingLoadConservesEnergy) {
  const Balance result = expect_second_order(swinging_hoist(16.0, 0.0), 2e-3);
  EXPECT_GT(result.least_tension, 0.0);
  EXPECT_EQ(result.creep, 0.0);
  EXPECT_LT(result.error, 1e-6 * mass * g * hang);
}

// Turned by the load, it pays out under another tension than it took in, and loses what the report
// tells.
TEST(StrainedRope, PayingOutLosesTheReportedEnergy) {
  const Balance result = expect_second_order(swinging_hoist(3.0, 0.0), 2e-3);
  EXPECT_GT(result.creep, 1e-2);
  EXPECT_LT(result.error, 1e-6 * mass * g * hang);
}

/// Two weights of different mass on a stretched rope over a heavy wheel.
test::Machine elastic_atwood() {
  test::Machine m = test::Atwood{.m1 = 20.0, .m2 = 30.0, .inertia = 0.5}.machine();
  m.cables[0].axial_stiffness = 5000.0;
  m.cables[0].rest_lengths = {2.0 / 1.03, 2.0 / 1.05};
  return m;
}

TEST(StrainedRope, RunsOverAWheelFirstInFirstOut) {
  const Balance result = expect_second_order(elastic_atwood(), 2e-3);
  EXPECT_GT(result.creep, 0.0);
  EXPECT_LT(result.error, 1e-5 * 50.0 * g);
}

/// A belt stretched by `strain` from a driver at 10 rad/s to a follower that a drag holds back.
test::Machine braked_belt(double strain, double drag) {
  test::Machine m = test::belt(0.3, 0.2, 1.0, 0.03, 0.01);
  m.model.bodies[0].drive = DriveKind::speed;
  m.model.bodies[0].drive_values = {10.0};
  m.model.bodies[1].angular_velocity = {0.0, 0.0, 15.0};
  m.model.bodies[1].angular_damping = drag;
  const double span = std::sqrt(1.0 - 0.01);
  m.cables[0].axial_stiffness = 2000.0;
  m.cables[0].rest_lengths = {span / (1.0 + strain), span / (1.0 + strain)};
  return m;
}

TEST(StrainedRope, ABeltCreepsByTheLawOfGrashof) {
  for (const Settings& settings : all_settings) {
    test::Machine m = braked_belt(0.1, 1.0);
    m.model.step = step_of(settings, 2e-3, 40);
    Simulation s = test::start(m);
    test::run(s.world, 12.0);
    const CableReport before = s.cable_reports()[0];
    test::run(s.world, 13.0);
    const CableReport report = s.cable_reports()[0];
    const double slack = report.spans[0].tension;
    const double tight = report.spans[1].tension;
    const double v1 = 0.3 * 10.0;
    const double v2 = 0.2 * s.world.angular_velocity({1}).z();
    EXPECT_GT(tight - slack, 50.0);
    EXPECT_GT(slack, 20.0);
    EXPECT_NEAR(v2 / v1, (1.0 + slack / 2000.0) / (1.0 + tight / 2000.0), 1e-6);
    const double grashof = (tight - slack) / 2000.0;
    EXPECT_NEAR((v1 - v2) / v1, grashof / (1.0 + tight / 2000.0), 1e-6);
    EXPECT_NEAR((tight - slack) * 0.2, s.world.angular_velocity({1}).z() * 1.0, 1e-5);
    // What is lost in 1 s.
    const double lost = (tight - slack) * (v1 - v2);
    EXPECT_NEAR(report.creep_loss - before.creep_loss, lost, 1e-4 * lost);
    EXPECT_NEAR(report.length_error, 0.0, 1e-15);
  }
}

// By the reports alone: balances, springs and what rims move belong together in all of these
// machines, winding on and off.
TEST(StrainedRope, TheCertificateIsClean) {
  test::Machine back = hoist(0.049, all_settings[0], 0.01);
  back.cables[0].rest_lengths = {hang};
  back.model.bodies[0].drive = DriveKind::angle;
  back.model.bodies[0].drive_times = {0.0, 0.5, 1.0};
  back.model.bodies[0].drive_values = {0.0, -2.0, 0.0};
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (test::Machine machine :
         {back, swinging_hoist(3.0, 0.0), elastic_atwood(), braked_belt(0.1, 1.0)}) {
      machine.model.step = step_of({SolverKind::direct, integrator}, 1e-3);
      Simulation s = test::start(machine);
      Certificate all;
      for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(s.world.step().ok());
        if (const auto one = s.certificate()) all.merge(*one);
      }
      EXPECT_EQ(all.substeps, 1000);
      EXPECT_TRUE(all.clean(1e-3)) << all.worst()->sentence();
    }
  }
}

}  // namespace
}  // namespace sheave
