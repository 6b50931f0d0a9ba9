// The poses through which a search for equilibrium passes leave nothing behind, and a search
// without a result tells why.

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A Spanish burton whose masses are `size` times those of tests/outside/spanish-burton.json: the
/// effort of 12 kg hangs by the fall, which goes over pulley B of 0.3 m on a hook, and the runner
/// over pulley A joins load and hook. All ropes are vertical at first.
std::string burton(double size, const std::string& elastic, bool from_load) {
  const std::string load = R"({"type": "attachment", "body": "load", "point": [-0.3, 0, 0]})";
  const std::string effort = R"({"type": "attachment", "body": "effort"})";
  const std::string wheel = fmt::format(R"({{"type": "rolling", "body": "B", "winding": "{}"}})",
                                        from_load ? "counter-clockwise" : "clockwise");
  const auto mass = [size](double kilograms) {
    return fmt::format("\"mass\": {}", size * kilograms);
  };
  const std::string disk = R"("shape": {"type": "cylinder", "radius": 0.3, "length": 0.1}, )";
  return R"("bodies": [
    {"name": "A", "mobility": "rotor", "position": [0, 3, 0], )" +
         disk + mass(2) + R"(},
    {"name": "hook", "mobility": "slider", "axis": [0, 1, 0], "position": [-0.3, 1, 0], )" +
         mass(1) + R"(},
    {"name": "B", "mobility": "rotor", "mount": "hook", "position": [-0.3, 1, 0], )" +
         disk + mass(1) + R"(},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "position": [0.3, -2, 0], )" +
         mass(30) + R"(},
    {"name": "effort", "mobility": "slider", "axis": [0, 1, 0], "position": [-0.6, -1, 0], )" +
         mass(12) + R"(}],
    "cables": [{"name": "runner", )" +
         elastic + R"("links": [
      {"type": "attachment", "body": "load"},
      {"type": "rolling", "body": "A", "winding": "counter-clockwise"},
      {"type": "attachment", "body": "hook"}]},
    {"name": "fall", )" +
         elastic + R"("links": [)" + (from_load ? load : effort) + ", " + wheel + ", " +
         (from_load ? effort : load) + "]}]";
}

// The load rises beside pulley B until its rope leans: T = 12 g, and of the load (30 kg) and the
// hook with pulley (2 kg)
//   R + T u = 30 g,  R = T + T u + 2 g  =>  u = (30 - 12 - 2) / 24 = 2/3,
// the cosine of the angle 2 a between the rope and the vertical. With e = 0.3 tan a of rope, and a
// wrap that is smaller by 2 a, the other part of the fall has the length 5 - e + 0.6 a. (Before, it
// was 77 mm shorter, and 81 mm had slid over B.)
TEST(StaticsSearch, SlidesNoCableOverAWheelThatItPasses) {
  const double a = std::atan(std::sqrt(0.2));
  const double long_part = 5.0 - 0.3 * std::tan(a) + 0.6 * a;
  for (const double size : {1.0, 1e6}) {
    for (const bool from_load : {true, false}) {
      SCOPED_TRACE(fmt::format("{} {}", size, from_load));
      Simulation simulation = simulation_of(burton(size, "", from_load));
      const Equilibrium rest = find_equilibrium(simulation);
      ASSERT_TRUE(rest.converged) << rest.message;
      EXPECT_TRUE(rest.events.empty());
      const CableReport fall = simulation.cable_reports()[1];
      EXPECT_EQ(fall.links[1].slip, 0.0);
      const std::size_t at_load = from_load ? 0 : 1;
      // 1e-11 of forces of 300 N and of a size of 7 m; the angle has an arm of 0.13 m.
      EXPECT_NEAR(fall.spans[at_load].length, 0.3 * std::tan(a), 1e-8);
      EXPECT_NEAR(fall.spans[1 - at_load].length, long_part, 1e-8);
      EXPECT_NEAR(fall.spans[at_load].tension, 120.0 * size, 1e-8 * size);
      ASSERT_TRUE(simulation.step().ok());
      EXPECT_TRUE(simulation.certificate()->clean());
    }
  }
}

// An elastic rope of constant compliance passes the same poses; 1e-7 m/N stretches each part by
// 12 um under 120 N.
TEST(StaticsSearch, SlidesNoElasticCableEither) {
  Simulation simulation = simulation_of(burton(1.0, R"("compliance": 1e-7, )", true));
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const CableReport fall = simulation.cable_reports()[1];
  EXPECT_EQ(fall.links[1].slip, 0.0);
  EXPECT_NEAR(fall.spans[0].length, 0.3 * std::sqrt(0.2), 1e-4);
  ASSERT_TRUE(simulation.step().ok());
  EXPECT_TRUE(simulation.certificate()->clean());
}

/// 10 kg and `light` over a post of 0.1 m, or a massless wheel, with this setting.
std::string over(const std::string& setting, double light) {
  const bool wheel = setting.find("efficiency") != std::string::npos;
  return R"("bodies": [
    {"name": "post", "shape": {"type": "cylinder", "radius": 0.1, "length": 0.1}, )" +
         std::string(wheel ? R"("mobility": "rotor", "mass": 1, "spin_inertia": 0)"
                           : R"("mobility": "static")") +
         R"(},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [-0.1, -2, 0]},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "position": [0.1, -2, 0], "mass": )" +
         fmt::format("{}", light) + R"(}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "heavy"},
      {"type": "rolling", "body": "post", "winding": "clockwise", )" +
         setting + R"(}, {"type": "attachment", "body": "light"}]}])";
}

TEST(StaticsSearch, NamesTheLinkOverWhichARopeSlides) {
  // e^(0.2 pi) = 1.874 of 10 kg are 5.335 kg; 6 kg are held.
  Simulation held = simulation_of(over("\"friction\": 0.2", 6.0));
  EXPECT_TRUE(find_equilibrium(held).converged);
  EquilibriumSettings few;
  few.iterations = 3;  // later the light load rises beside the post, where its rope leans
  Simulation slides = simulation_of(over("\"friction\": 0.2", 5.0));
  const Equilibrium none = find_equilibrium(slides, few);
  EXPECT_FALSE(none.converged);
  EXPECT_NE(
      none.message.find("cable \"rope\" slides over link 1 on \"post\", where the tension of "
                        "span 0 is 1.874 times that of span 1, all that friction 0.2 holds at "
                        "180 degrees; more friction"),
      std::string::npos)
      << none.message;
  Simulation turns = simulation_of(over("\"efficiency\": 0.8", 5.0));
  const Equilibrium lossy = find_equilibrium(turns, few);
  EXPECT_FALSE(lossy.converged);
  EXPECT_NE(lossy.message.find("is 1.25 times that of span 1, all that efficiency 0.8 holds"),
            std::string::npos)
      << lossy.message;
}

/// Depth [m] to which `heavy` kg sink against 100 kg, 20 m below a wheel with inertia and losses.
double sunk(double heavy, bool with_weight) {
  Simulation s = simulation_of(
      R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 5, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 100, "position": [-0.5, -20, 0]},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "position": [0.5, -20, 0], "mass": )" +
      fmt::format("{}", heavy) + R"(}],
    "cables": [{"name": "rope", "axial_stiffness": 1e9, )" +
      (with_weight ? R"("linear_density": 1, "pretension": 1100, )" : "") +
      R"("links": [{"type": "attachment", "body": "light"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise", "efficiency": 0.9}, {"type": "attachment", "body": "heavy"}]}])");
  const Equilibrium rest = find_equilibrium(s);
  return rest.converged ? -20.0 - s.world.position({2}).y() : 1e9;
}

TEST(StaticsSearch, ABearingHoldsByTheTensionsOnBothSides) {
  // m2 - m1 <= c (m1 + m2) with c = 1 / 19: up to 111.1 kg; with 20 kg of rope on either side up to
  // 113.3 kg. The ropes stretch by 100 N x 20 m / EA = 2e-6 m.
  for (const double heavy : {100.0, 106.0, 111.0})
    EXPECT_NEAR(sunk(heavy, false), 0.0, 1e-4) << heavy;
  EXPECT_GT(sunk(111.5, false), 1.0);
  for (const double heavy : {100.0, 111.5, 113.2})
    EXPECT_NEAR(sunk(heavy, true), 0.0, 1e-4) << heavy;
  EXPECT_GT(sunk(113.5, true), 1.0);
}

TEST(StaticsSearch, ASmoothPostIsNotBlamed) {
  EquilibriumSettings few;
  few.iterations = 3;  // later the light load rises beside the post, where its rope leans
  Simulation slides = simulation_of(over("\"friction\": 0", 5.0));
  const Equilibrium none = find_equilibrium(slides, few);
  EXPECT_FALSE(none.converged);
  EXPECT_EQ(none.message.find("slides over"), std::string::npos) << none.message;
  EXPECT_NE(none.message.find("either nothing holds it"), std::string::npos) << none.message;
}

}  // namespace
}  // namespace sheave
