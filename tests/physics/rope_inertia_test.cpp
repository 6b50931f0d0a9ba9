// Ropes with axial inertia (cable/rope_inertia.h): closed forms of variable mass, and
// conservation of momentum and energy.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "engine/body_set.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::rope_inertia {
namespace {

using test::accurate;
using test::attach;
using test::cable;
using test::roll;
using test::step_of;

CableDef heavy(std::initializer_list<std::shared_ptr<const LinkDef>> links, double density,
               double stiffness) {
  CableDef rope = cable("rope", links);
  rope.linear_density = density;
  rope.axial_stiffness = stiffness;
  rope.axial_inertia = true;
  return rope;
}

struct Course {
  Vector3 position = Vector3::Zero();
  double drift = 0.0;  ///< largest change of the energy and the loss by creep [J]
};

Course run(Simulation& s, int body, double time) {
  const auto energy = [&] { return s.world.energy().total() + s.cable_reports()[0].creep_loss; };
  const double before = energy();
  Course course;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    course.drift = std::max(course.drift, std::abs(energy() - before));
  }
  course.position = s.world.position({body});
  return course;
}

Course run(const test::Machine& machine, int body, double time) {
  Simulation s = test::start(machine);
  return run(s, body, time);
}

/// A load below the world's origin on 100 m of rope of 1.05 kg/m.
test::Machine tonne(const StepSettings& step, double load) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::weight("load", {0.0, -100.0, 0.0}, load));
  m.cables.push_back(heavy({attach(BodyId::world()), attach({0})}, 1.05, 13e6));
  m.cables[0].pretension = 0.9 * (load + 52.5) * test::g;
  return m;
}

/// Time of a whole vibration of the load [s], by the zeros of its velocity.
double period(const test::Machine& machine, double most) {
  Simulation s = test::start(machine);
  std::vector<double> zeros;
  double before = 0.0;
  double then = 0.0;
  while (s.world.state().time < most) {
    EXPECT_TRUE(s.world.step().ok());
    const double now = s.world.velocity({0}).y();
    const double time = s.world.state().time;
    if (before != 0.0 && (before < 0.0) != (now < 0.0)) {
      zeros.push_back(then + (time - then) * before / (before - now));
    }
    before = now;
    then = time;
  }
  if (zeros.size() < 2) return 0.0;
  return 2.0 * (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
}

TEST(RopeInertia, LetsALoadVibrateWithAThirdOfTheRope) {
  // Under a force of 1 kN the rope begins with 1.1 kN. (m + rho L / 3) y'' = -(EA / L) y.
  for (const bool falls : {false, true}) {
    for (const double load : {1000.0, 1.0, 1e-3}) {
      if (falls && load < 1000.0) continue;  // the rope would hang loose above its lower end
      test::Machine m = tonne(accurate(1), load);
      if (!falls) {
        m.model.gravity.setZero();
        m.model.bodies[0].force = {0.0, -1000.0, 0.0};
      }
      if (!falls) m.cables[0].pretension = 1100.0;
      const double length = 100.0 / (1.0 + *m.cables[0].pretension / 13e6);
      const double rate = std::sqrt(13e6 / length / (load + 1.05 * length / 3.0));
      m.model.step.dt = 0.002 * 2.0 * pi / rate;
      // The midpoint rule lengthens the period by (w h)^2 / 12 = 1.3e-5.
      const double expected = 1.0 + 1.3e-5;
      EXPECT_NEAR(period(m, 20.0 * pi / rate) / (2.0 * pi / rate), expected, 3e-6) << load;
    }
  }
}

/// Two weights over a wheel, on a rope of 1 kg/m, all at rest.
test::Machine atwood(const StepSettings& step, double load, double inertia) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("wheel", Vector3::Zero(), 0.5, inertia));
  m.model.add(test::weight("light", {-0.5, -20.0, 0.0}, load));
  m.model.add(test::weight("heavy", {0.5, -22.0, 0.0}, load));
  m.cables.push_back(heavy({attach({1}), roll({0}, test::right), attach({2})}, 1.0, 1e7));
  m.cables[0].pretensions = {(load + 10.0) * test::g, (load + 11.0) * test::g};
  return m;
}

TEST(RopeInertia, RunsOverAWheelByTheHyperbolicCosine) {
  for (const double inertia : {0.125, 1e-6}) {
    for (const double load : {10.0, 1.5}) {
      // All mass moves at one speed: k^2 = 2 rho g / (m1 + m2 + rho (42 m + pi r) + I / r^2).
      const double mass = 2.0 * load + 42.0 + 0.5 * pi + inertia / 0.25;
      const double rate = std::sqrt(2.0 * test::g / mass);
      const Course course = run(atwood(accurate(16), load, inertia), 1, 1.0);
      // The strain of 3e-5 on 20 m, and its vibration.
      EXPECT_NEAR(course.position.y() + 20.0, std::cosh(rate) - 1.0, 6e-4)
          << load << " " << inertia;
    }
  }
}

/// A load of 100 kg, 10 m below a drum that turns freely, with 50 m of rope of 2 kg/m on it.
test::Machine drum(const StepSettings& step, double load) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("drum", Vector3::Zero(), 0.5, 1.0));
  m.model.add(test::weight("load", {0.5, -10.0, 0.0}, load));
  auto coil = std::make_shared<SpoolLink>();
  coil->body = BodyId{0};
  coil->winding = test::right;
  coil->stored_length = 50.0;
  m.cables.push_back(heavy({coil, attach({1})}, 2.0, 1e7));
  m.cables[0].pretension = (load + 10.0) * test::g;
  return m;
}

TEST(RopeInertia, RunsOffADrumAsOffATable) {
  for (const double load : {100.0, 20.0}) {
    // Rope on the drum has the speed of the load, as a chain that runs off a smooth table has:
    // (m + rho 60 m + I / r^2) x'' = (m + rho x) g for the free length x, with
    // x + m / rho = (10 m + m / rho) cosh(k t).
    const double mass = load + 2.0 * 60.0 + 1.0 / 0.25;
    const double rate = std::sqrt(2.0 * test::g / mass);
    const Course course = run(drum(accurate(16), load), 1, 1.0);
    const double start = 10.0 + load / 2.0;
    // The stretch of 12 m under 1.1 kN is 1.3 mm; half of it goes when the load accelerates.
    EXPECT_NEAR(-course.position.y(), start * std::cosh(rate) - load / 2.0, 1.5e-3) << load;
    // Of 2 kJ of weight that become motion.
    EXPECT_LE(course.drift, 0.2) << load;
  }
}

TEST(RopeInertia, HasTheTensionsOfAHoistThatAccelerates) {
  // A drum of 0.5 m that is driven from rest at -4 rad/s2 hauls a load of 200 kg up at 2 m/s2, on 30 m of
  // 2 kg/m. Damping ends the vibration of the start.
  test::Machine m = drum(accurate(8), 200.0);
  m.model.bodies[1].mass = 200.0;
  m.model.bodies[1].position = {0.5, -30.0, 0.0};
  m.model.bodies[0].drive = DriveKind::speed;
  m.model.bodies[0].drive_times = {0.0, 10.0};
  m.model.bodies[0].drive_values = {0.0, 40.0};
  m.cables[0].axial_damping = 3e5;
  m.cables[0].pretension = 230.0 * test::g;
  Simulation s = test::start(m);
  while (s.world.state().time < 3.0) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  const double acceleration = 2.0;
  const double free = report.spans[0].rest_length;
  EXPECT_NEAR(s.world.velocity({1}).y(), 6.0, 1e-3);
  const double whole = test::g + acceleration;
  EXPECT_NEAR(report.spans[0].end_force.norm(), 200.0 * whole, 1e-3 * 200.0 * whole);
  EXPECT_NEAR(report.spans[0].start_force.norm(), (200.0 + 2.0 * free) * whole,
              1e-3 * 260.0 * whole);
}

/// Two bodies of a few kg in space, without gravity, that tumble at the ends of 3 m of rope of
/// `density`. The attachments are beside the centres of mass.
test::Machine tumbling(const StepSettings& step, double density) {
  test::Machine m;
  m.model.step = step;
  BodyDef one = test::lump("one", {0.0, 0.0, 0.0}, 3.0);
  one.velocity = {0.0, -1.0, 0.4};
  one.angular_velocity = {0.2, 0.1, -0.5};
  BodyDef other = test::lump("other", {3.0, 0.0, 0.0}, 2.0);
  other.velocity = {0.1, 2.0, 0.0};
  m.model.add(one);
  m.model.add(other);
  m.cables.push_back(
      heavy({attach({0}, {0.1, 0.05, 0.0}), attach({1}, {-0.1, 0.0, 0.05})}, density, 2e3));
  return m;
}

/// Linear and angular momentum of the tumbling bodies and their rope, about the origin.
std::array<Vector3, 2> momentum_of(const Simulation& s) {
  std::array<Vector3, 2> sum{Vector3::Zero(), Vector3::Zero()};
  for (const int i : {0, 1}) {
    const BodyState& body = s.world.state().bodies[static_cast<std::size_t>(i)];
    const BodyProperties& own = s.world.bodies()[i];
    const Matrix3 turn = body.orientation.toRotationMatrix();
    const Vector3 spin = turn * (own.inertia * (turn.transpose() * body.angular_velocity));
    sum[0] += own.mass * body.velocity;
    sum[1] += own.mass * body.position.cross(body.velocity) + spin;
  }
  const SpanReport span = s.cable_reports()[0].spans[0];
  const CableDef& rope = (*s.cable_definitions)[0];
  const auto velocity = [&](int i, const Vector3& point) -> Vector3 {
    const BodyState& body = s.world.state().bodies[static_cast<std::size_t>(i)];
    return body.velocity + body.angular_velocity.cross(point - body.position);
  };
  const Vector3 u0 = velocity(0, span.start);
  const Vector3 u1 = velocity(1, span.end);
  const double mass = rope.linear_density * span.rest_length;
  sum[0] += 0.5 * mass * (u0 + u1);
  sum[1] += mass / 6.0 *
            (2.0 * span.start.cross(u0) + span.start.cross(u1) + span.end.cross(u0) +
             2.0 * span.end.cross(u1));
  return sum;
}

TEST(RopeInertia, KeepsTheMomentumOfBodiesInSpace) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    for (const double density : {0.5, 20.0}) {
      Simulation s = test::start(tumbling(step_of(SolverKind::direct, integrator, 16), density));
      const auto before = momentum_of(s);
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      const auto after = momentum_of(s);
      // The impulses of a substep sum to the change of the rope's momentum. The solver leaves up to
      // 1e-10 of the scene's 3 m, a velocity of 3e-7 m/s of the rope, in each of 960 substeps.
      const double left = 3.0 * density * 1e-10 * 3.0 * 960.0;
      EXPECT_LE((after[0] - before[0]).norm(), 960.0 * left) << density;
      if (integrator == IntegratorKind::xpbd) continue;  // of first order
      EXPECT_LE((after[1] - before[1]).norm(), 1e-4 * before[1].norm()) << density;
    }
  }
}

/// A sheave in a block of 100 kg that moves in the plane, between a fixed end and a wheel, with a bob
/// at the other end of the rope.
test::Machine block(const StepSettings& step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef body = test::lump("block", {0.5, -20.0, 0.0}, 100.0);
  body.mobility = Mobility::planar;
  body.axis = Vector3::UnitZ();
  body.velocity = {1.0, 1.0, 0.0};
  m.model.add(body);
  m.model.add(test::sheave("sheave", {0}, {0.5, -20.0, 0.0}, 0.5, 10.0, 1.25));
  m.model.add(test::wheel("top", {1.5, 0.0, 0.0}, 0.5, 1.25));
  BodyDef bob = test::lump("bob", {2.2, -10.0, 0.0}, 60.0);
  bob.mobility = Mobility::planar;
  bob.axis = Vector3::UnitZ();
  m.model.add(bob);
  m.cables.push_back(
      heavy({attach(BodyId::world()), roll({1}, test::left), roll({2}, test::right), attach({3})},
            1.0, 1e5));
  m.cables[0].pretension = 650.0;
  return m;
}

TEST(RopeInertia, KeepsTheEnergyToSecondOrder) {
  // In space, with attachments at the centres of mass and a rope that is taut from the start.
  std::vector<double> drifts;
  for (const int substeps : {8, 16, 32}) {
    test::Machine m = tumbling(accurate(substeps), 2.0);
    m.cables[0].links = {attach({0}), attach({1})};
    m.cables[0].rest_lengths = {2.9};
    drifts.push_back(run(m, 1, 0.5).drift);
  }
  EXPECT_NEAR(drifts[0] / drifts[1], 4.0, 0.1);
  EXPECT_NEAR(drifts[1] / drifts[2], 4.0, 0.1);
  // Beside the centres the residuals of rounds, some 1e-9 N s per substep, have the same size.
  EXPECT_LE(run(tumbling(accurate(16), 2.0), 1, 0.5).drift, 1e-5);
  // Over a wheel the rope vibrates, and the next order counts.
  drifts.clear();
  for (const int substeps : {4, 16}) {
    test::Machine m = atwood(accurate(substeps), 10.0, 0.125);
    m.cables[0].axial_stiffness = 1e8;
    drifts.push_back(run(m, 1, 0.25).drift);
  }
  EXPECT_GT(drifts[0] / drifts[1], 10.0) << drifts[1];
  // With a block that moves, the strain that rope keeps on wheels leaves as much as without inertia.
  test::Machine plain = block(accurate(8));
  plain.cables[0].axial_inertia = false;
  EXPECT_LE(run(block(accurate(8)), 3, 0.25).drift, 2.0 * run(plain, 3, 0.25).drift);
}

TEST(RopeInertia, GoesBackOnItsWay) {
  // Rope on wheels keeps its strain and creeps, so only a rope without wheels comes back.
  Simulation s = test::start(tumbling(accurate(16), 2.0));
  const std::vector<BodyState> before = s.world.state().bodies;
  for (int i = 0; i < 15; ++i) ASSERT_TRUE(s.world.step().ok());
  State state = s.world.state();
  for (BodyState& body : state.bodies) {
    body.velocity *= -1.0;
    body.angular_velocity *= -1.0;
  }
  ASSERT_TRUE(s.world.restore(state).empty());
  for (int i = 0; i < 15; ++i) ASSERT_TRUE(s.world.step().ok());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LE((s.world.state().bodies[i].position - before[i].position).norm(), 1e-6) << i;
  }
}

TEST(RopeInertia, MovesTheSameWithAllSolversAndIntegrators) {
  const auto at_end = [](SolverKind solver, IntegratorKind integrator, int substeps) {
    return run(block(step_of(solver, integrator, substeps)), 3, 0.1).position;
  };
  const Vector3 fine = at_end(SolverKind::direct, IntegratorKind::rattle, 64);
  const auto error = [&](IntegratorKind integrator, int substeps) {
    return (at_end(SolverKind::direct, integrator, substeps) - fine).norm();
  };
  EXPECT_NEAR(error(IntegratorKind::xpbd, 16) / error(IntegratorKind::xpbd, 32), 2.0, 0.3);
  EXPECT_NEAR(error(IntegratorKind::rattle, 8) / error(IntegratorKind::rattle, 16), 4.0, 1.0);
  EXPECT_LE((at_end(SolverKind::gauss_seidel, IntegratorKind::rattle, 32) -
             at_end(SolverKind::direct, IntegratorKind::rattle, 32))
                .norm(),
            1e-6);
}

TEST(RopeInertia, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    for (const test::Machine& m : {tonne(step, 100.0), atwood(step, 10.0, 0.125), block(step),
                                   drum(step, 100.0), tumbling(step, 2.0)}) {
      const Certificate certificate = test::checked_run(m, 0.25);
      EXPECT_TRUE(certificate.clean())
          << certificate.worst()->sentence() << " " << m.model.bodies[0].name;
    }
    EXPECT_FALSE(test::checked_run(atwood(step, 10.0, 0.125), 0.6, 0.5, 2.0).clean());
  }
}

TEST(RopeInertia, TurnsBackWithAWeightThatBounces) {
  // Without gravity a weight flies at 1 m/s to the floor, with a slack rope to a point above. Weight
  // and a third of the rope turn back together, with all of their energy.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine m;
    m.model.step = step_of(SolverKind::direct, integrator, 4);
    BodyDef ball = test::weight("ball", {0.0, 0.5, 0.0}, 1.0);
    ball.velocity = {0.0, -1.0, 0.0};
    auto shape = std::make_shared<Sphere>();
    shape->radius = 0.1;
    ball.shapes.push_back({shape});
    m.model.add(ball);
    BodyDef floor;
    floor.name = "floor";
    floor.mobility = Mobility::fixed;
    floor.shapes.push_back({std::make_shared<HalfSpace>()});
    m.model.add(floor);
    for (const int body : {0, 1}) {
      ColliderDef surface;
      surface.body = BodyId{body};
      surface.restitution = 1.0;
      m.model.colliders.push_back(surface);
    }
    m.cables.push_back(heavy({attach(BodyId::world(), {0.0, 1.0, 0.0}), attach({0})}, 6.0, 1e4));
    m.cables[0].rest_lengths = {1.0};
    Simulation s = test::start(m);
    const double before = s.world.energy().total();
    while (s.world.state().time < 0.6) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.world.velocity({0}).y(), 1.0, 1e-9);
    EXPECT_NEAR(s.world.energy().total(), before, 1e-9);
  }
}

TEST(RopeInertia, GoesOnFromASavedStateToTheBit) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const test::Machine m = block(step_of(SolverKind::direct, integrator, 4));
    Simulation whole = test::start(m);
    for (int i = 0; i < 6; ++i) ASSERT_TRUE(whole.world.step().ok());
    Simulation rest = test::start(m);
    ASSERT_TRUE(rest.world.restore(whole.world.state()).empty());
    for (int i = 0; i < 6; ++i) {
      ASSERT_TRUE(whole.world.step().ok());
      ASSERT_TRUE(rest.world.step().ok());
    }
    EXPECT_EQ(hash(whole.world.state()), hash(rest.world.state()));
  }
}

TEST(RopeInertia, LeavesWithARopeThatIsCut) {
  test::Machine m = drum(accurate(4), 100.0);
  m.cables[0].cut_time = 0.05;
  Simulation s = test::start(m);
  while (s.world.state().time < 0.1 - 1e-9) ASSERT_TRUE(s.world.step().ok());
  const double before = s.world.velocity({1}).y();
  const double then = s.world.state().time;
  while (s.world.state().time < 0.2 - 1e-9) ASSERT_TRUE(s.world.step().ok());
  const double time = s.world.state().time - then;
  EXPECT_NEAR(s.world.velocity({1}).y() - before, -test::g * time, 1e-9);
}

TEST(RopeInertia, EndsTheRunWhereTheWeightDoesNotTellTheShape) {
  // Behind a load of 10 g the falling side needs less than its weight at its lower end.
  Simulation s = test::start(atwood(accurate(4), 0.01, 0.125));
  StepReport report;
  for (int i = 0; i < 60 && report.ok(); ++i) report = s.world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.divergence->message.find("hangs loose"), std::string::npos);
  EXPECT_NE(report.divergence->message.find("of the rope \"rope\""), std::string::npos);
}

TEST(RopeInertia, RefusesOtherRopesByName) {
  const auto refusal = [](const test::Machine& machine) {
    const auto made = Simulation::create(machine.model, machine.cables);
    return made ? std::string() : made.errors()[0].message;
  };
  test::Machine m = atwood(accurate(1), 10.0, 0.125);
  m.cables[0].linear_density = 0.0;
  EXPECT_NE(refusal(m).find("needs \"linear_density\""), std::string::npos);
  m = atwood(accurate(1), 10.0, 0.125);
  m.cables[0].breaking_tension = 1e6;
  EXPECT_NE(refusal(m).find("does not break"), std::string::npos);
  m = atwood(accurate(1), 10.0, 0.125);
  m.model.bodies[0].spin_inertia = 0.0;
  EXPECT_NE(refusal(m).find("spin inertia only"), std::string::npos);
  m = atwood(accurate(1), 10.0, 0.125);
  auto lossy = std::make_shared<RollingLink>(*roll({0}, test::right));
  lossy->efficiency = 0.9;
  m.cables[0].links[1] = lossy;
  EXPECT_NE(refusal(m).find("without losses"), std::string::npos);
  m = atwood(accurate(1), 10.0, 0.125);
  auto hole = std::make_shared<PinholeLink>();
  hole->body = BodyId::world();
  m.cables[0].links[1] = hole;
  EXPECT_NE(refusal(m).find("does not slide through"), std::string::npos);
  m = atwood(accurate(1), 10.0, 0.125);
  auto fed = std::make_shared<AttachmentLink>(*attach({1}));
  fed->feed_speed = 0.1;
  m.cables[0].links[0] = fed;
  EXPECT_NE(refusal(m).find("is not fed"), std::string::npos);
}

}  // namespace
}  // namespace sheave::rope_inertia
