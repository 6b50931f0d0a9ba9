// Impacts of bodies that joints hold: the impulse passes on at once.
//
// With the unit normal n, the velocities v- before and v+ after an impact obey v+ = -e v- at the
// point of contact, and rigid joints keep their velocity 0. For two point masses m on a massless rod
// along d, an impulse P along n at the first changes the velocities by
//   dv1 = P / m (n - (d . n) / 2 d),   dv2 = P / m (d . n) / 2 d,
// so that with equal velocities -v n before, P = (1 + e) m v / (1 - (d . n)^2 / 2).

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "engine/index.h"
#include "engine/instants.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "tests/support/heaps.h"

namespace sheave::jointed_impact {
namespace {

using test::Heap;

constexpr double radius = 0.1;

/// A hinge of the world that holds `body` about an axis through the origin.
std::shared_ptr<HingeJoint> hinge_at_origin(BodyId body, const Vector3& axis) {
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_a = BodyId::world();
  hinge->body_b = body;
  hinge->anchor = Vector3::Zero();
  hinge->axis = axis;
  return hinge;
}
constexpr double rod = 0.5;
constexpr double drop = 0.45;  // so that the impact has 3 m/s at g = 10

/// Two balls on a rod at `angle` to the vertical, of which the lower one falls onto a floor.
struct Dumbbell {
  Dumbbell(const test::Method& method, int substeps, double angle, double restitution)
      : heap(method.solver, method.integrator), direction(std::sin(angle), std::cos(angle), 0.0) {
    heap.model.gravity = {0.0, -10.0, 0.0};
    heap.model.step.dt = 1.0 / 60.0;
    heap.model.step.substeps = substeps;
    heap.surface.restitution = restitution;
    heap.surface.friction = 0.0;
    heap.floor();
    const Vector3 low{0.0, radius + drop, 0.0};
    lower = heap.put(test::ball(radius), low);
    upper = heap.put(test::ball(radius), low + rod * direction);
    auto joint = std::make_shared<DistanceJoint>();
    joint->name = "rod";
    joint->body_a = lower;
    joint->body_b = upper;
    joint->anchor_a = low;
    joint->anchor_b = low + rod * direction;
    heap.model.joints.push_back(joint);
  }
  Heap heap;
  Vector3 direction;
  BodyId lower;
  BodyId upper;
};

TEST(JointedImpact, AnUprightRodBouncesAsOneBody) {
  for (const test::Method& method : test::methods) {
    for (const int substeps : {1, 4, 16, 64}) {
      for (const double restitution : {0.5, 1.0}) {
        SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(substeps) + " substeps");
        Dumbbell m(method, substeps, 0.0, restitution);
        World world = m.heap.start();
        // After 0.3 s it lands with 3 m/s; 0.1 s later it flies with 3 e - 1 m/s.
        test::run(world, 0.4);
        const double expected = 3.0 * restitution - 1.0;
        // The substep of the impact is done by `xpbd`, whose velocity lags by half a substep.
        const double tolerance = 10.0 / 60.0 / substeps + 1e-6;
        EXPECT_NEAR(world.velocity(m.lower).y(), expected, tolerance);
        EXPECT_NEAR(world.velocity(m.upper).y(), expected, tolerance);
        EXPECT_NEAR((world.position(m.upper) - world.position(m.lower)).norm(), rod, 1e-8);
      }
    }
  }
}

TEST(JointedImpact, ALeaningRodTurnsByTheLawOfImpulses) {
  for (const test::Method& method : test::methods) {
    for (const double angle : {-0.6, 0.3, 1.2}) {
      for (const double restitution : {0.5, 1.0}) {
        SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(angle));
        constexpr int substeps = 64;
        Dumbbell m(method, substeps, angle, restitution);
        World world = m.heap.start();
        // 18 steps of 1/60 s; the impact is at 0.3 s, so that one more step has it behind it.
        test::run(world, 19.0 / 60.0);
        constexpr double speed = 3.0;
        const Vector3 n = Vector3::UnitY();
        const double along = m.direction.y();
        const double impulse = (1.0 + restitution) * speed / (1.0 - 0.5 * along * along);
        const Vector3 first = -speed * n + impulse * (n - 0.5 * along * m.direction);
        const Vector3 second = -speed * n + impulse * 0.5 * along * m.direction;
        // Gravity goes on for 1/60 s, and the rod turns: its centripetal acceleration is w^2 l / 2,
        // with w l the velocity of one ball about the other.
        const double turning = (first - second).norm();
        const double tolerance = (10.0 + turning * turning / rod) / 60.0 + 0.01;
        EXPECT_LT((world.velocity(m.lower) - first).norm(), tolerance);
        EXPECT_LT((world.velocity(m.upper) - second).norm(), tolerance);
        // The sum of the momenta is that of impulse and weight. With the substep h, the moment of the
        // impact is off by h, so weights by 2 m g h and the speed by g h; the impulse by (1 + e) m g
        // h / (1 - 1/2) at most; a velocity of `xpbd` is that of h / 2 before: 70 h in all.
        EXPECT_NEAR(world.velocity(m.lower).y() + world.velocity(m.upper).y(),
                    (first + second).y() - 20.0 / 60.0, 70.0 / 60.0 / substeps);
      }
    }
  }
}

TEST(JointedImpact, WithoutLossKeepsTheEnergyOfChains) {
  for (const test::Method& method : test::methods) {
    for (const int count : {2, 5}) {
      SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(count) + " balls");
      Heap heap(method.solver, method.integrator);
      heap.model.gravity = {0.0, -10.0, 0.0};
      heap.model.step.dt = 1.0 / 240.0;
      heap.model.step.substeps = 16;
      heap.surface.restitution = 1.0;
      heap.surface.friction = 0.0;
      heap.floor();
      BodyId last;
      Vector3 place{0.0, radius + 0.2, 0.0};
      for (int i = 0; i < count; ++i) {
        const BodyId ball = heap.put(test::ball(radius), place);
        if (i > 0) {
          auto joint = std::make_shared<DistanceJoint>();
          joint->name = "rod " + std::to_string(i);
          joint->body_a = last;
          joint->body_b = ball;
          joint->anchor_a = heap.model.bodies[at(last.index)].position;
          joint->anchor_b = place;
          heap.model.joints.push_back(joint);
        }
        last = ball;
        place += Vector3{0.4 * std::sin(0.5 + 0.3 * i), 0.4 * std::cos(0.5 + 0.3 * i), 0.0};
      }
      World world = heap.start();
      const double energy = world.energy().total();
      test::run(world, 0.6);
      // Each impact is off by the work of gravity and of turning in one substep of `xpbd`: 3e-3 of
      // the energy at 1/3840 s (measured to fall with the substep).
      EXPECT_NEAR(world.energy().total(), energy, 0.02 * energy);
    }
  }
}

/// An Atwood machine with a block in the way of one of its weights, which reaches the block after
/// `way`.
struct Blocked {
  Blocked(const test::Method& method, int substeps, BodyId stopped, double restitution) {
    machine.model.step = test::settings(1.0 / 240.0, substeps, 60);
    machine.model.step.solver = method.solver;
    machine.model.step.integrator = method.integrator;
    const double sign = stopped.index == 1 ? 1.0 : -1.0;
    BodyDef& weight = machine.model.bodies[at(stopped.index)];
    weight.shapes.push_back({test::ball(radius)});
    BodyDef block;
    block.name = "block";
    block.mobility = Mobility::fixed;
    block.shapes.push_back({test::make<Box>([](Box& box) { box.size = Vector3(0.2, 0.2, 0.2); })});
    block.position = weight.position + Vector3(0.0, sign * (way + radius + 0.1), 0.0);
    const BodyId other = machine.model.add(block);
    for (const BodyId body : {stopped, other}) {
      ColliderDef collider;
      collider.body = body;
      collider.restitution = restitution;
      machine.model.colliders.push_back(collider);
    }
  }
  /// The impact happens within this time of the right one [s]: the search of instants leaves no
  /// shorter parts.
  [[nodiscard]] double slop() const { return instant_slop(machine.model.step); }

  static constexpr double way = 0.5;
  test::Atwood atwood;
  test::Machine machine = atwood.machine();
};

/// Rounding of a speed, 1e-16 of 2 m over the length of a substep, after some 1e4 substeps [m/s].
constexpr double rounding = 1e-9;

TEST(JointedImpact, ATautRopeTurnsTheOtherWeightRoundToo) {
  // The light weight of an Atwood machine rises against a ceiling. The rope is taut, so that both
  // weights and the wheel turn round with e times their velocity; the rope of a weight alone would
  // go slack. From rest at height 0 the ceiling is met at s, with v^2 = 2 a s. A drive of the wheel
  // adds to a. All accelerations are constant, so that `rattle` is exact but for the slop d of the
  // instant: places by (1 + e) v d, speeds by (1 + e) a d.
  for (const test::Method& method : test::methods) {
    const bool rattle = method.integrator == IntegratorKind::rattle;
    for (const int substeps : {1, 2, 16, 64}) {
      for (const double restitution : {0.5, 1.0}) {
        for (const double torque : {0.0, 2.0}) {
          SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(substeps) + " substeps, " +
                       std::to_string(torque) + " N m");
          const BodyId light{1};
          Blocked m(method, substeps, light, restitution);
          if (torque > 0.0) {
            m.machine.model.bodies[0].drive = DriveKind::torque;
            m.machine.model.bodies[0].drive_values = {-torque};
          }
          const test::Atwood& atwood = m.atwood;
          Simulation s = test::start(m.machine);
          const double bottom = s.world.position(light).y();
          const double a =
              atwood.acceleration() +
              torque / atwood.radius /
                  (atwood.m1 + atwood.m2 + atwood.inertia / (atwood.radius * atwood.radius));
          const double v = std::sqrt(2.0 * a * Blocked::way);
          const double impact = v / a;
          const double h = 1.0 / 240.0 / substeps;
          test::run(s.world, impact + 0.25);
          const double since = s.world.state().time - impact;
          const double back = restitution * v;
          // `xpbd`: the moment of the impact is off by h at most, so places by (v + e v) h. The
          // contact takes the acceleration within the substep from the loads, -g, and not from the
          // rope, +a: half a substep before the impact and one after it are off by
          // (g + a) h / 2 (1 + e) and (g + a) h, and the moment by (1 + e) a h.
          const double off = rattle ? 2.0 * a * m.slop() + rounding : 2.0 * (test::g + 2.0 * a) * h;
          const double misplaced = rattle ? 2.0 * v * m.slop() + rounding : 2.0 * v * h;
          EXPECT_NEAR(s.world.position(light).y(),
                      bottom + Blocked::way - back * since + 0.5 * a * since * since,
                      misplaced + off * since);
          EXPECT_NEAR(s.world.velocity(light).y(), -back + a * since, off);
          EXPECT_NEAR(s.world.velocity({2}).y(), back - a * since, off);
        }
      }
    }
  }
}

TEST(JointedImpact, AWeightOnTheFloorLetsItsRopeGoSlack) {
  // The heavy weight meets the floor at v and flies back at e v under gravity alone. Its rope cannot
  // push: the light weight and the wheel go on with v, which the light weight alone slows down by
  // m1 g / (m1 + J / r^2). Within the slop d of the instant the old motion goes on, whose
  // accelerations differ by less than g + a.
  for (const test::Method& method : test::methods) {
    if (method.integrator != IntegratorKind::rattle) continue;
    for (const int substeps : {1, 3, 16, 64}) {
      for (const double restitution : {0.5, 1.0}) {
        SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(substeps) + " substeps");
        const BodyId heavy{2};
        Blocked m(method, substeps, heavy, restitution);
        const test::Atwood& atwood = m.atwood;
        Simulation s = test::start(m.machine);
        const double a = atwood.acceleration();
        const double v = std::sqrt(2.0 * a * Blocked::way);
        // The rope is taut again after (1 + e) v / (g - slowed) = 0.4 s and more.
        test::run(s.world, v / a + 0.15);
        const double since = s.world.state().time - v / a;
        const double slowed =
            atwood.m1 * test::g / (atwood.m1 + atwood.inertia / (atwood.radius * atwood.radius));
        const double off = 2.0 * (test::g + a) * m.slop() + rounding;
        const double misplaced = 2.0 * v * m.slop() + off * since + rounding;
        EXPECT_NEAR(s.world.velocity(heavy).y(), restitution * v - test::g * since, off);
        EXPECT_NEAR(s.world.velocity({1}).y(), v - slowed * since, off);
        EXPECT_NEAR(atwood.radius * s.world.angular_velocity({0}).z(), -(v - slowed * since), off);
        EXPECT_NEAR(
            s.world.position(heavy).y(),
            -atwood.hang - Blocked::way + restitution * v * since - 0.5 * test::g * since * since,
            misplaced);
        EXPECT_NEAR(s.world.position({1}).y(),
                    -atwood.hang + Blocked::way + v * since - 0.5 * slowed * since * since,
                    misplaced);
      }
    }
  }
}

/// Time in which a pendulum of the reduced length `length` swings from rest at the angle `from` to
/// `to` [s]. With sin(angle / 2) = k sin u, k = sin(from / 2), it is sqrt(L / g) times the integral
/// of 1 / sqrt(1 - k^2 sin^2 u), by Simpson's rule.
double time_of_swing(double length, double from, double to) {
  const double k = std::sin(0.5 * from);
  const double first = std::asin(std::sin(0.5 * to) / k);
  constexpr int parts = 400;
  const double width = (0.5 * pi - first) / parts;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    const double s = k * std::sin(first + width * i);
    const double weight = i == 0 || i == parts ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight / std::sqrt(1.0 - s * s);
  }
  return std::sqrt(length / test::g) * sum * width / 3.0;
}

TEST(JointedImpact, APendulumOnTheFloorReboundsToSecondOrder) {
  // A ball on a hinge falls from rest at the angle c onto a level floor, which it meets at the angle
  // f from the lowest point. There w^2 = 2 g (cos f - cos c) / L. The hinge makes the acceleration
  // along the normal another one than g. The ball leaves with e w and comes to rest at c' with
  // cos f - cos c' = e^2 (cos f - cos c), where the speed is 0 and the angle is c'.
  constexpr double raised = 1.4;
  constexpr double floor = 0.7;
  constexpr double length = 1.0 + 0.4 * radius * radius;  // of the reduced pendulum
  for (const bool turned : {false, true}) {
    for (const double restitution : {0.6, 1.0}) {
      const Quaternion turn =
          turned ? rotation_by(Vector3(0.4, -0.7, 1.1)) : Quaternion(Quaternion::Identity());
      const double gained = restitution * restitution * (std::cos(floor) - std::cos(raised));
      const double rises = std::acos(std::cos(floor) - gained);
      const double time =
          time_of_swing(length, raised, floor) + time_of_swing(length, rises, floor);
      for (const int substeps : {1, 2, 4, 8, 16, 32, 64}) {
        SCOPED_TRACE(std::to_string(substeps) + " substeps, restitution " +
                     std::to_string(restitution));
        Heap heap(SolverKind::direct, IntegratorKind::rattle);
        heap.model.gravity = turn * test::down;
        heap.model.step = test::direct_settings(IntegratorKind::rattle, time / 40.0, substeps);
        heap.surface.restitution = restitution;
        heap.surface.friction = 0.0;
        const BodyId ball =
            heap.put(test::ball(radius), turn * Vector3(-std::sin(raised), -std::cos(raised), 0.0));
        heap.put(test::make<Box>([](Box& box) { box.size = Vector3(3.0, 0.2, 1.0); }),
                 turn * Vector3(0.0, -std::cos(floor) - radius - 0.1, 0.0));
        heap.last().mobility = Mobility::fixed;
        heap.last().orientation = turn;
        heap.model.joints.push_back(hinge_at_origin(ball, turn * Vector3::UnitZ()));
        World world = heap.start();
        test::run(world, time);
        const Vector3 place = turn.conjugate() * world.position(ball);
        const double spin = (turn.conjugate() * world.angular_velocity(ball)).z();
        const double square = substeps * substeps;
        EXPECT_NEAR(std::atan2(-place.x(), -place.y()), rises, 3e-3 / square);
        EXPECT_NEAR(spin, 0.0, 5e-3 / square);
      }
    }
  }
}

TEST(JointedImpact, APendulumAgainstARowOfPendulumsKeepsItsEnergy) {
  // A ball on a hinge falls against four that hang side by side. All impulses act at once, and the
  // four stay together: with v before, m v = m v0 + 4 m v1 and v1 - v0 = v give v1 = 0.4 v and v0 =
  // -0.6 v. The energy is kept; `rattle` lets it vary by some (w h)^2 / 8 of itself.
  for (const int substeps : {1, 4, 16}) {
    SCOPED_TRACE(std::to_string(substeps) + " substeps");
    Heap heap(SolverKind::direct, IntegratorKind::rattle);
    heap.model.gravity = test::down;
    heap.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
    heap.surface.restitution = 1.0;
    heap.surface.friction = 0.0;
    constexpr double raised = 0.5;
    for (int i = 0; i < 5; ++i) {
      const Vector3 top{2.0 * radius * i, 0.0, 0.0};
      const Vector3 below =
          i == 0 ? Vector3(-std::sin(raised), -std::cos(raised), 0.0) : Vector3(-Vector3::UnitY());
      auto hinge = std::make_shared<HingeJoint>();
      hinge->name = "hinge " + std::to_string(i);
      hinge->body_a = BodyId::world();
      hinge->body_b = heap.put(test::ball(radius), top + below);
      hinge->anchor = top;
      hinge->axis = Vector3::UnitZ();
      heap.model.joints.push_back(hinge);
    }
    World world = heap.start();
    const double energy = world.energy().total();
    test::run(world, 0.7);
    const double lifted = 1.0 - std::cos(raised);
    EXPECT_NEAR(world.energy().total(), energy, 10.0 * lifted * 1e-3 / substeps);
    // Both parts swing with nearly the same period, so their speeds keep the ratio -3 / 2.
    const double first = world.angular_velocity({0}).z();
    for (int i = 1; i < 5; ++i) {
      EXPECT_NEAR(world.angular_velocity({i}).z(), first / -1.5, 0.02 * std::abs(first));
    }
  }
}

TEST(JointedImpact, APendulumOnAHingeTurnsRound) {
  // A ball on a hinge, without gravity, meets a wall: whatever its inertia, w+ = -e w-.
  for (const test::Method& method : test::methods) {
    for (const int substeps : {1, 64}) {
      for (const double speed : {-2.0, 2.0}) {
        for (const double restitution : {0.3, 1.0}) {
          for (const bool turned : {false, true}) {
            SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(substeps) + " substeps");
            const Quaternion turn =
                turned ? rotation_by(Vector3(0.4, -0.7, 1.1)) : Quaternion(Quaternion::Identity());
            Heap heap(method.solver, method.integrator);
            heap.model.gravity = Vector3::Zero();
            heap.model.step.dt = 1.0 / 240.0;
            heap.model.step.substeps = substeps;
            heap.surface.restitution = restitution;
            heap.surface.friction = 0.0;
            constexpr double angle = 0.3;  // before the wall
            const double side = speed > 0.0 ? 1.0 : -1.0;
            const Vector3 place{-side * std::sin(angle), -std::cos(angle), 0.0};
            const BodyId ball = heap.put(test::ball(radius), turn * place);
            heap.last().velocity =
                turn * (speed * Vector3(std::cos(angle), side * -std::sin(angle), 0.0));
            heap.last().angular_velocity = turn * Vector3(0.0, 0.0, speed);
            const BodyId wall =
                heap.put(test::make<Box>([](Box& box) { box.size = Vector3(0.2, 1.0, 1.0); }),
                         turn * Vector3(side * (radius + 0.1), -1.0, 0.0));
            heap.last().mobility = Mobility::fixed;
            heap.last().orientation = turn;
            heap.model.joints.push_back(hinge_at_origin(ball, turn * Vector3::UnitZ()));
            World world = heap.start();
            EXPECT_FALSE(wall.is_world());
            test::run(world, 0.25);
            const Vector3 spin = turn.conjugate() * world.angular_velocity(ball);
            // The wall is met where its normal is across the arm, but for the way of a substep:
            // cos(w h) = 1 to 4e-5. `xpbd` takes w^3 h t of the speed of a circle
            // (cable/certificate/integrator_loss.h).
            const bool xpbd = method.integrator == IntegratorKind::xpbd;
            const double taken = xpbd ? 8.0 * 0.25 / 240.0 / substeps : 0.0;
            EXPECT_NEAR(spin.z(), -restitution * speed, 2e-3 + taken);
            EXPECT_NEAR(world.velocity(ball).norm(), restitution * 2.0, 2e-3 + taken);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace sheave::jointed_impact
