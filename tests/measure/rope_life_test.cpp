// Bends along a rope against its geometry, and damages against sums by hand.

#include "measure/rope_life.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "measure/rope_history.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::measure {
namespace {

/// A hoist over three sheaves, the middle one against the others: up by 1.5 m, down by as much.
struct Hoist {
  std::string step = R"("dt": 0.02, "substeps": 4, "solver": "direct", "integrator": "rattle")";
  bool mirrored = false;
  bool from_the_load = false;  // the cable is counted from the load
  std::string material{};      // settings of the cable
};

std::string hoist_scene(const Hoist& hoist) {
  const std::string side = hoist.mirrored ? "" : "-";
  const std::string other = hoist.mirrored ? "-" : "";
  // Seen along the rope from its other end, or in a mirror, windings have the other sense.
  const bool flipped = hoist.mirrored != hoist.from_the_load;
  const std::string over = flipped ? "counter-clockwise" : "clockwise";
  const std::string under = flipped ? "clockwise" : "counter-clockwise";
  const std::string fast = hoist.mirrored ? "-4" : "4";
  const std::string back = hoist.mirrored ? "4" : "-4";
  const auto rotor = [](const std::string& name, const std::string& x, double y, double radius,
                        const std::string& more) {
    return R"({"name": ")" + name + R"(", "mobility": "rotor", "mass": 1, "position": [)" + x +
           ", " + std::to_string(y) + R"(, 0], "shape": {"type": "cylinder", "radius": )" +
           std::to_string(radius) + R"(, "length": 0.1})" + more + "},\n";
  };
  std::array<std::string, 5> links{
      R"({"type": "spool", "body": "drum", "stored_length": 2, "winding": ")" + over + "\"}",
      R"({"type": "rolling", "body": "first", "winding": ")" + over + "\"}",
      R"({"type": "rolling", "body": "low", "winding": ")" + under + "\"}",
      R"({"type": "rolling", "body": "last", "winding": ")" + over + "\"}",
      R"({"type": "attachment", "body": "load", "point": [0, 0.2, 0]})"};
  if (hoist.from_the_load) std::reverse(links.begin(), links.end());
  std::string list;
  for (const std::string& link : links) list += (list.empty() ? "" : ",\n") + link;
  return R"({"format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 5, "step": {)" +
         hoist.step + "}, \"bodies\": [\n" +
         rotor(
             "drum", side + "1", -3, 0.25,
             R"(, "drive": "speed", "drive_times": [0, 0.5, 1.5, 2, 3, 3.5, 4.5, 5], "drive_values": [0, )" +
                 fast + ", " + fast + ", 0, 0, " + back + ", " + back + ", 0]") +
         rotor("first", side + "1", 0, 0.25, "") + rotor("low", "0", -0.5, 0.2, "") +
         rotor("last", other + "1", 0, 0.25, "") +
         R"({"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2000, "position": [)" +
         other + R"(1.25, -3, 0]}], "cables": [{"name": "rope", )" + hoist.material +
         R"("links": [)" + list + "]}]}";
}

struct HoistRun {
  CableHistory rope;
  CableReport start;    // before the first step
  double travel = 0.0;  // largest length that the drum took [m]
  double error = 0.0;   // of the stored length at the end [m]
};

HoistRun run_hoist(const Hoist& hoist, int sections, std::optional<RopeLife> life = {}) {
  HoistRun run;
  const SceneResult scene = load_scene_text(hoist_scene(hoist), "test");
  if (!scene) {
    ADD_FAILURE() << to_string(scene.errors[0]);
    return run;
  }
  Result<Simulation> made = create_simulation(*scene);
  if (!made) {
    ADD_FAILURE() << made.errors()[0].message;
    return run;
  }
  RopeHistory history(sections, std::move(life));
  history.observe(*made);
  run.start = made->cable_reports()[0];
  const std::size_t drum = hoist.from_the_load ? 4 : 0;
  const auto stored = [&] { return made->cable_reports()[0].links[drum].stored_length; };
  const double before = stored();
  const int steps = static_cast<int>(std::lround(5.0 / scene->model.step.dt));
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(made->step().ok());
    history.observe(*made);
    run.travel = std::max(run.travel, stored() - before);
  }
  run.error = std::abs(stored() - before);
  run.rope = history.history()[0];
  return run;
}

/// Where the rope on a link begins and ends at the start, from the cable's first end.
struct OnLink {
  double begin = 0.0;
  double end = 0.0;
  int sense = 0;
};

std::vector<OnLink> links_at_start(const CableReport& report) {
  std::vector<OnLink> links;
  double length = 0.0;
  for (std::size_t k = 0; k < report.links.size(); ++k) {
    const double stored = report.links[k].stored_length;
    links.push_back({length, length + stored, report.links[k].winding});
    length += stored + (k < report.spans.size() ? report.spans[k].rest_length : 0.0);
  }
  // Nothing comes onto a drum from its end of the rope.
  links.front().begin = -1e9;
  return links;
}

struct BendCount {
  int bends = 0;
  int reverse = 0;
  [[nodiscard]] bool operator==(const BendCount&) const = default;
  friend std::ostream& operator<<(std::ostream& out, const BendCount& count) {
    return out << count.bends << " bends, " << count.reverse << " reverse";
  }
};

/// The bends of the point at `u` per link, by geometry: the point moves by `travel` towards the
/// first link and back, past the links, which stand. The first bend follows the last one.
std::vector<BendCount> bends_by_geometry(const std::vector<OnLink>& links, double u,
                                         double travel) {
  const double least = u - travel;
  std::vector<std::size_t> sequence;
  for (std::size_t k = links.size(); k-- > 0;) {
    if (links[k].sense != 0 && u > links[k].end && least < links[k].end) sequence.push_back(k);
  }
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (links[k].sense != 0 && least < links[k].begin && u > links[k].begin) sequence.push_back(k);
  }
  std::vector<BendCount> counts(links.size());
  int before = sequence.empty() ? 0 : links[sequence.back()].sense;
  // A point that lies on a link at the start is bent already.
  for (const OnLink& link : links) {
    if (u >= link.begin && u <= link.end && link.sense != 0) before = link.sense;
  }
  for (const std::size_t k : sequence) {
    ++counts[k].bends;
    if (links[k].sense != before) ++counts[k].reverse;
    before = links[k].sense;
  }
  return counts;
}

BendCount counted(const SectionHistory& section, int link) {
  for (const SectionBends& one : section.bends) {
    if (one.link == link) return {one.bends, one.reverse};
  }
  return {};
}

/// Whether the point at `u` begins or turns within `slop` of the end of a link's rope.
bool is_at_an_edge(const std::vector<OnLink>& links, double u, double travel, double slop) {
  return std::any_of(links.begin(), links.end(), [&](const OnLink& link) {
    const auto near = [&](double edge) {
      return std::abs(u - edge) < slop || std::abs(u - travel - edge) < slop;
    };
    return near(link.begin) || near(link.end);
  });
}

TEST(RopeBends, AreThoseOfTheGeometry) {
  // The rope goes by 4 rad/s x 1.5 s x 0.25 m = 1.5 m and back. A section is counted by its middle,
  // which passes an edge when it is beyond it by a tenth of the section, so the counts are exact but
  // for middles that begin or turn within that distance of one of the 9 edges: at most one section in
  // ten, at 18 places.
  constexpr int sections = 200;
  for (const char* step :
       {R"("dt": 0.02, "substeps": 1, "integrator": "rattle")", R"("dt": 0.02, "substeps": 4)",
        R"("dt": 0.01, "substeps": 16, "integrator": "rattle")",
        R"("dt": 0.02, "substeps": 4, "integrator": "xpbd")",
        R"("dt": 0.02, "substeps": 8, "solver": "gauss-seidel", "iterations": 400)",
        R"("dt": 0.1, "substeps": 16)"}) {
    for (const char* material : {"", R"("axial_stiffness": 1e8, "axial_damping": 1e5, )"}) {
      const HoistRun run = run_hoist({.step = step, .material = material}, sections);
      ASSERT_EQ(run.rope.sections.size(), std::size_t{sections});
      EXPECT_TRUE(run.rope.returned);
      // The elastic rope has its strain, at most 2.4e-4, on the drum.
      EXPECT_NEAR(run.travel, 1.5, 1.5 * 3e-4) << step;
      EXPECT_LT(run.error, 1e-3) << step;
      const std::vector<OnLink> links = links_at_start(run.start);
      const double width = run.start.total_length / sections;
      int left_out = 0;
      int reverse = 0;
      for (const SectionHistory& section : run.rope.sections) {
        const double u = 0.5 * (section.from + section.to);
        // The load of an elastic rope swings by less than the strain of its span, 2.4e-4 x 3 m.
        const double slop = 0.1 * width + (*material != 0 ? 1e-3 : 1e-9);
        if (is_at_an_edge(links, u, run.travel, slop)) {
          ++left_out;
          continue;
        }
        const std::vector<BendCount> expected = bends_by_geometry(links, u, run.travel);
        for (std::size_t k = 0; k < links.size(); ++k) {
          const BendCount count = counted(section, static_cast<int>(k));
          EXPECT_EQ(count, expected[k]) << step << " u = " << u << ", link " << k;
          reverse += count.reverse;
        }
      }
      EXPECT_LE(left_out, 18) << step;
      EXPECT_GT(reverse, 20) << step;
    }
  }
}

TEST(RopeBends, HaveTheLengthOfTheTravel) {
  // Of 1.5 m that run over a sheave and back, each metre is bent twice there, and once on the drum.
  // A section counts as a whole: each of the two ends of the bent length is off by at most a
  // section, which its bends count twice.
  for (const int sections : {10, 50, 1000}) {
    const HoistRun run = run_hoist({}, sections);
    const double width = run.start.total_length / sections;
    std::array<double, 5> bent{};
    for (const SectionHistory& section : run.rope.sections) {
      for (const SectionBends& one : section.bends) {
        bent.at(static_cast<std::size_t>(one.link)) += one.bends * width;
      }
    }
    EXPECT_NEAR(bent[0], 1.5, 2.0 * width) << sections;
    for (const std::size_t k : {1, 2, 3}) EXPECT_NEAR(bent.at(k), 3.0, 4.0 * width) << sections;
    EXPECT_EQ(bent[4], 0.0);
  }
}

RopeLife square_life() {
  // 1e6 simple bends at 10 kN, in inverse proportion to the square of the tension; a quarter of it if
  // reverse.
  const Result<RopeLife> life = RopeLife::create({.constants = {{"S0", 10000.0}},
                                                  .definitions = {{"ratio", "tension / 1[N] / S0"}},
                                                  .simple_bends = "1000000 / ratio^2",
                                                  .reverse_bends = "simple_bends / 4"},
                                                 0.012);
  EXPECT_TRUE(life) << life.errors()[0].message;
  return *life;
}

TEST(RopeBends, AreTheSameFromTheOtherEndAndInAMirror) {
  constexpr int sections = 180;
  const HoistRun run = run_hoist({}, sections, square_life());
  for (const Hoist& hoist : {Hoist{.from_the_load = true}, Hoist{.mirrored = true},
                             Hoist{.mirrored = true, .from_the_load = true}}) {
    const HoistRun other = run_hoist(hoist, sections, square_life());
    ASSERT_EQ(other.rope.sections.size(), run.rope.sections.size());
    for (int i = 0; i < sections; ++i) {
      const SectionHistory& a = run.rope.sections[static_cast<std::size_t>(i)];
      const int j = hoist.from_the_load ? sections - 1 - i : i;
      const SectionHistory& b = other.rope.sections[static_cast<std::size_t>(j)];
      for (int k = 0; k < 5; ++k) {
        EXPECT_EQ(counted(a, k), counted(b, hoist.from_the_load ? 4 - k : k)) << i << " " << k;
      }
      // The same sums in another order.
      EXPECT_NEAR(a.damage(), b.damage(), 1e-9 * a.damage()) << i;
      EXPECT_NEAR(a.mean_tension, b.mean_tension, 1e-6 * a.mean_tension) << i;
      EXPECT_NEAR(a.most_tension, b.most_tension, 1e-6 * a.most_tension) << i;
      EXPECT_NEAR(a.least_tension, b.least_tension, 1e-6 * a.least_tension) << i;
    }
  }
}

TEST(RopeBends, HaveTensionsOfTheMotion) {
  // The load is lifted with a = 2 m/s2, at constant speed and with -2 m/s2; the sheaves of 1 kg add
  // m a / 2 each, so a span before k sheaves has m (g + a) + k a / 2. The mean over the run is that
  // of a load which begins and ends at rest at one place.
  const HoistRun run = run_hoist({}, 100);
  const SectionHistory& at_load = run.rope.sections.back();
  EXPECT_NEAR(at_load.most_tension, 2000.0 * 11.81, 0.01);
  EXPECT_NEAR(at_load.least_tension, 2000.0 * 7.81, 0.01);
  EXPECT_NEAR(at_load.mean_tension, 2000.0 * 9.81, 0.01);
  const SectionHistory& at_drum = run.rope.sections.front();
  EXPECT_NEAR(at_drum.most_tension, 2000.0 * 11.81 + 3.0, 0.01);
  EXPECT_NEAR(at_drum.least_tension, 2000.0 * 7.81 - 3.0, 0.01);
}

TEST(RopeBends, TakeTheirShareOfTheLife) {
  // Palmgren and Miner by hand: n_simple / N + n_reverse / (N / 4), with N = 1e6 / (19.62)^2 x 10^2
  // at the tension of the load that moves at constant speed.
  const HoistRun run = run_hoist({}, 400, square_life());
  const double simple = std::pow(19620.0 / 10000.0, 2) / 1e6;
  int checked = 0;
  for (const SectionHistory& section : run.rope.sections) {
    const SectionBends all = section.all_bends();
    const bool steady = all.bends > 0 && std::abs(all.most_tension - 19620.0) < 1e-3 &&
                        std::abs(all.mean_tension - 19620.0) < 1e-3;
    if (!steady) continue;
    ++checked;
    // The tension is right within 1e-3 N of 19620 N, and the damage goes with its square.
    EXPECT_NEAR(all.simple_damage, (all.bends - all.reverse) * simple, 1.1e-7 * 4 * simple);
    EXPECT_NEAR(all.reverse_damage, 4.0 * all.reverse * simple, 1.1e-7 * 16 * simple);
    EXPECT_EQ(section.damage(), all.simple_damage + all.reverse_damage);
  }
  EXPECT_GT(checked, 50);
  // The tension of each of two bends follows from the largest and the mean: 2 m - S.
  int pairs = 0;
  for (const SectionHistory& section : run.rope.sections) {
    for (const SectionBends& one : section.bends) {
      if (one.bends != 2 || one.reverse % 2 != 0) continue;
      ++pairs;
      const double other = 2.0 * one.mean_tension - one.most_tension;
      const double sum = (one.most_tension * one.most_tension + other * other) / 1e8 / 1e6;
      EXPECT_NEAR(one.simple_damage + one.reverse_damage, (one.reverse > 0 ? 4.0 : 1.0) * sum,
                  1e-12 * sum);
    }
  }
  EXPECT_GT(pairs, 50);
}

TEST(RopeBends, DamageHardlyDependsOnTheStep) {
  // A bend has the tension at the end of the step in which it comes. In the ramps of the speed the
  // tension is constant, too, so a step matters only for the sections that come on within one step of
  // the 6 corners of the speed: 1 m/s x 0.02 s, less than one section of 0.11 m. These have one of the
  // three tensions, 15.6, 19.6 or 23.6 kN, in place of another.
  const HoistRun fine = run_hoist({.step = R"("dt": 0.005, "substeps": 1, "integrator": "rattle")"},
                                  100, square_life());
  for (const char* substeps : {"1", "2", "4", "8", "16"}) {
    const HoistRun run = run_hoist(
        {.step = R"("dt": 0.02, "integrator": "rattle", "substeps": )" + std::string(substeps)},
        100, square_life());
    int different = 0;
    for (std::size_t i = 0; i < 100; ++i) {
      const double damage = fine.rope.sections[i].damage();
      if (std::abs(run.rope.sections[i].damage() - damage) > 1e-6 * damage) ++different;
    }
    // Each corner is at up to two wheels.
    EXPECT_LE(different, 12) << substeps;
  }
}

TEST(RopeBends, OfARopeThatDoesNotReturnAreToldSo) {
  const SceneResult scene = load_scene_text(hoist_scene({}), "test");
  ASSERT_TRUE(scene);
  Result<Simulation> made = create_simulation(*scene);
  ASSERT_TRUE(made);
  RopeHistory history(100);
  history.observe(*made);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(made->step().ok());
    history.observe(*made);
  }
  EXPECT_FALSE(history.history()[0].returned);
}

// --- formulas ---

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

RopeLifeFormulas feyrer() {
  // K. Feyrer, Wire Ropes, 2nd edition 2015, equations 3.55 and 3.61, with constants of an example.
  return {.constants = {{"b0", 1.278},
                        {"b1", 0.029},
                        {"b2", 6.241},
                        {"b3", -1.613},
                        {"R0", 1770.0},
                        {"a0", 9.026},
                        {"a1", 0.618},
                        {"a2", 0.424}},
          .definitions = {{"lgD", "log(sheave_diameter / rope_diameter) / log(10)"},
                          {"lgS", "log(tension / rope_diameter^2 / 1000000[N/m2]) / log(10)"},
                          {"lgR", "log(R0 / 1770) / log(10)"}},
          .simple_bends = "10^(b0 + (b1 + b3 * lgD) * (lgS - 0.4 * lgR) + b2 * lgD)",
          .reverse_bends = "a0 * simple_bends^a1 * (sheave_diameter / rope_diameter)^a2"};
}

TEST(RopeLife, IsFeyrersByHand) {
  // d = 16 mm, D = 400 mm, S = 30 kN, R0 = 1770 N/mm2: lg(D/d) = 1.397940, lg(S/d2) = 2.068882, so
  // lg N = 1.278 + (0.029 - 1.613 x 1.397940) x 2.068882 + 6.241 x 1.397940 = 5.397468, and
  // N = 249728, N_rev = 9.026 x 249728^0.618 x 25^0.424 = 76534.
  const Result<RopeLife> life = RopeLife::create(feyrer(), 0.016);
  ASSERT_TRUE(life) << life.errors()[0].message;
  EXPECT_NEAR(1.0 / life->damage(30000.0, 0.4, false), 249728.34108, 1e-4);
  EXPECT_NEAR(1.0 / life->damage(30000.0, 0.4, true), 76534.45839, 1e-4);
  // The exponent of the tension is b1 + b3 lg(D/d) (equation 3.93b), times a1 if reverse (3.93c).
  const double exponent = 0.029 - 1.613 * std::log10(25.0);
  for (const bool reverse : {false, true}) {
    const double ratio = life->damage(60000.0, 0.4, reverse) / life->damage(30000.0, 0.4, reverse);
    EXPECT_NEAR(std::log2(ratio), -exponent * (reverse ? 0.618 : 1.0), 1e-12);
  }
}

TEST(RopeLife, HasNoDamageOfSlackRopeAndNoNumberWithoutAValue) {
  const RopeLife life = square_life();
  EXPECT_EQ(life.damage(0.0, 0.4, false), 0.0);
  EXPECT_EQ(life.damage(-1.0, 0.4, true), 0.0);
  EXPECT_EQ(life.damage(20000.0, 0.4, false), 4e-6);
  EXPECT_EQ(life.damage(20000.0, 0.4, true), 16e-6);
  const Result<RopeLife> negative =
      RopeLife::create({.simple_bends = "1000 - tension / 1[N]"}, 0.01);
  ASSERT_TRUE(negative);
  EXPECT_EQ(negative->damage(500.0, 0.4, true), 1.0 / 500.0) << "reverse bends as simple ones";
  EXPECT_TRUE(std::isnan(negative->damage(1500.0, 0.4, false)));
  const Result<RopeLife> undefined =
      RopeLife::create({.simple_bends = "log(1 - tension / 1000[N])"}, 0.01);
  ASSERT_TRUE(undefined);
  EXPECT_TRUE(std::isnan(undefined->damage(1500.0, 0.4, false)));
  // A section with such a bend has no damage.
  SectionHistory section;
  section.bends.push_back({.link = 1, .bends = 1, .simple_damage = 0.5});
  section.bends.push_back({.link = 2, .bends = 1, .reverse = 1, .reverse_damage = not_a_number});
  EXPECT_TRUE(std::isnan(section.damage()));
}

TEST(RopeLife, RefusesFormulasByName) {
  struct Case {
    RopeLifeFormulas formulas;
    std::string path;
    std::string message;
  };
  const std::array<Case, 8> cases{{
      {{.simple_bends = "tension"},
       "/simple_bends",
       "must be a pure number, and \"tension\" is in N"},
      {{.simple_bends = "tention / 1[N]"}, "/simple_bends", "did you mean \"tension\"?"},
      {{.simple_bends = ""}, "/simple_bends", "there is no \"\""},
      {{.simple_bends = "max(tension) / 1[N]"}, "/simple_bends", "no statistics over time"},
      {{.constants = {{"log", 1.0}}, .simple_bends = "1"},
       "/constants/log",
       "has a meaning already"},
      {{.constants = {{"b", 1.0}}, .definitions = {{"b", "2"}}, .simple_bends = "1"},
       "/definitions/b",
       "has a meaning already"},
      {{.constants = {{"D/d", 1.0}}, .simple_bends = "1"}, "/constants/D/d", "must be a letter"},
      {{.simple_bends = "1", .reverse_bends = "simple_bend / 4"},
       "/reverse_bends",
       "did you mean \"simple_bends\"?"},
  }};
  for (const Case& one : cases) {
    const Result<RopeLife> life = RopeLife::create(one.formulas, 0.01);
    ASSERT_FALSE(life) << one.message;
    EXPECT_EQ(life.errors()[0].path, one.path);
    EXPECT_NE(life.errors()[0].message.find(one.message), std::string::npos)
        << life.errors()[0].message;
    EXPECT_EQ(life.errors().size(), 1U);
  }
}

}  // namespace
}  // namespace sheave::measure
