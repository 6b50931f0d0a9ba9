// Ropes with weight that lie on a floor, at rest, and small vibrations on them.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A rope of L = 75 m from an anchor on the floor to a buoy that is pulled by H and V. The part V / w
/// hangs, so the buoy is at
///   x = L - V / w + H / w asinh(V / H) + H L / EA,
///   z = (sqrt(H^2 + V^2) - H) / w + V^2 / 2 EA w.
struct Mooring {
  double h = 2000.0;
  double v = 3000.0;
  double w = 100.0;
  double length = 75.0;
  double stiffness = 1e6;

  [[nodiscard]] double tension() const { return std::hypot(h, v); }
  [[nodiscard]] double x() const {
    return length - v / w + h / w * std::asinh(v / h) + h * length / stiffness;
  }
  [[nodiscard]] double z() const { return (tension() - h) / w + 0.5 * v * v / (stiffness * w); }
  /// The flexibility d(x, z) / d(H, V).
  [[nodiscard]] Eigen::Matrix2d flexibility() const {
    Eigen::Matrix2d f;
    const double mixed = (h / tension() - 1.0) / w;
    f << (std::asinh(v / h) - v / tension()) / w + length / stiffness, mixed, mixed,
        v / w * (1.0 / tension() + 1.0 / stiffness);
    return f;
  }
  /// The scene begins beside the place of rest.
  [[nodiscard]] std::string scene(double x_off, double z_off, bool reversed = false) const {
    const std::string anchor = R"({"type": "attachment", "body": "world", "point": [0, 3, 0]})";
    const std::string buoy = R"({"type": "attachment", "body": "buoy"})";
    return fmt::format(
        R"("bodies": [{{"name": "buoy", "mobility": "free", "position": [{}, {}, 0], "mass": 50,
            "shape": {{"type": "sphere", "radius": 0.1}}, "force": [{}, {}, 0]}}],
        "cables": [{{"name": "rope", "linear_density": {}, "axial_stiffness": {}, "floor": 3,
          "rest_lengths": [{}], "links": [{}, {}]}}])",
        x() + x_off, z() + 3.0 + z_off, h, v + 500.0, w / 10.0, stiffness, length,
        reversed ? buoy : anchor, reversed ? anchor : buoy);
  }
};

TEST(FloorRopeAtRest, HasThePublishedForces) {
  // The numbers are those of a converged solution to 3e-7.
  const Simulation s = simulation_of(
      R"("cables": [{"name": "rope", "linear_density": 80, "axial_stiffness": 7.51e12, "floor": 0, "rest_lengths": [500],
        "links": [{"type": "attachment", "body": "world"},
                  {"type": "attachment", "body": "world", "point": [400, 200, 0]}]}])");
  const SpanReport span = s.cable_reports()[0].spans[0];
  EXPECT_NEAR(span.start_force.x(), 96643.428, 96643.428e-6);
  EXPECT_EQ(span.start_force.y(), 0.0);
  EXPECT_NEAR(-span.end_force.y(), 237751.755, 237751.755e-6);
  EXPECT_NEAR(span.floored, 202.810306, 202.810306e-6);
}

TEST(FloorRopeAtRest, HoldsABuoyAtThePlaceOfItsForces) {
  for (const Mooring& mooring : {Mooring{}, Mooring{100.0, 3000.0}, Mooring{8000.0, 1500.0},
                                 Mooring{2000.0, 3000.0, 100.0, 75.0, 2e4}}) {
    for (const bool reversed : {false, true}) {
      Simulation s = simulation_of(mooring.scene(0.5, -0.7, reversed));
      const Equilibrium rest = find_equilibrium(s);
      ASSERT_TRUE(rest.converged) << rest.message;
      EXPECT_NE(rest.stability, Stability::unstable);  // the buoy turns freely
      // The search ends at residuals of 1e-11 of the forces; the softest direction is out of the
      // plane, H / x.
      EXPECT_NEAR(s.world.position({0}).x(), mooring.x(), 1e-6);
      EXPECT_NEAR(s.world.position({0}).y(), mooring.z() + 3.0, 1e-6);
      const SpanReport span = s.cable_reports()[0].spans[0];
      EXPECT_NEAR(span.floored, mooring.length - mooring.v / mooring.w, 1e-6);
    }
  }
}

TEST(FloorRopeAtRest, SupportsAndFloorBearTheRope) {
  const Mooring mooring;
  Simulation s = simulation_of(mooring.scene(0.1, 0.1));
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<SupportReaction> supports = support_reactions(s, rest.forces);
  ASSERT_EQ(supports.size(), 1U);
  // The world bears the rest of the rope, and draws with H.
  const Vector3 expected(-mooring.h, mooring.w * mooring.length - mooring.v, 0.0);
  EXPECT_LE((supports[0].force - expected).norm(), 1e-8 * expected.norm());
}

TEST(FloorRopeAtRest, ABuoyVibratesOnItsFlexibility) {
  for (const Mooring& mooring :
       {Mooring{}, Mooring{500.0, 3000.0}, Mooring{8000.0, 1500.0, 100.0, 75.0, 1e5}}) {
    Simulation s = simulation_of(mooring.scene(0.01, 0.01));
    ASSERT_TRUE(find_equilibrium(s).converged);
    const Modes modes = find_modes(s);
    const Eigen::Matrix2d stiffness = mooring.flexibility().inverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> own(stiffness / 50.0);
    const std::array<double, 3> expected{own.eigenvalues()[0], own.eigenvalues()[1],
                                         mooring.h / mooring.x() / 50.0};
    for (const double square : expected) {
      bool found = false;
      for (const Mode& mode : modes.modes) {
        found = found || std::abs(mode.eigenvalue - square) < 1e-6 * square;
      }
      EXPECT_TRUE(found) << square;
    }
  }
}

TEST(FloorRopeAtRest, BehindAnEyeHasTheTensionOfItsLoad) {
  // A rope of 28 m from an anchor on the floor, 20 m away, through an eye at the height 8 m to a load of
  // 100 kg. The part of the length l below the eye has T = m g + w l there, and the other one the same;
  // its T gives H, the part that hangs and the width, and the sum of the lengths gives l.
  const double w = 100.0;
  const double e = 1e-6;
  const auto tension = [&](double below) { return 1000.0 + w * below; };
  const auto level = [&](double below) {
    const double t = tension(below);
    const double q = t * (1.0 + 0.5 * e * t) - w * 8.0;
    return 2.0 * q / (1.0 + std::sqrt(1.0 + 2.0 * e * q));
  };
  const auto hung = [&](double below) {
    return std::sqrt(std::pow(tension(below), 2) - std::pow(level(below), 2)) / w;
  };
  const auto whole = [&](double below) {
    const double h = level(below);
    const double s = hung(below);
    const double width = h / w * std::asinh(w * s / h) + e * h * s;
    return s + (20.0 - width) / (1.0 + e * h) + below;
  };
  double low = 0.0;
  double high = 8.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (whole(middle) > 28.0 ? high : low) = middle;
  }
  const double stretch = e * low * (1000.0 + 0.5 * w * low);
  const std::string anchor = R"({"type": "attachment", "body": "world"})";
  const std::string eye = R"({"type": "pinhole", "body": "world", "point": [20, 8, 0]})";
  const std::string load = R"({"type": "attachment", "body": "load"})";
  for (const bool reversed : {false, true}) {
    Simulation s = simulation_of(fmt::format(
        R"("bodies": [{{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "position": [20, 4, 0], "mass": 100}}],
        "cables": [{{"name": "rope", "linear_density": 10, "axial_stiffness": 1e6, "floor": 0, "rest_lengths": [{}],
          "links": [{}, {}, {}]}}])",
        reversed ? "4, 24" : "24, 4", reversed ? load : anchor, eye, reversed ? anchor : load));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    EXPECT_NEAR(s.world.position({0}).y(), 8.0 - low - stretch, 1e-8);
    const SpanReport span = s.cable_reports()[0].spans[reversed ? 1 : 0];
    EXPECT_NEAR(span.floored, 28.0 - low - hung(low), 1e-7);
    EXPECT_NEAR(std::abs(span.start_force.x()), level(low), 1e-6 * level(low));
  }
}

/// Place of a buoy on a chain of `count` pieces with weights between them, which rest on the ground.
Vector3 place_on_beads(const Mooring& mooring, int count) {
  const double piece = mooring.length / count;
  const double mass = mooring.w / 10.0 * piece;
  std::string bodies;
  std::string links = R"({"type": "attachment", "body": "world"})";
  std::string lengths;
  for (int i = 1; i <= count; ++i) {
    const double s = i * piece;
    const double lifted = std::max(s - (mooring.length - mooring.v / mooring.w), 0.0);
    const double x = s - 0.4 * lifted;
    const bool last = i == count;
    bodies += fmt::format(
        R"({}{{"name": "b{}", "mobility": "planar", "axis": [0, 0, 1], "position": [{}, {}, 0], "mass": {},
          "shape": {{"type": "sphere", "radius": 0.05}}, "force": [{}, {}, 0]}})",
        i > 1 ? "," : "", i, x, 0.6 * lifted, last ? 50.0 + 0.5 * mass : mass,
        last ? mooring.h : 0.0, last ? mooring.v + 500.0 : 0.0);
    links += fmt::format(R"(, {{"type": "attachment", "body": "b{}"}})", i);
    lengths += fmt::format("{}{}", i > 1 ? "," : "", piece);
  }
  Simulation s = simulation_of(fmt::format(
      R"("ground": {{"point": [0, -0.05, 0]}}, "bodies": [{}], "cables": [{{"name": "line", "axial_stiffness": {}, "rest_lengths": [{}], "links": [{}]}}])",
      bodies, mooring.stiffness, lengths, links));
  const Equilibrium rest = find_equilibrium(s);
  EXPECT_TRUE(rest.converged) << rest.message;
  return s.world.position({count - 1});
}

TEST(FloorRopeAtRest, IsTheLimitOfAChainOfWeightsOnTheGround) {
  const Mooring mooring;
  std::vector<double> off;
  for (const int count : {15, 30, 60}) {
    const Vector3 place = place_on_beads(mooring, count);
    off.push_back((place - Vector3(mooring.x(), mooring.z(), 0.0)).norm());
  }
  // Lumped weights are of second order; the place of the last bead on the ground within its piece
  // changes the factor.
  EXPECT_LT(off[0], 0.2);
  EXPECT_LT(off[1], 0.4 * off[0]);
  EXPECT_LT(off[2], 0.4 * off[1]);
}

}  // namespace
}  // namespace sheave
