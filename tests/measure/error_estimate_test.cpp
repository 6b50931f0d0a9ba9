// What a run says of the error of its step, against closed forms.
//
// With e = C h + D h^2 and d = D h / C small, the differences give p = 1 + 0.75 d / ln 2 = 1 + 1.08
// d and the estimate C h (1 + 0.75 d), where the error is C h (1 + d). With e = C h^2 + D h^4
// (rattle is symmetric) and d = D h^2 / C they give p = 2 + 1.35 d and C h^2 (1 + 15/16 d). So an
// estimate is as good as the order that it finds is whole: wrong by a quarter of
// |p - 1|, or a twentieth of |p - 2|. As d is different in each frame, tests allow four times that.

#include "measure/error_estimate.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/measure/estimated_run.h"
#include "tests/support/builders.h"

namespace sheave::measure {
namespace {

using test::estimated;
using test::Estimated;
using test::g;
using test::scene_of;

/// A pendulum of 1 m let go at an angle: sin(a / 2) = k sn(K - w t), k = sin(a0 / 2), w^2 = g / l.
struct Pendulum {
  static constexpr double start = 0.5;

  [[nodiscard]] static double angle(double time) {
    const double k = std::sin(0.5 * start);
    const double argument = std::comp_ellint_1(k) - std::sqrt(g) * time;
    // sn(u) = sin(amplitude), of which u is the elliptic integral: by Newton's method.
    double amplitude = argument;
    for (int i = 0; i < 20; ++i) {
      const double slope = 1.0 / std::sqrt(1.0 - std::pow(k * std::sin(amplitude), 2));
      amplitude -= (std::ellint_1(k, amplitude) - argument) / slope;
    }
    return 2.0 * std::asin(k * std::sin(amplitude));
  }
  [[nodiscard]] static Vector3 position(double time) {
    return {std::sin(angle(time)), -std::cos(angle(time)), 0.0};
  }
  /// m g (3 cos a - 2 cos a0), 1 kg.
  [[nodiscard]] static double tension(double time) {
    return g * (3.0 * std::cos(angle(time)) - 2.0 * std::cos(start));
  }
  [[nodiscard]] static Estimated run(IntegratorKind integrator, int substeps) {
    return estimated(scene_of(test::cable_pendulum(1.0, 1.0, start), integrator, substeps));
  }
};

TEST(ErrorEstimate, ThePendulumsClosedFormConservesEnergy) {
  // The test's own ground: energy of the closed form, w'^2 = 2 g (cos a - cos a0), by central
  // differences of 1e-4 s, whose error is a'''/6 x 1e-8 < 1e-7.
  for (const double time : {0.3, 1.0, 1.9}) {
    const double rate = (Pendulum::angle(time + 1e-4) - Pendulum::angle(time - 1e-4)) / 2e-4;
    const double energy = 2.0 * g * (std::cos(Pendulum::angle(time)) - std::cos(Pendulum::start));
    EXPECT_NEAR(rate * rate, energy, 1e-6);
  }
}

TEST(ErrorEstimate, OfXpbdOnAPendulumHasOrderOneAndEqualsTheError) {
  const Estimated run = Pendulum::run(IntegratorKind::xpbd, 32);
  const BodyDifference& bob = run.estimate.bodies.at(0);
  EXPECT_EQ(run.estimate.position_kind, StepErrorKind::regular);
  ASSERT_TRUE(bob.position.order);
  EXPECT_NEAR(*bob.position.order, 1.0, 0.03);
  const double time = bob.position.time;
  const double error = (run.at(time).poses[0].position - Pendulum::position(time)).norm();
  EXPECT_NEAR(bob.position.error(), error, 0.03 * error);
  // Tensions have the error of the motion, and are those of the substep that ends then.
  const StepDifference& tension = run.estimate.spans.at(0).tension;
  ASSERT_TRUE(tension.order);
  EXPECT_NEAR(*tension.order, 1.0, 0.03);
  const double wrong = run.at(tension.time).tensions[0] - Pendulum::tension(tension.time);
  EXPECT_NEAR(tension.error(), std::abs(wrong), 0.03 * std::abs(wrong));
}

TEST(ErrorEstimate, OfRattleOnAPendulumHasOrderTwoAndEqualsTheError) {
  const Estimated run = Pendulum::run(IntegratorKind::rattle, 1);
  const BodyDifference& bob = run.estimate.bodies.at(0);
  ASSERT_TRUE(bob.position.order);
  EXPECT_NEAR(*bob.position.order, 2.0, 0.03);
  const double time = bob.position.time;
  const double error = (run.at(time).poses[0].position - Pendulum::position(time)).norm();
  EXPECT_NEAR(bob.position.error(), error, 0.2 * 0.03 * error);
  // The tension of a substep is that of its middle, so half a substep late: of first order, T' h /
  // 2.
  const StepDifference& tension = run.estimate.spans.at(0).tension;
  ASSERT_TRUE(tension.order);
  EXPECT_NEAR(*tension.order, 1.0, 0.1);
  const double wrong = run.at(tension.time).tensions[0] - Pendulum::tension(tension.time);
  EXPECT_NEAR(tension.error(), std::abs(wrong), 0.1 * std::abs(wrong));
}

TEST(ErrorEstimate, OfAtwoodHasTheClosedFormOfXpbd) {
  // v(k h) = k a h is exact and positions sum it up: x is a t h / 2 too large, exactly of first
  // order, for the weights as for the wheel's rim. Tensions are right. Rounding: 60 steps of
  // positions of metres.
  const test::Atwood atwood;
  Scene scene = scene_of(atwood.machine(), IntegratorKind::xpbd, 1);
  scene.duration = 1.0;
  const Estimated run = estimated(scene);
  const double expected = 0.5 * atwood.acceleration() / 60.0;
  EXPECT_EQ(run.estimate.position_kind, StepErrorKind::regular);
  EXPECT_NEAR(*run.estimate.position.order, 1.0, 1e-7);
  EXPECT_NEAR(run.estimate.position.error(), expected, 1e-7 * expected);
  EXPECT_NEAR(run.estimate.bodies[0].turn.error(), expected / atwood.radius, 1e-6);
  EXPECT_NEAR(run.estimate.bodies[2].position.error(), expected, 1e-7 * expected);
  EXPECT_NEAR(run.estimate.position.time, 1.0, 1e-12);
  EXPECT_EQ(run.estimate.tension_kind, StepErrorKind::rounding);
  EXPECT_EQ(run.estimate.changes.count(), 0U);
  EXPECT_EQ(run.estimate.substeps, (std::array<int, 3>{1, 2, 4}));
  EXPECT_NEAR(run.estimate.end, 1.0, 1e-12);
  // What is exact for any step says so.
  scene.model.step.integrator = IntegratorKind::rattle;
  const Estimated exact = estimated(scene);
  EXPECT_EQ(exact.estimate.position_kind, StepErrorKind::rounding);
  EXPECT_LT(exact.estimate.position.relative(), 1e-11);
}

TEST(ErrorEstimate, OfThePapersSimpleSceneEqualsItsSag) {
  // In balance nothing moves, so what moves is the error: the sag that the sweeps of one substep
  // leave. It is what gravity moves a body by in a substep times a factor that the number of sweeps
  // makes: of second order.
  SceneResult loaded = load_scene(SHEAVE_SOURCE_DIR "/scenes/paper/simple.json");
  ASSERT_TRUE(loaded);
  Scene scene = std::move(*loaded.scene);
  scene.duration = 2.0;
  scene.model.step.substeps = 1;
  scene.model.step.solver = SolverKind::gauss_seidel;
  scene.model.step.integrator = IntegratorKind::xpbd;
  const Estimated run = estimated(scene);
  for (const BodyDifference& body : run.estimate.bodies) {
    if (!(body.position.relative() > negligible_difference)) continue;  // wheels stay
    ASSERT_TRUE(body.position.order) << body.name;
    EXPECT_NEAR(*body.position.order, 2.0, 0.1) << body.name;
  }
  const BodyDifference& first = run.estimate.bodies.at(0);
  EXPECT_EQ(first.name, "A");
  const Vector3 now = run.at(first.position.time).poses[0].position;
  const double sag = (now - scene.model.bodies[0].position).norm();
  EXPECT_GT(sag, 1e-5);
  EXPECT_NEAR(first.position.error(), sag, 0.1 * sag);
  // All rows at once leave none.
  scene.model.step.solver = SolverKind::direct;
  const Estimated direct = estimated(scene);
  EXPECT_EQ(direct.estimate.position_kind, StepErrorKind::rounding);
  EXPECT_EQ(direct.estimate.tension_kind, StepErrorKind::rounding);
}

TEST(ErrorEstimate, AnImpactsTensionHasNoOrderAndIsCalledAnEvent) {
  // A weight thrown up on a slack cable falls until it is taut: the impulse 1 kg x 3.1 m/s in one
  // substep h is a tension of 3.1 / h, which grows as the step shrinks.
  test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
  machine.model.bodies[0].position = {0.0, -0.5, 0.0};
  machine.cables[0].rest_lengths = {1.0};
  const Estimated run = estimated(scene_of(machine, IntegratorKind::xpbd, 1));
  EXPECT_EQ(run.estimate.tension_kind, StepErrorKind::events);
  EXPECT_GE(run.estimate.changes.slack, 1U);
  EXPECT_FALSE(run.estimate.spans[0].tension.order);
}

/// 1 kg thrown up from 1 m at `speed` on a rope of 1.5 m from the ground: at the time te it is taut,
/// stops (nothing bounces), and falls from there, y = 1.5 - g (t - te)^2 / 2, 4 substeps of 1/240 s.
struct Thrown {
  double speed = 6.0;

  [[nodiscard]] double taut_at() const { return (speed - std::sqrt(speed * speed - g)) / g; }
  [[nodiscard]] double height(double time) const {
    const double fall = time - taut_at();
    return fall > 0.0 ? 1.5 - 0.5 * g * fall * fall : 1.0 + speed * time - 0.5 * g * time * time;
  }
  [[nodiscard]] Estimated run() const { return estimated(scene()); }
  [[nodiscard]] Scene scene() const {
    Scene scene;
    scene.model.gravity = {0.0, -g, 0.0};
    BodyDef body;
    body.name = "thrown";
    body.mobility = Mobility::slider;
    body.axis = Vector3::UnitY();
    body.mass = 1.0;
    body.position = {0.0, 1.0, 0.0};
    body.velocity = {0.0, speed, 0.0};
    scene.model.bodies.push_back(body);
    test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
    scene.cables = machine.cables;
    scene.cables[0].rest_lengths = {1.5};
    scene.model.step = test::settings(1.0 / 60.0, 4, 50);
    scene.model.step.solver = SolverKind::direct;
    scene.model.step.integrator = IntegratorKind::rattle;
    scene.duration = 0.5;
    return scene;
  }
};

TEST(ErrorEstimate, OfAWeightThrownUpOnARopeCoversItsError) {
  // The rope is taken for taut at the end of the substep in which it becomes so, at most 1/240 s
  // late, and by that time the fall is, too: 4 m/s x 1/240 s = 17 mm at most. In every fourth case all
  // runs find the same substep end, and nothing but the speed tells: a quarter of that. Before, what
  // was told was 1e-15 m for the half of them.
  int hidden = 0;
  for (int i = 0; i < 16; ++i) {
    const Thrown thrown{6.0 + 0.05 * i};
    SCOPED_TRACE(thrown.speed);
    const Estimated run = thrown.run();
    const Frame& last = run.frames.back();
    const double error = std::abs(last.poses[0].position.y() - thrown.height(0.5));
    const StepDifference& told = run.estimate.bodies.at(0).position;
    const double fall = g * (0.5 - thrown.taut_at());
    // How late is known from closed forms: the error of the fall's start, h', is fall x h' - g h'^2 / 2.
    EXPECT_LE(error, fall / 240.0);
    EXPECT_GE(told.error(), 0.99 * error);
    EXPECT_LE(told.error(), std::max(2.1 * error, 1.01 * fall / 960.0));
    EXPECT_EQ(run.estimate.changes.sudden, 1U);
    if (told.bound < 1e-9) {
      ++hidden;
      EXPECT_EQ(run.estimate.position_kind, StepErrorKind::events);
    }
  }
  EXPECT_GT(hidden, 0);
  // As filed: 6.9 mm where 1e-13 % was told.
  const Estimated filed = Thrown{6.0}.run();
  const double error =
      std::abs(filed.frames.back().poses[0].position.y() - Thrown{6.0}.height(0.5));
  EXPECT_NEAR(error, 6.9e-3, 1e-4);
  EXPECT_NEAR(filed.estimate.position.error(), error, 0.3 * error);
}

/// A winch that lifts 2 kg: from rest at 0.3 s to 1 m/s at 0.7 s, and to rest from 1.203 to 1.611 s.
/// `at` [s] moves all corners within a substep.
Scene winch_with_corners(double at, const std::string& drive) {
  const std::string times =
      fmt::format("[{}, {}, {}, {}]", 0.3 + at, 0.7 + at, 1.203 + at, 1.611 + at);
  const std::string table =
      R"("drive": "speed", "drive_values": [0, 2, 2, 0], "drive_times": )" + times;
  const std::string wheel =
      R"("mass": 1, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1})";
  const bool hinged = drive == "hinge";
  const std::string text =
      R"({"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 2, "bodies": [
      {"name": "drum", "mobility": ")" +
      (hinged ? "planar\", " + wheel : "rotor\", " + wheel + ", " + table) + R"(},
      {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -3, 0]}],)" +
      (hinged
           ? R"("joints": [{"type": "hinge", "name": "axle", "body_b": "drum", "anchor": [0, 0, 0], "axis": [0, 0, 1], )" +
                 table + "}],"
           : "") +
      R"("cables": [{"name": "rope", "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 3},
      {"type": "attachment", "body": "load"}]}]})";
  SceneResult loaded = load_scene_text(text, "winch.json");
  if (!loaded) throw std::runtime_error(to_string(loaded.errors.front()));
  return std::move(*loaded.scene);
}

TEST(ErrorEstimate, CornersOfADrivesTableAreNoEvents) {
  // Drive's integral and load are exact with rattle, wherever the corners lie in a substep of 1/240 s:
  // 0.5 m x (2 rad/s x 0.503 s + (0.4 s + 0.408 s) x 1 rad/s) = 0.907 m.
  for (const std::string drive : {"rotor", "hinge"}) {
    for (const double at : {0.0, 0.0005, 0.0011, 0.0023, 0.0041}) {
      SCOPED_TRACE(fmt::format("{} {}", drive, at));
      const Scene scene = winch_with_corners(at, drive);
      const Estimated run = estimated(scene);
      EXPECT_NEAR(run.frames.back().poses.back().position.y(), -3.0 + 0.907, 1e-9);
      EXPECT_EQ(run.estimate.changes.sudden, 0U);
      EXPECT_EQ(run.estimate.position.unseen, 0.0);
      EXPECT_EQ(run.estimate.position_kind, StepErrorKind::rounding);
    }
  }
}

TEST(ErrorEstimate, ACutAtItsInstantIsNoSuddenEvent) {
  // 2 kg hang by a rope until it is cut, and fall: h = g (1 - t)^2 / 2, exact with rattle. A rigid
  // rope that breaks by its tension is late. (Before, 24 mm were told with 1 substep.)
  for (const double cut : {0.4234, 0.5, 0.7001}) {
    SCOPED_TRACE(cut);
    test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
    machine.cables[0].cut_time = cut;
    Scene scene = scene_of(machine, IntegratorKind::rattle, 1);
    scene.duration = 1.0;
    const Estimated run = estimated(scene);
    const double fall = 0.5 * g * (1.0 - cut) * (1.0 - cut);
    EXPECT_NEAR(run.frames.back().poses[0].position.y(), -1.0 - fall, 1e-9);
    EXPECT_EQ(run.estimate.changes.sudden, 0U);
    EXPECT_EQ(run.estimate.position_kind, StepErrorKind::rounding);
  }
}

TEST(ErrorEstimate, AnImpactBesideACornerIsStillAnEvent) {
  // A second body's drive has a corner in the very substep in which the rope is taut, or a quarter
  // of a substep before.
  const Thrown thrown{6.0};
  for (const double before : {0.0, 0.25 / 240.0}) {
    Scene scene = thrown.scene();
    BodyDef wheel;
    wheel.name = "wheel";
    wheel.mobility = Mobility::rotor;
    wheel.mass = 1.0;
    wheel.inertia = Vector3(1.0, 1.0, 1.0);
    wheel.drive = DriveKind::speed;
    wheel.drive_times = {thrown.taut_at() - before, 1.0};
    wheel.drive_values = {0.0, 1.0};
    scene.model.bodies.push_back(wheel);
    EXPECT_EQ(estimated(scene).estimate.changes.sudden, 1U);
  }
}

/// A box of 2 kg on a floor, with the coefficients of friction.
Scene box_on_a_floor(double kinetic, double resting, double speed, const std::string& more) {
  const std::string text = fmt::format(
      R"({{"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1, "bodies": [
      {{"name": "box", "mass": 2, "position": [0, 0.1, 0], "velocity": [{}, 0, 0], "shape": {{"type": "box", "size": [0.3, 0.2, 0.25]}}}},
      {{"name": "floor", "mobility": "static", "shape": {{"type": "half-space"}}}}],
      "colliders": [{{"body": "box", "friction": {}, "static_friction": {}}},
                    {{"body": "floor", "friction": {}, "static_friction": {}}}]{}}})",
      speed, kinetic, resting, kinetic, resting, more);
  SceneResult loaded = load_scene_text(text, "box.json");
  if (!loaded) throw std::runtime_error(to_string(loaded.errors.front()));
  return std::move(*loaded.scene);
}

TEST(ErrorEstimate, OfABoxThatFrictionStopsCoversItsError) {
  // The way is v^2 / (2 mu g), and friction acts in whole substeps: the box stops at a point of the
  // grid, (mu g / 2) (h / 2)^2 off at most. All three runs may find the same point. (1e-9 m was told
  // where 1e-6 m is wrong.)
  constexpr double slowing = 4.0;
  int hidden = 0;
  for (const int substeps : {1, 4}) {
    for (int i = 0; i < 12; ++i) {
      const double speed = 1.9 + 0.0127 * i;
      SCOPED_TRACE(fmt::format("{} substeps, {} m/s", substeps, speed));
      Scene scene = box_on_a_floor(0.4, 0.4, speed, "");
      scene.model.step.substeps = substeps;
      const Estimated run = estimated(scene);
      const double way = 0.5 * speed * speed / slowing;
      const double error = std::abs(run.frames.back().poses[0].position.x() - way);
      const double h = 1.0 / 60.0 / substeps;
      EXPECT_LE(error, 0.125 * slowing * h * h + 1e-8);
      const StepDifference& told = run.estimate.bodies.at(0).position;
      // The finest run is off by `unseen` at most. Softness of friction is 1e-7 of a stop.
      EXPECT_GE(told.error() + told.unseen, error - 1e-8);
      EXPECT_GE(told.error(), 0.85 * error - 1e-8);
      EXPECT_LE(told.error(), 2.5 * error + slowing * h * h / 100.0);
      EXPECT_EQ(run.estimate.changes.stops, 1U);
      EXPECT_EQ(run.estimate.changes.sudden, 0U);
      if (told.bound < 0.5 * error) {
        ++hidden;
        EXPECT_EQ(run.estimate.position_kind, StepErrorKind::events);
      }
    }
  }
  EXPECT_GT(hidden, 0);
}

TEST(ErrorEstimate, CountsFrictionThatLetsGoAsSudden) {
  // The force grows by 16 N/s and passes 0.4 x 20 N at 0.5 s; then 0.3 acts.
  const Scene scene = box_on_a_floor(
      0.3, 0.4, 0.0,
      R"(, "loads": [{"type": "force", "name": "pull", "body": "box", "times": [0, 1], "forces": [[0, 0, 0], [16, 0, 0]]}])");
  const Estimated run = estimated(scene);
  EXPECT_EQ(run.estimate.changes.sudden, 1U);
  EXPECT_EQ(run.estimate.changes.stops, 0U);
  // 2 N and 16 N/s on 2 kg for 0.5 s.
  const double way = 0.5 * 1.0 * 0.25 + 8.0 * 0.125 / 6.0;
  EXPECT_GE(run.estimate.bodies.at(0).position.error(),
            std::abs(run.frames.back().poses[0].position.x() - way));
}

TEST(ErrorEstimate, ASwingHasNoSuddenChanges) {
  const Estimated run = Pendulum::run(IntegratorKind::rattle, 1);
  EXPECT_EQ(run.estimate.changes.sudden, 0U);
  EXPECT_EQ(run.estimate.changes.count(), 0U);
  EXPECT_EQ(run.estimate.position.unseen, 0.0);
}

TEST(ErrorEstimate, KnowsAChaoticMotion) {
  // Both bars upright: errors grow with the rate at which two of them side by side fall apart, and
  // soon the runs have nothing in common.
  SceneResult loaded = load_scene(SHEAVE_SOURCE_DIR "/scenes/analytic/double-pendulum.json");
  ASSERT_TRUE(loaded);
  Scene scene = std::move(*loaded.scene);
  scene.duration = 20.0;
  const Estimated run = estimated(scene);
  EXPECT_EQ(run.estimate.position_kind, StepErrorKind::chaos);
  ASSERT_TRUE(run.estimate.growth);
  EXPECT_GT(*run.estimate.growth, 0.1);
  EXPECT_GT(run.estimate.trusted_time, 1.0);
  EXPECT_LT(run.estimate.trusted_time, 20.0);
}

TEST(ErrorEstimate, BeginsAtAStateAndEndsWhereAFinerRunEnds) {
  const Scene scene = scene_of(test::cable_pendulum(1.0, 1.0, 0.5), IntegratorKind::rattle, 4);
  Simulation simulation = test::start({scene.model, scene.cables});
  test::run(simulation.world, 0.5);
  Result<ErrorEstimator> estimator = ErrorEstimator::create(scene, simulation.world.state());
  ASSERT_TRUE(estimator);
  EXPECT_NEAR(estimator->estimate().end, 0.5, 1e-12);
  EXPECT_EQ(estimator->estimate().position.largest, 0.0);
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(simulation.world.step().ok());
    estimator->observe(simulation);
  }
  EXPECT_NEAR(estimator->estimate().end, 1.0, 1e-12);
  EXPECT_NEAR(*estimator->estimate().position.order, 2.0, 0.1);
}

TEST(ErrorEstimate, NeedsRoomForFinerRuns) {
  Scene scene = scene_of(test::cable_pendulum(1.0, 1.0, 0.5), IntegratorKind::rattle, 25'001);
  const Simulation simulation = test::start({scene.model, scene.cables});
  const Result<ErrorEstimator> refused = ErrorEstimator::create(scene, simulation.world.state());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].path, "/step/substeps");
  EXPECT_NE(refused.errors()[0].message.find("at most 25000"), std::string::npos);
}

}  // namespace
}  // namespace sheave::measure
