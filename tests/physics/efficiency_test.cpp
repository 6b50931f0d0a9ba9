// Wheels that take a part of the tension, whichever way they turn: out = in x efficiency.
//
// Tackle of n parts with the load M and the effort m, whose sheaves have the efficiency e. Where the
// effort hauls, part k from it has e^k of its tension, so the parts carry A T with A = e + ... + e^n;
// where the load lowers it, T / e^k. With the effort n times as fast, either way
//
//   A m (g - n a) = M (g + a)   =>   a = (A m - M) g / (M + n A m)

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::efficiency {
namespace {

constexpr double gravity = 9.81;

/// What n parts carry of the effort's tension.
double advantage(int parts, double efficiency) {
  double sum = 0.0;
  for (int k = 1; k <= parts; ++k) sum += std::pow(efficiency, k);
  return sum;
}

/// A tackle of `parts` between a beam and a block of `load` kg; sheaves without inertia.
/// `speed`: of the block, upwards [m/s].
Simulation tackle(int parts, double efficiency, double load, double effort, int substeps = 0,
                  IntegratorKind integrator = IntegratorKind::rattle, double speed = 0.0) {
  std::string bodies = fmt::format(
      R"({{"name": "block", "mobility": "slider", "axis": [0, 1, 0], "position": [0, -3, 0], "mass": {},
"velocity": [0, {}, 0]}},
{{"name": "effort", "mobility": "slider", "axis": [0, 1, 0], "position": [{}, -2, 0], "mass": {},
"velocity": [0, {}, 0]}})",
      load, speed, 0.4 * parts, effort, -parts * speed);
  std::string links = R"({"type": "attachment", "body": "world", "point": [0, 0, 0]})";
  for (int k = 0; k < parts; ++k) {
    const bool below = k % 2 == 0;
    // A sheave of 0.2 m between the parts at 0.4 k and 0.4 (k + 1).
    bodies += fmt::format(
        R"(, {{"name": "s{}", "mobility": "rotor", {}"position": [{}, {}, 0], "mass": 0.001, "spin_inertia": 0,
"shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}})",
        k, below ? R"("mount": "block", )" : "", 0.4 * k + 0.2, below ? -3 : 0);
    links +=
        fmt::format(R"(, {{"type": "rolling", "body": "s{}", "winding": "{}", "efficiency": {}}})",
                    k, below ? "counter-clockwise" : "clockwise", efficiency);
  }
  links += R"(, {"type": "attachment", "body": "effort"})";
  const std::string text = fmt::format(
      R"({{"format": "sheave-scene/1", "duration": 0.25, "gravity": [0, -9.81, 0], "bodies": [{}],
"cables": [{{"name": "rope", "links": [{}]}}]}})",
      bodies, links);
  SceneResult loaded = load_scene_text(text, "test");
  for (const SceneError& error : loaded.errors) ADD_FAILURE() << to_string(error);
  Scene& scene = *loaded.scene;
  if (substeps > 0) scene.model.step.substeps = substeps;
  scene.model.step.integrator = integrator;
  Result<Simulation> made = create_simulation(scene);
  return std::move(made).value();
}

/// Of the block, from rest.
double acceleration(Simulation& simulation) {
  for (int i = 0; i < 15; ++i) EXPECT_TRUE(simulation.step().ok());
  const State& state = simulation.world.state();
  return state.bodies[0].velocity.y() / state.time;
}

/// The header's, with what the parts carry of the effort's tension.
double expected_acceleration(double carried, int parts, double load, double effort) {
  return (carried * effort - load) * gravity / (load + parts * carried * effort);
}

TEST(Efficiency, FourPartsAt917) {
  // Catalogues round 3.236 to 3.25.
  const double up = advantage(4, 0.917);
  EXPECT_NEAR(up, 3.25, 0.02);
  const double load = 12.0 + 2.0 * 0.001;  // with the sheaves that the block carries
  Simulation simulation = tackle(4, 0.917, 12.0, 4.0);
  const double expected = expected_acceleration(up, 4, load, 4.0);
  EXPECT_GT(expected, 0.0);
  // Of second order in the step, and the sheaves' steps are exact: rounding.
  EXPECT_NEAR(acceleration(simulation), expected, 1e-6 * gravity);
  const CableReport report = simulation.cable_reports()[0];
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(report.spans[k].tension, 0.917 * report.spans[k + 1].tension, 1e-5) << k;
  }
}

TEST(Efficiency, ALoweredLoadFollowsTheInverseEfficiency) {
  const auto lower = [](int parts, double efficiency, double effort) {
    const double load = 12.0 + 0.5 * parts * 0.001;  // with the sheaves that the block carries
    Simulation simulation = tackle(parts, efficiency, 12.0, effort);
    const double down = advantage(parts, 1.0 / efficiency);
    const double expected = expected_acceleration(down, parts, load, effort);
    EXPECT_LT(expected, 0.0);
    EXPECT_NEAR(acceleration(simulation), expected, 1e-6 * gravity);
    const CableReport report = simulation.cable_reports()[0];
    for (std::size_t k = 0; k + 1 < report.spans.size(); ++k) {
      EXPECT_NEAR(report.spans[k + 1].tension, efficiency * report.spans[k].tension, 1e-5) << k;
    }
  };
  lower(4, 0.917, 2.0);
  lower(8, 0.98, 1.0);
}

TEST(Efficiency, EightPartsAt98) {
  const double up = advantage(8, 0.98);
  EXPECT_NEAR(up, 7.312, 0.001);
  const double load = 12.0 + 4.0 * 0.001;
  Simulation simulation = tackle(8, 0.98, 12.0, 2.0);
  const double expected = expected_acceleration(up, 8, load, 2.0);
  EXPECT_NEAR(acceleration(simulation), expected, 1e-6 * gravity);
  const std::optional<Certificate> certificate = simulation.certificate();
  ASSERT_TRUE(certificate.has_value());
}

// Rigid parts that hold a block together share its load at the start, so that every sheave is found
// to slip the right way, in the first substep already, or to hold.
TEST(Efficiency, TacklesStartTheRightWayOrRest) {
  const double up = advantage(4, 0.9);
  const double down = advantage(4, 1.0 / 0.9);
  const double load = 12.0 + 2.0 * 0.001;
  for (const double effort : {1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4, 3.0, 3.6, 4.0, 5.0}) {
    for (const int substeps : {1, 4, 16, 64}) {
      for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
        Simulation simulation = tackle(4, 0.9, 12.0, effort, substeps, integrator);
        const double carried = effort * up > load ? up : down;
        const bool rests = effort * up <= load && effort * down >= load;
        const double expected = rests ? 0.0 : expected_acceleration(carried, 4, load, effort);
        EXPECT_NEAR(acceleration(simulation), expected, 1e-6 * gravity)
            << effort << " kg, " << substeps << " substeps, "
            << integrator_names[static_cast<std::size_t>(integrator)];
        const std::optional<Certificate> certificate = simulation.certificate();
        ASSERT_TRUE(certificate.has_value());
        EXPECT_TRUE(certificate->clean()) << effort << " kg, " << substeps << " substeps";
      }
    }
  }
}

TEST(Efficiency, WheelsTurnWithTheRope) {
  Simulation simulation = tackle(4, 0.917, 12.0, 4.0);
  acceleration(simulation);
  const State& state = simulation.world.state();
  // The last sheave, on the beam, turns with all that the effort moves: clockwise, by y / r.
  const double way = state.bodies[1].position.y() + 2.0;
  EXPECT_NEAR(state.bodies[5].angle, way / 0.2, 1e-9);
}

// Moving blocks that coast lose by the way they go, whatever pulls: up with e^k on the parts, down
// with its reciprocals. Forces are constant until it stops.
TEST(Efficiency, TacklesThatCoastLoseAgainstTheirTravel) {
  for (const double speed : {0.5, -0.5}) {
    for (const double effort : {2.0, 3.0, 4.0, 5.0}) {
      for (const int substeps : {1, 4, 64}) {
        for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
          Simulation simulation = tackle(4, 0.9, 12.0, effort, substeps, integrator, speed);
          for (int i = 0; i < 6; ++i) ASSERT_TRUE(simulation.step().ok());
          const State& state = simulation.world.state();
          const double load = 12.0 + 2.0 * 0.001;
          const double carried = advantage(4, speed > 0.0 ? 0.9 : 1.0 / 0.9);
          const double a = expected_acceleration(carried, 4, load, effort);
          ASSERT_GT(speed * (speed + a * state.time), 0.0);
          EXPECT_NEAR(state.bodies[0].velocity.y(), speed + a * state.time, 1e-7)
              << speed << " m/s, " << effort << " kg, " << substeps << " substeps";
          const std::optional<Certificate> certificate = simulation.certificate();
          ASSERT_TRUE(certificate.has_value());
          EXPECT_TRUE(certificate->clean()) << certificate->worst()->sentence();
        }
      }
    }
  }
}

/// An Atwood machine over a wheel with these settings and this link: the first fault's message.
std::string fault_of(const char* wheel, const char* link) {
  const std::string text = fmt::format(
      R"({{"format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0], "bodies": [
    {{"name": "wheel", "mass": 1, "shape": {{"type": "cylinder", "radius": 0.5, "length": 0.1}}, {}}},
    {{"name": "l", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]}},
    {{"name": "r", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0.5, -2, 0]}}],
    "cables": [{{"name": "rope", "links": [{{"type": "attachment", "body": "l"}},
      {{"type": "rolling", "body": "wheel", "winding": "clockwise", "efficiency": 0.9{}}}, {{"type": "attachment", "body": "r"}}]}}]}})",
      wheel, link);
  const SceneResult scene = load_scene_text(text, "test");
  return scene ? std::string() : scene.errors[0].message;
}

TEST(Efficiency, NeedsABearing) {
  EXPECT_EQ(fault_of(R"("mobility": "rotor")", ""), "");
  EXPECT_EQ(fault_of(R"("mobility": "rotor", "spin_inertia": 0)", ""), "");
  EXPECT_NE(fault_of(R"("mobility": "static")", "").find("rotor"), std::string::npos);
  EXPECT_NE(fault_of(R"("mobility": "rotor", "drive": "speed", "drive_times": [0, 1],
"drive_values": [1, 1])",
                     "")
                .find("drive"),
            std::string::npos);
  EXPECT_NE(fault_of(R"("mobility": "rotor")", R"(, "center": [0.1, 0, 0])").find("axle"),
            std::string::npos);
}

/// A block of `load` kg hangs in four parts from the head of a boom, which a stay holds; the drum
/// stands. The sheaves have the efficiency `efficiency`. The rope breaks at `over` times the most
/// that losses leave it at the drum, the tension that just does not haul the load.
Simulation boom_tackle(double efficiency, double over, int substeps, IntegratorKind integrator) {
  constexpr double load = 5000.0;
  constexpr double length = 20.0;
  constexpr double radius = 0.3;
  const double c = std::cos(0.87);
  const double s = std::sin(0.87);
  std::string bodies = fmt::format(
      R"({{"name": "boom", "mobility": "planar", "rotation": {{"degrees": {}}}, "mass": 3000,
"shape": {{"type": "box", "size": [20, 0.4, 0.4], "position": [10, 0, 0]}}}},
{{"name": "block", "mobility": "slider", "axis": [0, 1, 0], "position": [{}, {}, 0], "mass": {}}},
{{"name": "drum", "mobility": "rotor", "position": [-1.5, 0.2, 0], "mass": 200,
"shape": {{"type": "cylinder", "radius": 0.35, "length": 0.8}}, "drive": "speed", "drive_values": [0]}})",
      0.87 * 180.0 / std::numbers::pi, length * c, length * s - 10.0, load);
  std::string links =
      R"({"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 20})";
  for (const char* name : {"h1", "b1", "h2", "b2"}) {
    const bool above = name[0] == 'h';
    bodies += fmt::format(
        R"(, {{"name": "{0}", "mobility": "rotor", "mount": "{1}", "relative_to": "{1}",
"position": [{2}, 0, 0], "mass": 0.001, "spin_inertia": 0,
"shape": {{"type": "cylinder", "radius": {3}, "length": 0.1}}}})",
        name, above ? "boom" : "block", above ? length : 0.0, radius);
    links += fmt::format(
        R"(, {{"type": "rolling", "body": "{}", "winding": "clockwise", "efficiency": {}}})", name,
        efficiency);
  }
  links += fmt::format(R"(, {{"type": "attachment", "body": "boom", "point": [{}, {}, 0]}})",
                       length - radius * c, radius * s);
  const std::string text = fmt::format(
      R"({{"format": "sheave-scene/1", "duration": 2, "gravity": [0, -9.81, 0], "bodies": [{}],
"joints": [{{"type": "hinge", "name": "foot", "body_a": "world", "body_b": "boom", "anchor": [0, 0, 0], "axis": [0, 0, 1]}}],
"cables": [{{"name": "rope", "breaking_tension": {}, "links": [{}]}},
{{"name": "stay", "links": [{{"type": "attachment", "body": "world", "point": [-3, 7, 0]}},
{{"type": "attachment", "body": "boom", "point": [19, 0.2, 0]}}]}}]}})",
      bodies, over * load * gravity / advantage(4, efficiency), links);
  SceneResult loaded = load_scene_text(text, "test");
  for (const SceneError& error : loaded.errors) ADD_FAILURE() << to_string(error);
  loaded.scene->model.step.substeps = substeps;
  loaded.scene->model.step.integrator = integrator;
  Result<Simulation> made = create_simulation(*loaded.scene);
  return std::move(made).value();
}

// Losses leave the tensions of a standing rope open within a range, and shares change from substep
// to substep. None of them exceeds the most of the range. (Extrapolated to the instant they did, by
// up to 15 %, and the rope broke.)
TEST(Efficiency, AStandingRopeDoesNotBreakAboveTheMostThatLossesLeaveIt) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 4, 16}) {
      for (const double efficiency : {0.9, 0.94, 0.96, 0.98}) {
        SCOPED_TRACE(testing::Message() << substeps << " substeps, efficiency " << efficiency);
        Simulation simulation = boom_tackle(efficiency, 1.005, substeps, integrator);
        for (int i = 0; i < 90; ++i) {
          ASSERT_TRUE(simulation.step().ok());
          ASSERT_TRUE(simulation.cables->events().empty()) << simulation.world.state().time;
        }
      }
    }
  }
}

// Losses that help leave the drum (e + ... + e^4) / (1 / e + ... + 1 / e^4) = 0.817 of the most. A rope
// that is weaker breaks at once.
TEST(Efficiency, AStandingRopeBreaksBelowTheLeastThatLossesLeaveIt) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 4, 16}) {
      Simulation simulation = boom_tackle(0.96, 0.8, substeps, integrator);
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(simulation.step().ok());
      EXPECT_FALSE(simulation.cables->events().empty());
    }
  }
}

}  // namespace
}  // namespace sheave::efficiency
