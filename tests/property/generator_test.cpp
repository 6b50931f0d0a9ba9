// The generator itself: reproducible, accepted as a rule, and with all that it promises among its
// machines.

#include <cstdlib>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "engine/joint.h"
#include "scenes/scene.h"
#include "tests/property/campaign.h"
#include "tests/property/shrink.h"
#include "tests/property/wide_machine.h"

namespace sheave::test {
namespace {

TEST(RandomMachine, IsTheSameForTheSameSeed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(describe(random_machine(seed).machine), describe(random_machine(seed).machine));
  }
  EXPECT_NE(describe(random_machine(1).machine), describe(random_machine(2).machine));
}

TEST(RandomMachine, IsAcceptedAsARule) {
  int refused = 0;
  constexpr int seeds = 300;
  std::map<std::string, int> reasons;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const RandomMachine random = random_machine(seed);
    refused += random.refused;
    if (random.refused > 0) ++reasons[random.first_refusal];
  }
  std::string list;
  for (const auto& [reason, count] : reasons) list += std::to_string(count) + " x " + reason;
  EXPECT_LT(refused, seeds / 4) << list;
}

TEST(RandomMachine, HasEveryKindOfLink) {
  std::string all;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) all += describe(random_machine(seed).machine);
  for (const char* part :
       {"attachment(", "rolling(",   "pinhole(",       "hybrid(",   "spool(",
        "closed",      "lifted",     "turns",          " J=0",      "(free",
        "(planar",     "(slider",    "(kinematic",     "(rotor on", "mu 0.",
        "EA",          "compliance", "frozen",         "radius",    "rest lengths given",
        "pitch 0.0",   " direct ",   " gauss-seidel ", " xpbd;",    " rattle;"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part;
  }
}

// With SHEAVE_MACHINES=FOLDER their scenes are written there, SHEAVE_CASES of them: for tools that
// run scenes.
TEST(WideMachine, IsASceneThatMovesTheSame) {
  const char* folder = std::getenv("SHEAVE_MACHINES");
  const char* cases = std::getenv("SHEAVE_CASES");
  const std::uint64_t count =
      folder != nullptr && cases != nullptr ? std::strtoull(cases, nullptr, 10) : 40;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const Machine machine = wide_machine(seed);
    const std::string text = scene_of(machine);
    if (folder != nullptr) {
      std::ofstream(std::string(folder) + "/machine-" + std::to_string(seed) + ".json") << text;
      continue;
    }
    const SceneResult scene = load_scene_text(text, "machine");
    ASSERT_TRUE(scene) << to_string(scene.errors.front()) << text;
    // Orientations are made unit on the way, so numbers may differ by rounding.
    Simulation one = start(machine);
    Simulation other = start(Machine{scene->model, scene->cables});
    ASSERT_TRUE(one.world.step().ok() && other.world.step().ok()) << "seed " << seed;
    for (std::size_t i = 0; i < machine.model.bodies.size(); ++i) {
      const BodyState& a = one.world.state().bodies[i];
      const BodyState& b = other.world.state().bodies[i];
      EXPECT_LT((a.position - b.position).norm(), 1e-9) << "seed " << seed << " body " << i;
    }
  }
}

TEST(WideMachine, HasEveryFeature) {
  std::string all;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) all += scene_of(wide_machine(seed));
  for (const auto& type : joint_types()) {
    EXPECT_NE(all.find("\"type\": \"" + std::string(type.name) + "\""), std::string::npos)
        << type.name;
  }
  for (const auto& type : link_types()) {
    // Wraps on smooth bodies lie along geodesics, too. Sheaths and openings have machines of their
    // own (sheath_test.cpp, opening_link_test.cpp).
    if (type.name == "surface" || type.name == "sheath" || type.name == "opening") continue;
    EXPECT_NE(all.find("\"type\": \"" + std::string(type.name) + "\""), std::string::npos)
        << type.name;
  }
  for (
      const char* key :
      {"lower",        "upper",           "stiffness",        "friction",         "drive",
       "drive_limit",  "drive_amplitude", "backlash",         "limit_compliance", "breaking_force",
       "feed_speed",   "wrappable",       "restitution",      "layer_pitch",      "axial_stiffness",
       "compliance",   "damping",         "ground",           "colliders",        "mount",
       "spin_inertia", "angular_damping", "breaking_tension", "swing_limit"}) {
    EXPECT_NE(all.find("\"" + std::string(key) + "\":"), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace sheave::test
