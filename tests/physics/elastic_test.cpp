// The elastic Atwood machine: two weights on vertical spans of stiffness k each, over a wheel with
// inertia.
//
// With the weights' ways down x1, x2 and the cable's way s over the wheel, towards the second, the
// spans are stretched by e1 = x1 + s and e2 = x2 - s, because rest length moves over the wheel
// without slip. With M = J / r^2
//   m1 x1'' = m1 g - k e1,   m2 x2'' = m2 g - k e2,   M s'' = k (e2 - e1)
//   =>  e'' = (g, g) - K e,   K = k [ 1/m1 + 1/M, -1/M; -1/M, 1/m2 + 1/M ].
// The third mode is the machine's own run. K's eigenvalues are w^2; at e0 = K^-1 (g, g) the
// stretches are at rest.
//
// Discretised, and since everything is linear exactly so, each mode y is a rotation by p per
// substep that shrinks by q:
//   xpbd    y1 = y0 + h v1, v1 = v0 - h w^2 y1              p = atan(w h),         q = 1 / sqrt(1 + (w h)^2)
//   rattle  y1 = y0 + h (v0 + v1) / 2, v1 = v0 - h w^2 (y0 + y1) / 2   p = 2 atan(w h / 2),   q = 1
// So the frequency p / h is too low by (w h)^2 / 3 (xpbd) and (w h)^2 / 12 (rattle): at 20 substeps
// per period by 3.2 % and 0.81 %. 0.1 % takes 2 pi sqrt(1000 / 3) = 115 and 2 pi sqrt(1000 / 12) =
// 57.4 substeps per period.

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

using test::g;

struct ElasticAtwood {
  double stiffness = 400.0;
  test::Atwood atwood{.m1 = 1.0, .m2 = 1.5};

  [[nodiscard]] Eigen::Matrix2d matrix() const {
    const double rim = atwood.inertia / (atwood.radius * atwood.radius);
    Eigen::Matrix2d k;
    k << 1.0 / atwood.m1 + 1.0 / rim, -1.0 / rim, -1.0 / rim, 1.0 / atwood.m2 + 1.0 / rim;
    return stiffness * k;
  }
  [[nodiscard]] Eigen::Vector2d rest() const { return matrix().inverse() * Eigen::Vector2d(g, g); }
  /// At rest with the stretches `stretch`.
  [[nodiscard]] Simulation start(const Eigen::Vector2d& stretch, SolverKind solver,
                                 IntegratorKind integrator, double h, int iterations) const {
    test::Machine m = atwood.machine();
    m.cables[0].compliance = 1.0 / stiffness;
    m.cables[0].rest_lengths = {atwood.hang - stretch[0], atwood.hang - stretch[1]};
    m.model.step = test::settings(h, 1, iterations);
    m.model.step.solver = solver;
    m.model.step.integrator = integrator;
    return test::start(m);
  }
};

constexpr std::array both_solvers{SolverKind::direct, SolverKind::gauss_seidel};
constexpr std::array both_integrators{IntegratorKind::xpbd, IntegratorKind::rattle};

/// Angle p and factor q of a substep, from the recurrence y[n+1] = 2 q cos(p) y[n] - q^2 y[n-1] of
/// a single mode.
struct Rotation {
  double angle = 0.0;
  double factor = 0.0;
  double misfit = 0.0;  ///< of the recurrence, over the largest y
};

Rotation fit_rotation(const std::vector<double>& y) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d rhs = Eigen::Vector2d::Zero();
  double largest = 0.0;
  for (std::size_t n = 1; n + 1 < y.size(); ++n) {
    const Eigen::Vector2d row(y[n], -y[n - 1]);
    normal += row * row.transpose();
    rhs += y[n + 1] * row;
    largest = std::max(largest, std::abs(y[n]));
  }
  const Eigen::Vector2d found = normal.inverse() * rhs;
  Rotation rotation;
  rotation.factor = std::sqrt(found[1]);
  rotation.angle = std::acos(0.5 * found[0] / rotation.factor);
  for (std::size_t n = 1; n + 1 < y.size(); ++n) {
    const double error = y[n + 1] - found[0] * y[n] + found[1] * y[n - 1];
    rotation.misfit = std::max(rotation.misfit, std::abs(error) / largest);
  }
  return rotation;
}

/// What a substep does to the mode `shape` of frequency w. Swings by half of what hangs, so that no
/// span goes slack.
Rotation measured_rotation(const ElasticAtwood& machine, const Eigen::Vector2d& shape,
                           SolverKind solver, IntegratorKind integrator, double h, int substeps) {
  const Eigen::Vector2d rest = machine.rest();
  const double amplitude = 0.5 * rest.minCoeff() / shape.cwiseAbs().maxCoeff();
  Simulation s = machine.start(rest + amplitude * shape, solver, integrator, h, 40);
  std::vector<double> y;
  for (int i = 0; i < substeps; ++i) {
    EXPECT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    Eigen::Vector2d stretch;
    for (int k = 0; k < 2; ++k) {
      const SpanReport& span = report.spans[static_cast<std::size_t>(k)];
      stretch[k] = span.length - span.rest_length;
    }
    // K is symmetric, so its modes are orthogonal and this is the share of one of them.
    y.push_back(shape.dot(stretch - rest));
  }
  return fit_rotation(y);
}

TEST(ElasticAtwood, NaturalFrequencies) {
  const ElasticAtwood machine;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> modes;
  modes.computeDirect(machine.matrix());
  for (const SolverKind solver : both_solvers) {
    for (const IntegratorKind integrator : both_integrators) {
      const bool rattle = integrator == IntegratorKind::rattle;
      for (const double per_period : {20.0, 40.0, 58.0, 116.0}) {
        for (int mode = 0; mode < 2; ++mode) {
          const double w = std::sqrt(modes.eigenvalues()[mode]);
          const double h = 2.0 * pi / w / per_period;
          const Rotation found =
              measured_rotation(machine, modes.eigenvectors().col(mode), solver, integrator, h, 60);
          const double x = w * h;
          const double angle = rattle ? 2.0 * std::atan(0.5 * x) : std::atan(x);
          const double factor = rattle ? 1.0 : 1.0 / std::sqrt(1.0 + x * x);
          // A solver leaves some 1e-10 m of stretches of 1e-2 m in each substep.
          EXPECT_NEAR(found.angle, angle, 1e-6 * angle) << per_period << ' ' << mode;
          EXPECT_NEAR(found.factor, factor, 1e-7) << per_period << ' ' << mode;
          EXPECT_LT(found.misfit, 1e-7);
          if (per_period < (rattle ? 57.4 : 115.0)) continue;
          EXPECT_NEAR(found.angle / h, w, 1e-3 * w);
        }
      }
    }
  }
}

TEST(ElasticAtwood, StableAtAnyStiffness) {
  // Steps of 1/60 s, from 25 substeps per period to 1e-4 of one. From half of the stretches at rest
  // both modes swing; from 2.5 of them the spans go slack and taut again. A solver may leave d =
  // 1e-10 of the scene's size in each of n substeps, hence a force d / (W h^2) with the rows'
  // smallest yield W, which works at the speed v: n d v / (W h).
  const double h = 1.0 / 60.0;
  constexpr int substeps = 60;
  constexpr double yield = 1.0;  // 1 / m1 + 1 / M and 1 / m2 + 1 / M are more [1/kg]
  for (const SolverKind solver : both_solvers) {
    for (const IntegratorKind integrator : both_integrators) {
      for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e12}) {
        for (const double share : {0.5, 2.5}) {
          const ElasticAtwood machine{.stiffness = stiffness};
          Simulation s = machine.start(share * machine.rest(), solver, integrator, h, 40);
          const double start = s.world.energy().total();
          double most = start;
          double least = start;
          double speed = 0.0;
          for (int i = 0; i < substeps; ++i) {
            ASSERT_TRUE(s.world.step().ok());
            most = std::max(most, s.world.energy().total());
            least = std::min(least, s.world.energy().total());
            speed = std::max(speed, s.world.velocity({1}).norm());
          }
          const double left = 1e-10 * s.world.bodies().scale();
          const double bound = substeps * left * speed / (yield * h) + 1e-12 * std::abs(start);
          EXPECT_LT(most - start, bound) << stiffness << ' ' << share;
          // Without damping, without impacts.
          if (integrator == IntegratorKind::rattle && share < 1.0) {
            EXPECT_GT(least - start, -bound) << stiffness;
          }
        }
      }
    }
  }
}

// Nothing can move, but the spring is as long as it is.
TEST(Elastic, ASpringBetweenDrivenBodiesHasItsForce) {
  for (const SolverKind solver : both_solvers) {
    for (const IntegratorKind integrator : both_integrators) {
      test::Machine m;
      m.model.step = test::settings(0.01, 1, 5);
      m.model.step.solver = solver;
      m.model.step.integrator = integrator;
      for (const double x : {0.0, 1.0}) {
        BodyDef end;
        end.name = x > 0.0 ? "driven" : "fixed";
        end.mobility = x > 0.0 ? Mobility::kinematic : Mobility::fixed;
        end.position = {x, 0.0, 0.0};
        if (x > 0.0) end.velocity = {0.1, 0.0, 0.0};
        m.model.add(end);
      }
      m.cables.push_back(test::cable("spring", {test::attach({0}), test::attach({1})}));
      m.cables[0].compliance = 1e-3;
      Simulation s = test::start(m);
      for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
      // 0.05 m at 1000 N/m.
      EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, 50.0, 1e-9);
    }
  }
}

/// What a weight of 2 kg on a cable of compliance 1/k loses in `steps` substeps to its damping and
/// to the step [J], and what the statistics tell of the latter. It begins `amplitude` below where
/// it would rest, and the cable is never slack.
struct Loss {
  double energy = 0.0;
  double by_damping = 0.0;
  double told = 0.0;
};
Loss loss_of(double wh, double damping, IntegratorKind integrator, int steps) {
  const double mass = 2.0;
  const double stiffness = 800.0;
  const double sag = mass * g / stiffness;
  const double amplitude = 0.5 * sag;
  test::Machine m;
  m.model.gravity = test::down;
  const double h = wh / std::sqrt(stiffness / mass);
  m.model.step = test::settings(h, 1, 5);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  const BodyId weight = m.model.add(test::weight("weight", {0.0, -1.0, 0.0}, mass));
  CableDef cable;
  cable.name = "cable";
  cable.compliance = 1.0 / stiffness;
  cable.damping = damping;
  cable.links.push_back(test::attach(BodyId::world()));
  cable.links.push_back(test::attach(weight));
  cable.rest_lengths = {1.0 - sag - amplitude};
  m.cables.push_back(std::move(cable));
  Simulation s = test::start(m);
  Loss loss;
  const double first = s.world.energy().total();
  for (int i = 0; i < steps; ++i) {
    const double before = s.world.position(weight).y();
    loss.told += s.world.step().statistics.numerical_damping;
    const double rate = (s.world.position(weight).y() - before) / h;
    loss.by_damping += h * damping * rate * rate;
  }
  loss.energy = first - s.world.energy().total();
  return loss;
}

// xpbd takes 1 - q^(2n) of the energy k y0^2 / 2 = 15.0 mJ, and says so. It counts k dy^2 for k
// dy^2 / 2 + m dv^2 / 2, which agree in the mean over a period and differ by less than a share of w
// h in what is left of one.
TEST(ElasticCable, ReportsTheEnergyThatXpbdTakesFromAVibration) {
  const double energy = 0.5 * 800.0 * std::pow(0.5 * 2.0 * g / 800.0, 2);
  for (const double wh : {0.05, 0.2}) {
    const int steps = static_cast<int>(4.0 * pi / wh);
    const Loss loss = loss_of(wh, 0.0, IntegratorKind::xpbd, steps);
    EXPECT_NEAR(loss.energy, energy * (1.0 - std::pow(1.0 + wh * wh, -steps)), 1e-6 * energy);
    EXPECT_NEAR(loss.told, loss.energy, wh * energy) << wh;
    EXPECT_EQ(loss_of(wh, 0.0, IntegratorKind::rattle, steps).told, 0.0);
  }
}

// What a dashpot dissipates is none of it: b dy'^2 h, in a vibration that it damps to 1/e in two
// periods.
TEST(ElasticCable, DistinguishesNumericalFromPhysicalDamping) {
  const double energy = 0.5 * 800.0 * std::pow(0.5 * 2.0 * g / 800.0, 2);
  const double wh = 0.05;
  const Loss loss = loss_of(wh, 6.0, IntegratorKind::xpbd, static_cast<int>(4.0 * pi / wh));
  EXPECT_GT(loss.by_damping, 0.3 * energy);
  EXPECT_NEAR(loss.told, loss.energy - loss.by_damping, wh * energy);
}

/// An elastic, damped rope runs over an eyelet from a side of 1 m to one of 3 m: what passes
/// deflects no spring and moves no damper, so once the first swing has died away, e^(-c t / 2 m)
/// with c = b / 2 or more and the reduced mass m = 3/4 kg, T = 2 m1 m2 g / (m1 + m2), and each side
/// is longer than its rest length L by T L / EA.
class RunningElasticCable : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, RunningElasticCable, testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST_P(RunningElasticCable, IsNotDampedByItsRunning) {
  constexpr double stiffness = 1e5;
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.0025, 20);
  m.model.add(test::weight("light", {0.0, -3.0, 0.0}, 1.0));
  m.model.add(test::weight("heavy", {0.0, -1.0, 0.0}, 3.0));
  auto eyelet = std::make_shared<PinholeLink>();
  eyelet->body = BodyId::world();
  CableDef rope = test::cable("rope", {test::attach({0}), eyelet, test::attach({1})});
  rope.axial_stiffness = stiffness;
  rope.damping = 200.0;
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  const double start = s.world.energy().total();
  double told = 0.0;
  while (s.world.state().time < 0.5) told += s.world.step().statistics.numerical_damping;
  EXPECT_LE(told, start - s.world.energy().total());
  const CableReport report = s.cable_reports()[0];
  for (const SpanReport& span : report.spans) {
    EXPECT_NEAR(span.tension, 1.5 * g, 1e-6);
    EXPECT_NEAR(span.length - span.rest_length, 1.5 * g * span.rest_length / stiffness, 1e-10);
  }
}

// A load of 8 kN pulls cable of 1 m/kN over an eyelet (a quarter turn, e^(m a) = e) out of a span
// of 1 m that ends at a wall. When nothing is left in it, it is stretched by its whole length, 1
// kN, and gives no more: the eyelet holds 8 to 1, and one without friction does, too.
TEST(ElasticCable, ASpanWithoutRestLengthGivesNoCable) {
  for (int i = 0; i < 8; ++i) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.01, 1, 20);
    m.model.step.solver = both_solvers[i % 2 == 0 ? 0 : 1];
    m.model.step.integrator = both_integrators[i % 4 < 2 ? 0 : 1];
    BodyDef load = test::weight("load", {0.0, -2.0, 0.0}, 8000.0 / g);
    load.damping = 2000.0;
    const BodyId body = m.model.add(load);
    auto eyelet = std::make_shared<PinholeLink>();
    eyelet->friction = i < 4 ? 2.0 / pi : 0.0;
    m.cables.push_back(test::cable(
        "cable", {test::attach(BodyId::world(), {-1.0, 0.0, 0.0}), eyelet, test::attach(body)}));
    m.cables[0].compliance = 1e-3;
    Simulation s = test::start(m);
    test::run(s.world, 40.0);
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.spans[0].rest_length, 0.0, 1e-12) << i;
    EXPECT_NEAR(report.spans[0].tension, 1000.0, 1e-6);
    EXPECT_NEAR(report.spans[1].tension, 8000.0, 1e-3);
    EXPECT_NEAR(report.spans[1].length - report.spans[1].rest_length, 8.0, 1e-6);
    EXPECT_EQ(report.length_error, 0.0);
  }
}

// Between a wall and a body that nothing moves a span that is wound up with the speed v is stretched
// by x = v t, and pulls with x / c. A span that began with the cable that the substep winds up would
// be v h ahead.
TEST(ElasticFeed, PullsByTheLengthFedSoFar) {
  constexpr double compliance = 1e-4;
  constexpr double speed = 0.2;
  constexpr double h = 0.004;
  for (const test::Combination& combination : test::combinations) {
    SCOPED_TRACE(test::combination_name({combination, 0}));
    test::Machine m;
    m.model.add(test::weight("rock", {0.0, -1.0, 0.0}, 1e15));
    auto winch = test::attach(BodyId::world());
    winch->feed_speed = -speed;
    m.cables.push_back(test::cable("rope", {winch, test::attach({0})}));
    m.cables[0].compliance = compliance;
    m.model.step = test::settings(h, 1, 20);
    m.model.step.solver = combination.solver;
    m.model.step.integrator = combination.integrator;
    Simulation simulation = test::start(m);
    for (int i = 1; i <= 50; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      const double expected = speed * h * i / compliance;
      // The rock gives by F t^2 / 2 m < 1e-14 m; lengths are multiples of a quantum of 1e-15 m.
      ASSERT_NEAR(simulation.cable_reports()[0].spans[0].tension, expected, 1e-8 * expected) << i;
    }
  }
}

}  // namespace
}  // namespace sheave
