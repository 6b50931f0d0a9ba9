// Natural frequencies of ropes of a material that pass wheels with inertia.
//
// A span of the unstretched length L with the strain e has T = EA e. Where its cable comes onto a
// wheel that turns by dx at its rim, dL = -dx / (1 + e), and l / L^2 = (1 + e) / L, so that
//   dT = EA (dl / L - l dL / L^2) = EA / L (dl + dx):
// a spring of EA / L, L unstretched, whatever e is. So closed forms below have no strain in them but
// by L = l / (1 + e). Lengths are multiples of the cable's quantum, below 1e-15 of them, and
// everything else is rounding of matrices: 1e-10.

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

constexpr double rounding = 1e-10;
constexpr std::array strains{1e-4, 1e-3, 0.01, 0.03, 0.1};

/// Squares of frequencies of inertias in a row with springs between them, ascending [1/s2].
std::vector<double> row_of(const std::vector<double>& inertias,
                           const std::vector<double>& springs) {
  const auto n = static_cast<Eigen::Index>(inertias.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    matrix(i, i) += springs[at] / inertias[at];
    matrix(i + 1, i + 1) += springs[at] / inertias[at + 1];
    matrix(i, i + 1) = matrix(i + 1, i) = -springs[at] / std::sqrt(inertias[at] * inertias[at + 1]);
  }
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  return {values.begin(), values.end()};
}

void expect_squares(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], rounding * expected.back()) << i;
  }
}

/// Those of the modes, and the eigenvalues that statics tells of the same pose.
void expect_everywhere(Simulation& simulation, const std::vector<double>& expected) {
  const Modes modes = find_modes(simulation);
  EXPECT_LT(modes.imbalance, 1e-12);
  std::vector<double> found;
  for (const Mode& mode : modes.modes) found.push_back(mode.eigenvalue);
  expect_squares(found, expected);
  const Equilibrium rest = find_equilibrium(simulation);
  EXPECT_TRUE(rest.converged) << rest.message;
  expect_squares(rest.eigenvalues, expected);
}

/// Two weights of 2 kg on a rope of EA = 20 / strain over a wheel of I = 0.05 kg m2, r = 0.2 m.
Simulation heavy_atwood(double strain, double left, double right, const std::string& step = "") {
  return simulation_of(fmt::format(
      R"({}"bodies": [
    {{"name": "wheel", "mobility": "rotor", "mass": 1, "spin_inertia": 0.05,
      "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}},
    {{"name": "a", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [-0.2, {}, 0]}},
    {{"name": "b", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.2, {}, 0]}}],
    "cables": [{{"name": "rope", "axial_stiffness": {}, "rest_lengths": [{}, {}], "links": [
      {{"type": "attachment", "body": "a"}}, {{"type": "rolling", "body": "wheel", "winding": "clockwise"}},
      {{"type": "attachment", "body": "b"}}]}}])",
      step, -left, -right, 20.0 / strain, left / (1.0 + strain), right / (1.0 + strain)));
}

TEST(ModesOfMaterial, HeavyWheelBetweenTwoWeights) {
  for (const double strain : strains) {
    SCOPED_TRACE(strain);
    Simulation simulation = heavy_atwood(strain, 1.0, 2.5);
    const double stiffness = 20.0 / strain * (1.0 + strain);
    expect_everywhere(simulation,
                      row_of({2.0, 0.05 / 0.04, 2.0}, {stiffness / 1.0, stiffness / 2.5}));
  }
}

/// The angular frequency with which the machine moves along its third mode at an amplitude of 1e-3 of
/// the rope's stretch, once it has swung there and back. q = c + a cos(w t) at the ends of frames of
/// dt has q(t + dt) - 2 q(t) + q(t - dt) = (2 cos(w dt) - 2) (q(t) - c): the slope of a straight line.
double measured_rate(Simulation& simulation, const Modes& modes, double strain) {
  const Eigen::VectorXd& shape = modes.modes[2].shape;
  const Eigen::VectorXd momentum =
      Eigen::Vector3d(0.05, 2.0, 2.0).cwiseProduct(Eigen::Vector3d(shape));  // mass x shape
  const State start = simulation.world.state();
  const State displaced = displaced_state(simulation, modes, shape, 1e-3 * strain);
  EXPECT_TRUE(simulation.world.restore(displaced).empty());
  std::vector<double> way;
  for (int i = 0; i < 90; ++i) {
    EXPECT_TRUE(simulation.step().ok());
    const State& now = simulation.world.state();
    const Eigen::Vector3d q(now.bodies[0].angle - start.bodies[0].angle,
                            now.bodies[1].position.y() - start.bodies[1].position.y(),
                            now.bodies[2].position.y() - start.bodies[2].position.y());
    if (i >= 30) way.push_back(momentum.dot(q));
  }
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const double bend = way[i + 1] - 2.0 * way[i] + way[i - 1];
    n += 1.0;
    x += way[i];
    y += bend;
    xx += way[i] * way[i];
    xy += way[i] * bend;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return std::acos(1.0 + 0.5 * slope) * 60.0;
}

TEST(ModesOfMaterial, AgreesWithTheFrequencyOfTheMotion) {
  // `rattle` treats springs by the midpoint rule, which swings with 2 / h atan(w h / 2): by
  // (w h)^2 / 12 slower, 1.2e-4 with w = 145 / s and h = 1/3840 s. The amplitude makes L, and so k,
  // different by 1e-3 of the strain, which cancels in the mean. As scenes begin, the cable lies
  // unstretched on the wheel: that comes off once, in the first swing.
  for (const double strain : {0.002, 0.01962, 0.05}) {
    SCOPED_TRACE(strain);
    Simulation simulation = heavy_atwood(strain, 1.0, 1.0,
                                         R"("step": {"dt": 0.016666666666666666,
      "substeps": 64, "solver": "direct", "integrator": "rattle"}, )");
    const Modes modes = find_modes(simulation);
    ASSERT_EQ(modes.modes.size(), 3U);
    const double rate = std::sqrt(modes.modes[2].eigenvalue);
    constexpr double h = 1.0 / 3840.0;
    const double stepped = 2.0 / h * std::atan(0.5 * rate * h);
    // Before, the difference was 0.3 of the strain.
    EXPECT_NEAR(measured_rate(simulation, modes, strain), stepped, rate * 1e-3 * strain);
  }
}

TEST(ModesOfMaterial, SeveralHeavyWheelsInARow) {
  // Over a wheel at the left, below one in the middle and over one at the right: the spans between
  // them are inner tangents, of sqrt(d^2 - (r1 + r2)^2).
  constexpr double pull = 20.0;
  const double between = std::sqrt(1.0 + 1.5 * 1.5 - 0.5 * 0.5);
  for (const double strain : strains) {
    SCOPED_TRACE(strain);
    const std::array lengths{2.0, between, between, 3.0};
    std::string rest_lengths;
    std::vector<double> springs;
    for (const double length : lengths) {
      const double unstretched = length / (1.0 + strain);
      rest_lengths += fmt::format("{}{}", rest_lengths.empty() ? "" : ", ", unstretched);
      springs.push_back(pull / strain / unstretched);
    }
    const std::string text = fmt::format(
        R"("bodies": [
      {{"name": "a", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [-0.2, -2, 0]}},
      {{"name": "one", "mobility": "rotor", "mass": 1, "spin_inertia": 0.03,
        "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}},
      {{"name": "two", "mobility": "rotor", "mass": 1, "spin_inertia": 0.2, "position": [1, -1.5, 0],
        "shape": {{"type": "cylinder", "radius": 0.3, "length": 0.1}}}},
      {{"name": "three", "mobility": "rotor", "mass": 1, "spin_inertia": 0.01, "position": [2, 0, 0],
        "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}},
      {{"name": "b", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [2.2, -3, 0]}}],
      "cables": [{{"name": "rope", "axial_stiffness": {}, "rest_lengths": [{}], "links": [
        {{"type": "attachment", "body": "a"}}, {{"type": "rolling", "body": "one", "winding": "clockwise"}},
        {{"type": "rolling", "body": "two", "winding": "counter-clockwise"}},
        {{"type": "rolling", "body": "three", "winding": "clockwise"}},
        {{"type": "attachment", "body": "b"}}]}}])",
        pull / strain, rest_lengths);
    Simulation simulation = simulation_of(text);
    expect_everywhere(simulation,
                      row_of({2.0, 0.03 / 0.04, 0.2 / 0.09, 0.01 / 0.04, 2.0}, springs));
  }
}

TEST(ModesOfMaterial, DrumWithInertiaBetweenTwoRopes) {
  // The ropes are wound onto the drum in opposite senses, one of them from its other end; with what
  // strain the rest of them lies there is no matter.
  for (const double strain : strains) {
    SCOPED_TRACE(strain);
    const double left = 1.5 / (1.0 + strain);
    const double right = 0.7 / (1.0 + strain);
    const std::string text = fmt::format(
        R"("bodies": [
      {{"name": "drum", "mobility": "rotor", "mass": 1, "spin_inertia": 0.08,
        "shape": {{"type": "cylinder", "radius": 0.25, "length": 0.1}}}},
      {{"name": "a", "mobility": "slider", "axis": [0, 1, 0], "mass": 3, "position": [-0.25, -1.5, 0]}},
      {{"name": "b", "mobility": "slider", "axis": [0, 1, 0], "mass": 3, "position": [0.25, -0.7, 0]}}],
      "cables": [
      {{"name": "left", "axial_stiffness": {}, "rest_lengths": [{}], "links": [
        {{"type": "attachment", "body": "a"}},
        {{"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 4}}]}},
      {{"name": "right", "axial_stiffness": {}, "rest_lengths": [{}], "links": [
        {{"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 4}},
        {{"type": "attachment", "body": "b"}}]}}])",
        30.0 / strain, left, 30.0 / strain, right);
    Simulation simulation = simulation_of(text);
    expect_everywhere(simulation, row_of({3.0, 0.08 / 0.0625, 3.0},
                                         {30.0 / strain / left, 30.0 / strain / right}));
  }
}

TEST(ModesOfMaterial, WheelThatHangsInItsRope) {
  // A free wheel of M and I in the bight of a rope whose ends are above its edges, at l = 2 m: it
  // swings with g / l as nothing turns it then, sinks against both spans, 2 k / M, and turns against
  // them, 2 k r^2 / I.
  for (const double strain : strains) {
    SCOPED_TRACE(strain);
    const double unstretched = 2.0 / (1.0 + strain);
    const double pull = 20.0;
    Simulation simulation = simulation_of(fmt::format(
        R"("bodies": [{{"name": "wheel", "mobility": "planar", "axis": [0, 0, 1], "mass": 4,
      "inertia": [1, 1, 0.03], "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}}}}],
      "cables": [{{"name": "rope", "axial_stiffness": {}, "rest_lengths": [{}, {}], "links": [
        {{"type": "attachment", "body": "world", "point": [-0.2, 2, 0]}},
        {{"type": "rolling", "body": "wheel", "winding": "counter-clockwise"}},
        {{"type": "attachment", "body": "world", "point": [0.2, 2, 0]}}]}}])",
        pull / strain, unstretched, unstretched));
    const double spring = pull / strain / unstretched;
    expect_everywhere(simulation, {10.0 / 2.0, 2.0 * spring / 4.0, 2.0 * spring * 0.04 / 0.03});
  }
}

TEST(ModesOfMaterial, DriveWindsARopeOfAMaterial) {
  // A weight of 2 kg on a winch of 0.2 m: the drive's angle u makes k r u / m of the acceleration,
  // k = EA / L.
  for (const double strain : strains) {
    const double unstretched = 2.0 / (1.0 + strain);
    Simulation simulation = simulation_of(fmt::format(
        R"("bodies": [
      {{"name": "drum", "mobility": "rotor", "mass": 1, "shape": {{"type": "cylinder", "radius": 0.2, "length": 0.1}},
       "drive": "speed", "drive_values": [0]}},
      {{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.2, -2, 0]}}],
      "cables": [{{"name": "rope", "axial_stiffness": {}, "rest_lengths": [{}], "links": [
        {{"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 3}},
        {{"type": "attachment", "body": "load"}}]}}])",
        20.0 / strain, unstretched));
    ModeInput input;
    input.kind = ModeInput::Kind::drive;
    const Modes modes = find_modes(simulation, {input});
    ASSERT_EQ(modes.state_matrix.rows(), 3);
    const double spring = 20.0 / strain / unstretched;
    const double found = std::abs(modes.motions(0, 0) * modes.state_matrix(1, 2));
    EXPECT_NEAR(found, spring * 0.2 / 2.0, rounding * spring) << strain;
  }
}

TEST(ModesOfACrane, PendulumsOfAllSizesAreExact) {
  // Bobs on strings of 0.01 m to 100 m side by side: w^2 = g / l. Differences with one step for all
  // of them would be off by (step / l)^4 for the shortest, which is 1 with 1e-4 of a size of 100 m.
  std::string bodies;
  std::string cables;
  std::vector<double> expected;
  for (const double length : {100.0, 1.0, 0.01}) {
    const std::size_t number = expected.size();
    const std::string comma = bodies.empty() ? "" : ", ";
    bodies += fmt::format(
        R"({}{{"name": "b{}", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [1, 1, 1], "position": [0, {}, 0]}})",
        comma, number, -length);
    cables += fmt::format(
        R"({}{{"name": "c{}", "links": [{{"type": "attachment", "body": "world"}}, {{"type": "attachment", "body": "b{}"}}]}})",
        comma, number, number);
    expected.push_back(10.0 / length);
  }
  Simulation simulation =
      simulation_of("\"bodies\": [" + bodies + "], \"cables\": [" + cables + "]");
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.modes.size(), 6U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(modes.modes[3 + i].eigenvalue, expected[i], 1e-6 * expected[i]);
  }
}

}  // namespace
}  // namespace sheave
