// Equilibria against closed forms, and against motion that damping has settled.

#include "statics/equilibrium.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;
using testing::tension;

/// Newton's method ends where rounding is left: 1e-11 of forces and of the scene's size.
constexpr double exact = 1e-9;

TEST(Equilibrium, WeightFallsIntoTwoRopes) {
  // Ropes of 1 m from points 1.2 m apart, in the shape 3-4-5: 2 T 0.8 = 20 N. It begins beside and
  // above, with slack ropes.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "load", "mass": 2, "inertia": [1, 1, 1], "position": [0.1, -0.3, 0]}],
    "cables": [
    {"name": "a", "rest_lengths": [1], "links": [{"type": "attachment", "body": "world", "point": [-0.6, 0, 0]},
      {"type": "attachment", "body": "load"}]},
    {"name": "b", "rest_lengths": [1], "links": [{"type": "attachment", "body": "world", "point": [0.6, 0, 0]},
      {"type": "attachment", "body": "load"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const Vector3 place = simulation.world.state().bodies[0].position;
  EXPECT_NEAR(place.x(), 0.0, exact);
  EXPECT_NEAR(place.y(), -0.8, exact);
  EXPECT_NEAR(tension(simulation, 0, 0), 12.5, 12.5 * exact);
  EXPECT_NEAR(tension(simulation, 1, 0), 12.5, 12.5 * exact);
  // It can turn about its centre as it likes, and swings in one direction.
  EXPECT_EQ(rest.stability, Stability::neutral);
  EXPECT_EQ(rest.neutral_motions, 3);
}

TEST(Equilibrium, RopeOutOfAWheelsPlanePullsAlongItself) {
  // A load on two ropes, from a point and from a locked wheel of 1 m with an upright axle, which
  // its rope leaves 45 degrees out of the wheel's plane. Where it rests is the lowest of all places
  // that the lengths allow, found by itself: the rope's way is r phi + l, it leaves at D = r / cos
  // b, and in plan the line from (6, 1) in the direction g has the distance D = 6 sin g + cos g
  // from the axle, along which lie the stay (s in plan, sqrt(18) long) and the rope (m in plan).
  // Bisection of g:
  //   g = 0.07317232315258, b = 0.8184, T = 981 / (sin b + cos b y / s), S = T cos b sqrt(18) / s.
  // (Before, it rested at z = 1.19335, and the forces that were told came to -63 N along z.)
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 10, "rotation": {"axis": [1, 0, 0], "degrees": -90},
     "shape": {"type": "cylinder", "radius": 1, "length": 0.1}, "drive": "speed", "drive_values": [0]},
    {"name": "load", "mass": 100, "position": [3, -3, 1], "shape": {"type": "sphere", "radius": 0.1}}],
    "cables": [
    {"name": "rope", "links": [{"type": "attachment", "body": "world", "point": [6, 0, -1]},
      {"type": "rolling", "body": "wheel", "winding": "counter-clockwise"},
      {"type": "attachment", "body": "load"}]},
    {"name": "stay", "links": [{"type": "attachment", "body": "load"},
      {"type": "attachment", "body": "world", "point": [6, 0, 1]}]}])",
                                        "[0,-9.81,0]");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const Vector3 place = simulation.world.state().bodies[1].position;
  EXPECT_NEAR(place.x(), 3.016523829407698, exact);
  EXPECT_NEAR(place.y(), -3.0084948023734412, exact);
  EXPECT_NEAR(place.z(), 1.2186983392709694, exact);
  EXPECT_NEAR(tension(simulation, 0, 1), 691.8124518860091, 700.0 * exact);
  EXPECT_NEAR(tension(simulation, 1, 0), 683.2727487016248, 700.0 * exact);
  // All that pulls at the load is told.
  const auto ropes = simulation.cable_reports();
  const SpanReport& rope = ropes[0].spans[1];
  const SpanReport& stay = ropes[1].spans[0];
  const Vector3 sum = rope.tension / rope.length * (rope.start - rope.end) +
                      stay.tension / stay.length * (stay.end - stay.start) +
                      Vector3(0.0, -981.0, 0.0);
  EXPECT_LT(sum.norm(), 700.0 * exact);
  Vector3 held = Vector3::Zero();
  for (const SupportReaction& one : support_reactions(simulation, rest.forces)) held += one.force;
  EXPECT_LT((held - Vector3(0.0, 110.0 * 9.81, 0.0)).norm(), 1100.0 * exact);
}

TEST(Equilibrium, SlackRopeIsFound) {
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
    "cables": [
    {"name": "tight", "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]},
    {"name": "loose", "rest_lengths": [1.25], "links": [{"type": "attachment", "body": "world"},
      {"type": "attachment", "body": "load"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(tension(simulation, 0, 0), 20.0, exact);
  ASSERT_EQ(rest.slack_spans.size(), 1U);
  EXPECT_EQ(rest.slack_spans[0].cable, 1);
  EXPECT_NEAR(rest.slack_spans[0].slack, 0.25, exact);
}

TEST(Equilibrium, ParallelRopesShareByStiffness) {
  // Springs of EA / L: 1000 / 1 and 3000 / 1 N/m share 20 N as 1 to 3, stretched by 5 mm.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
    "cables": [
    {"name": "a", "axial_stiffness": 1000, "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]},
    {"name": "b", "axial_stiffness": 3000, "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(simulation.world.state().bodies[0].position.y(), -1.005, exact);
  EXPECT_NEAR(tension(simulation, 0, 0), 5.0, 20.0 * exact);
  EXPECT_NEAR(tension(simulation, 1, 0), 15.0, 20.0 * exact);
  EXPECT_EQ(rest.redundant, 0);
}

TEST(Equilibrium, RedundantRigidRopesAreReported) {
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
    "cables": [
    {"name": "a", "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]},
    {"name": "b", "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_EQ(rest.redundant, 1);
  EXPECT_NEAR(tension(simulation, 0, 0) + tension(simulation, 1, 0), 20.0, exact);
}

TEST(Equilibrium, NetHangsInTheFunicularPolygon) {
  // Knots of 1 kg on a rope in five spans of equal weights: the horizontal force H is the same in
  // all, and the vertical one grows by 10 N from knot to knot. Nothing else is needed to check.
  std::string bodies;
  std::string cables;
  for (int i = 0; i < 4; ++i) {
    bodies += fmt::format(
        R"({}{{"name": "k{}", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [1, 1, 1], "position": [{}, -0.3, 0]}})",
        i == 0 ? "" : ", ", i, 0.8 * (i + 1));
  }
  for (int i = 0; i < 5; ++i) {
    const std::string from = i == 0 ? R"("body": "world")" : fmt::format(R"("body": "k{}")", i - 1);
    const std::string to =
        i == 4 ? R"("body": "world", "point": [4, 0.5, 0])" : fmt::format(R"("body": "k{}")", i);
    cables += fmt::format(
        R"({}{{"name": "c{}", "rest_lengths": [1.2], "links": [{{"type": "attachment", {}}}, {{"type": "attachment", {}}}]}})",
        i == 0 ? "" : ", ", i, from, to);
  }
  Simulation simulation =
      simulation_of("\"bodies\": [" + bodies + "], \"cables\": [" + cables + "]");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  double across = 0.0;
  double before = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    const SpanReport span = simulation.cable_reports()[i].spans[0];
    EXPECT_NEAR(span.length, 1.2, exact);
    const Vector3 force = span.tension * (span.end - span.start).normalized();
    if (i == 0) across = force.x();
    EXPECT_NEAR(force.x(), across, 40.0 * exact);
    if (i > 0) {
      EXPECT_NEAR(force.y() - before, 10.0, 40.0 * exact);
    }
    before = force.y();
  }
  EXPECT_EQ(rest.unstable_motions, 0);
}

TEST(Equilibrium, UprightPendulumIsUnstable) {
  const char* parts =
      R"("bodies": [{"name": "rod", "mobility": "planar", "axis": [0, 0, 1], "mass": 1,
      "position": [0, %, 0], "shape": {"type": "box", "size": [0.04, 1, 0.04]}}],
      "joints": [{"type": "hinge", "name": "pin", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1]}])";
  const auto at = [&](const std::string& height) {
    std::string text = parts;
    text.replace(text.find('%'), 1, height);
    return simulation_of(text);
  };
  Simulation upright = at("0.5");
  const Equilibrium above = find_equilibrium(upright);
  ASSERT_TRUE(above.converged) << above.message;
  EXPECT_EQ(above.stability, Stability::unstable);
  EXPECT_EQ(above.unstable_motions, 1);
  Simulation hanging = at("-0.5");
  const Equilibrium below = find_equilibrium(hanging);
  ASSERT_TRUE(below.converged) << below.message;
  EXPECT_EQ(below.stability, Stability::stable);
}

/// The worked example of DAVE's manual: a grommet of EA = 3000 kN, doubled, carries 100 kN in four
/// parts. Its friction of 0.1 at a circle means tensions in the ratio r = 1.1 / 0.9 of both sides;
/// with the directions -, +, + (and what is left at the fourth, -) they are r x, x, r x, r^2 x with
/// the sum (1 + r)^2 x = 100 kN: the largest is 100 kN (r / (1 + r))^2 = 30.25 kN.
///
/// Which way cable has slid before is not in the pose, so statics leaves these directions open:
/// they are given by how much of the cable is in which part.
TEST(Equilibrium, FourPartsOfAGrommetWithFriction) {
  constexpr double stiffness = 3e6;
  constexpr double height = 10.0;
  const double ratio = 1.1 / 0.9;
  const double least = 1e5 / ((1.0 + ratio) * (1.0 + ratio));
  const std::array pulls{ratio * least, least, ratio * least, ratio * ratio * least};
  std::string lengths;
  for (const double pull : pulls) {
    lengths += fmt::format("{}{}", lengths.empty() ? "" : ", ", height / (1.0 + pull / stiffness));
  }
  // Each turns the cable by pi. A bound that rounding does not pass.
  const double friction = 1.000001 * std::log(ratio) / pi;
  const std::string text = fmt::format(
      R"("bodies": [{{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 10000, "position": [0, -0.005, 0]}}],
    "cables": [{{"name": "grommet", "closed": true, "axial_stiffness": 3e6, "rest_lengths": [{1}], "links": [
      {{"type": "pinhole", "body": "world", "point": [0, 10, 0], "friction": {0}}}, {{"type": "pinhole", "body": "load", "friction": {0}}},
      {{"type": "pinhole", "body": "world", "point": [0, 10, 0], "friction": {0}}}, {{"type": "pinhole", "body": "load", "friction": {0}}}]}}])",
      friction, lengths);
  Simulation simulation = simulation_of(text);
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(simulation.world.state().bodies[0].position.y(), 0.0, exact);
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    EXPECT_NEAR(tension(simulation, 0, i), pulls[i], 1e5 * exact) << i;
  }
  EXPECT_NEAR(tension(simulation, 0, 3), 30250.0, 1e5 * exact);
}

/// Without friction all four parts have the same tension.
TEST(Equilibrium, FourPartsOfAGrommet) {
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 10000, "position": [0, 0, 0]}],
    "cables": [{"name": "grommet", "closed": true, "axial_stiffness": 3e6, "links": [
      {"type": "pinhole", "body": "world", "point": [-1, 9, 0]}, {"type": "pinhole", "body": "load", "point": [-1, 0, 0]},
      {"type": "pinhole", "body": "world", "point": [1, 9, 0]}, {"type": "pinhole", "body": "load", "point": [1, 0, 0]}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  double sum = 0.0;
  const CableReport grommet = simulation.cable_reports()[0];
  for (const SpanReport& span : grommet.spans) {
    sum += span.tension * std::abs((span.end - span.start).normalized().y());
    EXPECT_NEAR(span.tension, tension(simulation, 0, 0), 1e5 * exact);
  }
  EXPECT_NEAR(sum, 1e5, 1e5 * exact);
}

/// The four-bar linkage of the IFToMM library of benchmarks, as a parallelogram of rods of 1 m
/// whose spring along the diagonal is relaxed at 1.2 m: rods of m = 1 kg, k = 100 N/m. With the
/// angle a of the cranks from the horizontal the energy is 2 m g sin a (two cranks, and the coupler
/// on top) and k (l - 1.2 m)^2 / 2 with l^2 = 2 + 2 cos a; the derivative's zero is found by
/// bisection.
TEST(Equilibrium, FourBarLinkageWithADiagonalSpring) {
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "left", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0.5, 0]},
    {"name": "coupler", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0.5, 1, 0]},
    {"name": "right", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [1, 0.5, 0]}],
    "joints": [
    {"type": "hinge", "name": "a", "body_b": "left", "anchor": [0, 0, 0], "axis": [0, 0, 1]},
    {"type": "hinge", "name": "b", "body_a": "left", "body_b": "coupler", "anchor": [0, 1, 0], "axis": [0, 0, 1]},
    {"type": "hinge", "name": "c", "body_a": "coupler", "body_b": "right", "anchor": [1, 1, 0], "axis": [0, 0, 1]},
    {"type": "hinge", "name": "d", "body_b": "right", "anchor": [1, 0, 0], "axis": [0, 0, 1]},
    {"type": "distance", "name": "spring", "body_b": "right", "anchor_a": [0, 0, 0], "anchor_b": [1, 1, 0], "length": 1.2, "compliance": 0.01}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const Vector3 middle = simulation.world.state().bodies[2].position;
  const double found = std::atan2(middle.y(), middle.x() - 1.0);
  const auto slope = [](double a) {
    const double l = std::sqrt(2.0 + 2.0 * std::cos(a));
    return 20.0 * std::cos(a) - 100.0 * (l - 1.2) * std::sin(a) / l;
  };
  double low = found - 1e-3;
  double high = found + 1e-3;
  ASSERT_LT(slope(low) * slope(high), 0.0);
  for (int i = 0; i < 60; ++i) {
    const double half = 0.5 * (low + high);
    (slope(low) * slope(half) <= 0.0 ? high : low) = half;
  }
  EXPECT_NEAR(found, low, 1e-10);
}

TEST(Equilibrium, AgreesWithMotionThatDampingHasSettled) {
  const std::string parts = R"("bodies": [
    {"name": "a", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0.5, -0.6, 0],
     "damping": 6, "angular_damping": 2},
    {"name": "b", "mobility": "planar", "axis": [0, 0, 1], "mass": 3, "inertia": [0.1, 0.1, 0.1], "position": [1.3, -0.7, 0],
     "damping": 8, "angular_damping": 2}],
    "cables": [
    {"name": "l", "axial_stiffness": 800, "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "a"}]},
    {"name": "m", "axial_stiffness": 800, "links": [{"type": "attachment", "body": "a"}, {"type": "attachment", "body": "b"}]},
    {"name": "r", "links": [{"type": "attachment", "body": "b"}, {"type": "attachment", "body": "world", "point": [2, 0, 0]}]}])";
  Simulation still = simulation_of(parts);
  const Equilibrium rest = find_equilibrium(still);
  ASSERT_TRUE(rest.converged) << rest.message;
  Simulation moving = simulation_of(parts);
  // The slowest motion fades with some 1.3 /s: 30 s leave e^-40.
  for (int i = 0; i < 60 * 30; ++i) ASSERT_TRUE(moving.step().ok());
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3 off =
        still.world.state().bodies[i].position - moving.world.state().bodies[i].position;
    EXPECT_LT(off.norm(), 1e-8);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(tension(still, i, 0), tension(moving, i, 0), 1e-8 * 40.0);
  }
}

TEST(Equilibrium, RowsWithoutGradientsAreNoFault) {
  // A slider that holds a planar body has rows for what that cannot do: without gradients. A
  // trolley of 3 kg that its drive holds, 2 kg below it: 50 N on the rail.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "trolley", "mobility": "planar", "axis": [0, 0, 1], "mass": 3, "inertia": [1, 1, 1]},
    {"name": "rod", "mobility": "planar", "axis": [0, 0, 1], "mass": 2, "position": [0, -0.5, 0], "inertia": [0.1, 0.1, 0.1]}],
    "joints": [
    {"type": "slider", "name": "rail", "body_b": "trolley", "anchor": [0, 0, 0], "axis": [1, 0, 0], "drive": "speed", "drive_values": [0]},
    {"type": "hinge", "name": "pin", "body_a": "trolley", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1]}],
    "cables": [{"name": "spring", "axial_stiffness": 60, "rest_lengths": [0.9], "links": [
      {"type": "attachment", "body": "world", "point": [-1, -1.2, 0]}, {"type": "attachment", "body": "rod", "point": [0, -0.5, 0]}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const SpanReport spring = simulation.cable_reports()[0].spans[0];
  const Vector3 pull = spring.tension * (spring.start - spring.end).normalized();
  const JointReport rail = joint_reports(simulation.world)[0];
  EXPECT_NEAR(rail.force.y(), 50.0 - pull.y(), 50.0 * exact);
  EXPECT_NEAR(rail.force.x(), -pull.x(), 50.0 * exact);
}

// Weights draw three boxes on four rough points each to their wheels. Where no sides of the friction
// rows agree with their bounds, a step takes a few changes of sides and not 200. The search has some
// 50 iterations and tens of rows, each of which may change sides a few times in an iteration.
TEST(Equilibrium, FrictionOfSlidingBoxesTakesFewSolutions) {
  SceneResult scene =
      load_scene(std::string(SHEAVE_SOURCE_DIR) + "/tests/outside/boxes-on-a-table.json");
  ASSERT_TRUE(scene.errors.empty());
  Simulation simulation = simulation_of(*scene);
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_LT(rest.solutions, 20000);  // 65 thousand with cycles
  for (std::size_t i = 0; i < 3; ++i) {
    const double weight = (i == 0 ? 2.4 : 2.6) * 9.81;
    EXPECT_NEAR(tension(simulation, i, 0), weight, weight * exact);
  }
}

TEST(Equilibrium, LighterWeightFindsItsRestBesideTheWheel) {
  // 1 kg and 2 kg over a wheel of r = 0.5 m at whose sides their rails stand: the lighter one rises
  // until its rope, a tangent of 20 N, lies at 60 degrees to the plumb, r tan 30 above the axle.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 1, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0]}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "light"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "heavy"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(simulation.world.state().bodies[1].position.y(), 0.5 / std::sqrt(3.0), exact);
  EXPECT_NEAR(tension(simulation, 0, 0), 20.0, 20.0 * exact);
}

/// A carriage on rails along x between a counterweight of `counterweight` kg, whose rope runs to the
/// left over a sheave 12 m away and down, and a rope of EA = `stiffness` with n beads of 63 kg that
/// hang in it, to a point 300 m to the right.
std::string ropeway(double stiffness, int n, double counterweight) {
  std::string beads;
  std::string links;
  for (int i = 1; i <= n; ++i) {
    const double share = static_cast<double>(i) / (n + 1);
    beads += fmt::format(
        R"(, {{"name": "bead {}", "mass": 63, "position": [{}, {}, 0], "shape": {{"type": "sphere", "radius": 0.1}}}})",
        i, 300.0 * share, -28.0 * share * (1.0 - share));
    links += fmt::format(R"({{"type": "attachment", "body": "bead {}"}}, )", i);
  }
  return fmt::format(
      R"("bodies": [
    {{"name": "carriage", "mobility": "slider", "axis": [1, 0, 0], "mass": 3000}},
    {{"name": "sheave", "mobility": "rotor", "mass": 100, "spin_inertia": 0, "position": [-12, -0.5, 0],
      "shape": {{"type": "cylinder", "radius": 0.5, "length": 0.2}}}},
    {{"name": "counterweight", "mobility": "slider", "axis": [0, 1, 0], "mass": {}, "position": [-12.5, -8, 0]}}{}],
    "cables": [
    {{"name": "haul", "axial_stiffness": {}, "links": [{{"type": "attachment", "body": "carriage"}}, {}
      {{"type": "attachment", "body": "world", "point": [300, 0, 0]}}]}},
    {{"name": "tension rope", "links": [{{"type": "attachment", "body": "carriage"}},
      {{"type": "rolling", "body": "sheave", "winding": "counter-clockwise"}},
      {{"type": "attachment", "body": "counterweight"}}]}}])",
      counterweight, beads, stiffness, links);
}

/// Where the carriage of it rests: the haul rope is a funicular polygon with the horizontal tension
/// H = counterweight x g and the vertical ones w (n / 2 - i), of spans that are L_i = l_i at first and
/// stretch by T_i / EA: x = 300 - sum L_i (1 + T_i / EA) H / T_i.
double carriage_at(double stiffness, int n, double counterweight) {
  const double pull = 10.0 * counterweight;
  double x = 300.0;
  for (int i = 0; i <= n; ++i) {
    const auto height = [n](int k) {
      const double share = static_cast<double>(k) / (n + 1);
      return -28.0 * share * (1.0 - share);
    };
    const double length = std::hypot(300.0 / (n + 1), height(i + 1) - height(i));
    const double tension = std::hypot(pull, 630.0 * (0.5 * n - i));
    x -= length * (1.0 + tension / stiffness) * pull / tension;
  }
  return x;
}

TEST(Equilibrium, RopeStaysOnTheSheaveThatTheSearchPasses) {
  // The search moves by up to a tenth of 300 m at a step, over the sheave at 12 m and back. What it
  // passes there has not happened: the rope lies on the sheave, by a quarter of a turn.
  for (const auto& [stiffness, n] : {std::pair(1e6, 0), std::pair(1e8, 9), std::pair(1e8, 29)}) {
    SCOPED_TRACE(fmt::format("EA {} with {} beads", stiffness, n));
    const double mass = n == 0 ? 1000.0 : 20000.0;
    Simulation simulation = simulation_of(ropeway(stiffness, n, mass));
    const Equilibrium rest = find_equilibrium(simulation);
    ASSERT_TRUE(rest.converged) << rest.message;
    EXPECT_TRUE(rest.events.empty());
    const double x = carriage_at(stiffness, n, mass);
    // Within 1e-8 of the size, what the search may leave.
    EXPECT_NEAR(simulation.world.state().bodies[0].position.x(), x, 3e-6);
    EXPECT_NEAR(simulation.world.state().bodies[2].position.y(), -8.0 + x, 3e-6);
    EXPECT_NEAR(simulation.cable_reports()[1].links[1].wrap_angle, 0.5 * pi, 1e-8);
    EXPECT_NEAR(tension(simulation, 1, 0), 10.0 * mass, 10.0 * mass * 1e-8);
    EXPECT_TRUE(simulation.cables->events().empty());
  }
}

TEST(Equilibrium, NamesTheWheelThatARopeHasLeft) {
  // A rope from a block on rails, at first 1 m below, over a peg and over a sheave to 100 kg. A spring
  // draws the block up until the rope passes 0.5 m above the peg: there it rests as without a peg.
  const auto rest_height = [](bool with_peg) {
    const std::string peg =
        with_peg ? R"({"type": "rolling", "body": "peg", "winding": "clockwise"},)" : "";
    Simulation simulation = simulation_of(R"("bodies": [
      {"name": "peg", "mobility": "rotor", "mass": 1, "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
      {"name": "sheave", "mobility": "rotor", "mass": 1, "position": [2, 0, 0],
        "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
      {"name": "block", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-2, -1, 0]},
      {"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 100, "position": [2.2, -2, 0]}],
      "cables": [
      {"name": "rope", "links": [{"type": "attachment", "body": "block"}, )" +
                                          peg + R"(
        {"type": "rolling", "body": "sheave", "winding": "clockwise"},
        {"type": "attachment", "body": "weight"}]},
      {"name": "spring", "axial_stiffness": 200, "rest_lengths": [1], "links": [
        {"type": "attachment", "body": "block"},
        {"type": "attachment", "body": "world", "point": [-2, 4, 0]}]}])");
    const Equilibrium rest = find_equilibrium(simulation);
    EXPECT_TRUE(rest.converged) << rest.message;
    EXPECT_EQ(rest.events.size(), with_peg ? 1U : 0U);
    for (const CableEvent& event : rest.events) {
      EXPECT_EQ(event.kind, CableEvent::Kind::leave);
      EXPECT_EQ(event.body, "peg");
    }
    // It has not moved, so nothing has happened to the machine.
    EXPECT_TRUE(simulation.cables->events().empty());
    return simulation.world.state().bodies[2].position.y();
  };
  const double height = rest_height(true);
  EXPECT_GT(height, 1.0);
  EXPECT_NEAR(height, rest_height(false), 1e-8);
}

TEST(Equilibrium, RopesBreakAtRestAndNotDuringTheSearch) {
  // 100 kg on an elastic rope that is stretched by 4 m at first, 40 kN, rest at 1 kN. A rope that
  // bears 2 kN holds that, one that bears 900 N parts, and then nothing holds the load.
  const auto rest_of = [](double bears) {
    Simulation simulation = simulation_of(fmt::format(
        R"("bodies": [{{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 100, "position": [0, -14, 0]}}],
      "cables": [{{"name": "rope", "axial_stiffness": 1e5, "rest_lengths": [10], "breaking_tension": {},
        "links": [{{"type": "attachment", "body": "world"}}, {{"type": "attachment", "body": "load"}}]}}])",
        bears));
    return find_equilibrium(simulation);
  };
  const Equilibrium holds = rest_of(2000.0);
  EXPECT_TRUE(holds.converged) << holds.message;
  EXPECT_TRUE(holds.events.empty());
  const Equilibrium parts = rest_of(900.0);
  EXPECT_FALSE(parts.converged);
  ASSERT_EQ(parts.events.size(), 1U);
  EXPECT_EQ(parts.events[0].kind, CableEvent::Kind::cut);
}

TEST(Equilibrium, NothingHoldsAFreeBody) {
  Simulation simulation =
      simulation_of(R"("bodies": [{"name": "stone", "mass": 2, "inertia": [1, 1, 1]}])");
  EquilibriumSettings settings;
  settings.iterations = 30;
  const Equilibrium rest = find_equilibrium(simulation, settings);
  EXPECT_FALSE(rest.converged);
  EXPECT_NE(rest.message.find("stone"), std::string::npos) << rest.message;
}

}  // namespace
}  // namespace sheave
