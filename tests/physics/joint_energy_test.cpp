// What the certificate says of energy that joints make or take beside their laws.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/universal.h"
#include "tests/support/builders.h"
#include "tests/support/rounding.h"

namespace sheave::test::joint_energy {
namespace {

using Kind = CertificateItem::Kind;

constexpr double give = 1e-6;  // [m/N]
constexpr double mass = 2.0;

/// Two weights on rails, the lower one on the upper one, that on the world by springs: of points
/// that meet, or of distances of 1 m.
template <class Joint>
Machine springs() {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = settings(0.01, 1, 1);
  BodyId above;
  for (const char* name : {"upper", "lower"}) {
    const Vector3 place =
        machine.model.bodies.empty() ? Vector3(Vector3::Zero()) : -Vector3::UnitY();
    BodyDef body = lump(name, place, mass);
    body.mobility = Mobility::slider;
    body.axis = Vector3::UnitY();
    const BodyId id = machine.model.add(body);
    auto joint = std::make_shared<Joint>();
    joint->name = name;
    joint->body_a = above;
    joint->body_b = id;
    if constexpr (std::is_same_v<Joint, DistanceJoint>) {
      joint->anchor_a = place + Vector3::UnitY();
      joint->anchor_b = place;
    } else {
      joint->anchor = place;
    }
    joint->compliance = give;
    machine.model.joints.push_back(joint);
    above = id;
  }
  return machine;
}

/// By how much the springs are too long.
std::array<double, 2> gaps(const World& world) {
  const double upper = world.state().bodies[0].position.y();
  return {upper, world.state().bodies[1].position.y() + 1.0 - upper};
}

// One sweep leaves the lower spring longer than its force asks for. Implicit Euler takes m dv^2 / 2
// of each weight and dg^2 / 2c of each spring; what else the energy changes by is (f + g / c) dg of
// each spring with the force f, which nothing explains. Energies of 2 m g x 1 m and springs of 1e-5
// m, to which lengths of 1 m are known to eps, are known to some eps of that.
template <class Joint>
void sweep_springs() {
  Simulation simulation = start(springs<Joint>());
  const World& world = simulation.world;
  for (int i = 0; i < 10; ++i) {
    const State before = world.state();
    const std::array<double, 2> short_by = gaps(world);
    const double energy = world.energy().total();
    ASSERT_TRUE(simulation.world.step().ok());
    const std::array<double, 2> long_by = gaps(world);
    double taken = 0.0;
    std::array<double, 2> made{};
    for (std::size_t k = 0; k < 2; ++k) {
      const double opened = long_by[k] - short_by[k];
      const double force = joint_reports(world)[k].force.y();
      made[k] = (force + long_by[k] / give) * opened;
      const double change = (world.state().bodies[k].velocity - before.bodies[k].velocity).norm();
      taken += 0.5 * mass * change * change + 0.5 * opened * opened / give;
    }
    const double rounding = 64.0 * eps * 2.0 * mass * g;
    EXPECT_NEAR(world.energy().total() - energy, made[0] + made[1] - taken, rounding);
    const CertificateItem item = *simulation.certificate()->find(Kind::energy);
    const bool upper = item.name.find("upper") != std::string::npos;
    const bool lower = item.name.find("lower") != std::string::npos;
    const double told = upper ? made[0] : lower ? made[1] : made[0] + made[1];
    EXPECT_NEAR(item.value, std::abs(told), rounding) << item.name;
    EXPECT_GT(item.relative, 0.01) << item.sentence();
  }
}
TEST(JointEnergy, FindsSpringsThatSweepsLeaveTooLong) { sweep_springs<BallJoint>(); }
TEST(JointEnergy, FindsDistancesThatSweepsLeaveTooLong) { sweep_springs<DistanceJoint>(); }

TEST(JointEnergy, SpringsThatObeyTheirLawCreateNone) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Machine machine = springs<DistanceJoint>();
    machine.model.step = direct_settings(integrator, 0.01);
    Simulation simulation = start(machine);
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      EXPECT_TRUE(simulation.certificate()->clean(1e-9))
          << simulation.certificate()->worst()->sentence();
    }
  }
}

/// A bar of 1 m that hangs aslant from a ball joint with a damper of 50 N m s / rad.
Certificate of_damped_bar(SolverKind solver) {
  Machine machine;
  machine.model.gravity = down;
  machine.model.step = direct_settings(IntegratorKind::xpbd, 0.01);
  machine.model.step.solver = solver;
  machine.model.step.iterations = solver == SolverKind::direct ? 50 : 2;
  BodyDef bar = lump("bar", {0.5, -0.5, 0.2}, mass);
  bar.inertia = Vector3(0.02, 0.16, 0.16);
  const BodyId id = machine.model.add(bar);
  auto joint = std::make_shared<BallJoint>();
  joint->name = "neck";
  joint->body_b = id;
  joint->damping = 50.0;
  machine.model.joints.push_back(joint);
  Simulation simulation = start(machine);
  Certificate all;
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(simulation.world.step().ok());
    all.merge(*simulation.certificate());
  }
  return all;
}

// By its law a damper takes c w^2; one that sweeps have left with another torque does not.
TEST(JointEnergy, FindsADamperThatMissesItsLaw) {
  const Certificate swept = of_damped_bar(SolverKind::gauss_seidel);
  EXPECT_GT(swept.find(Kind::energy)->relative, 0.01) << swept.find(Kind::energy)->sentence();
  const Certificate solved = of_damped_bar(SolverKind::direct);
  EXPECT_TRUE(solved.clean(1e-6)) << solved.worst()->sentence();
}

// What locks rigidly is where it is at the end of the substep, not the mean of both ends: of the
// right angle between the axes, off by e, the joint reports e and the certificate sin e. (A body
// that turns about its centre of mass opens nothing else.)
TEST(JointEnergy, MeasuresARightAngleThatSweepsLeaveOpen) {
  Machine machine;
  machine.model.step = settings(0.05, 1, 1);
  machine.model.step.integrator = IntegratorKind::rattle;
  BodyDef body = lump("body", Vector3::Zero(), mass);
  body.inertia = Vector3(0.08, 0.16, 0.1);
  body.angular_velocity = {1.0, 2.0, 3.0};
  const BodyId id = machine.model.add(body);
  auto joint = std::make_shared<UniversalJoint>();
  joint->name = "cross";
  joint->body_b = id;
  joint->axis_a = Vector3::UnitX();
  joint->axis_b = Vector3::UnitY();
  machine.model.joints.push_back(joint);
  Simulation simulation = start(machine);
  ASSERT_TRUE(simulation.world.step().ok());
  const double off = joint_reports(simulation.world)[0].angle_error;
  const CertificateItem item = *simulation.certificate()->find(Kind::joint);
  ASSERT_GT(off, 1e-4);
  ASSERT_EQ(item.unit, "rad") << item.sentence();
  EXPECT_NEAR(item.value, off, off * off * off);
}

}  // namespace
}  // namespace sheave::test::joint_energy
