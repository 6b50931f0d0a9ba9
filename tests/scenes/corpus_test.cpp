// Scenes as they were written by earlier versions: tests/scenes/corpus/VERSION/ is never changed,
// only added to. Between them the scenes of a version have every type and every field that it knew.

#include <array>
#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "engine/body_set.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

/// What a scene was when its file was written. (Lengths of fields-26, -60, -152, -279, -341 and of
/// machine-12, -108, -192 are those since a span that leans out of its wheel's plane leaves it at the
/// radius over the cosine of the lean.)
struct Kept {
  const char* file;
  std::size_t bodies, joints, cables, links, colliders;
  double mass;    ///< of all bodies together at time 0 [kg]
  double length;  ///< of all cables together at time 0 [m]
};

constexpr auto kept_v1 = std::to_array<Kept>({
    Kept{"drives", 10, 10, 0, 0, 0, 11, 0},
    Kept{"everything", 11, 3, 2, 10, 4, 15.938328810994784, 14.754988066301244},
    Kept{"fields-152", 1, 5, 3, 6, 1, 0.32542971775657498, 10.759275652019621},
    Kept{"fields-178", 1, 5, 1, 2, 1, 0.051968986085616051, 2.5853988550656908},
    Kept{"fields-248", 2, 14, 1, 2, 2, 2.1391948624604846, 15.154287736564982},
    Kept{"fields-256", 1, 7, 0, 0, 1, 0.7586966622620821, 0},
    Kept{"fields-26", 1, 2, 1, 2, 1, 83393.004988773842, 99.856297621063845},
    Kept{"fields-279", 1, 9, 1, 2, 1, 0, 55.321856773935565},
    Kept{"fields-285", 1, 8, 0, 0, 1, 0, 0},
    Kept{"fields-341", 1, 4, 2, 5, 1, 0.83532181718313347, 5.3002410501914134},
    Kept{"fields-367", 2, 18, 0, 0, 2, 0.28829830571822823, 0},
    Kept{"fields-57", 1, 7, 0, 0, 1, 0, 0},
    Kept{"fields-60", 3, 14, 1, 2, 2, 88.200298095020031, 2651.0413260073547},
    Kept{"fields-95", 2, 12, 0, 0, 2, 0.0076258242006588262, 0},
    Kept{"machine-0", 10, 2, 1, 7, 2, 9.5760952412645999, 59.580454838379012},
    Kept{"machine-108", 7, 2, 2, 10, 0, 10.707337241780843, 15.684229716040264},
    Kept{"machine-109", 5, 2, 2, 6, 0, 5.1660196513143379, 9.8339009318905894},
    Kept{"machine-119", 6, 2, 2, 6, 4, 11.133498160823741, 10.010067133560096},
    Kept{"machine-12", 5, 2, 1, 2, 2, 6.9332114137171104, 2.042148692266835},
    Kept{"machine-135", 3, 1, 2, 5, 0, 3.2118245031761385, 55.252612787294581},
    Kept{"machine-144", 3, 1, 1, 3, 0, 5.8074431671873441, 5.0620551344989551},
    Kept{"machine-153", 8, 3, 1, 4, 2, 13.311300321153412, 58.133876306445529},
    Kept{"machine-17", 7, 2, 1, 5, 0, 8.7296299690737449, 5.7048745599615458},
    Kept{"machine-192", 4, 3, 1, 6, 0, 7.3199697189274309, 6.8341673815669282},
    Kept{"machine-193", 5, 1, 2, 9, 0, 6.1160315505376976, 63.464610668742935},
    Kept{"machine-211", 5, 2, 1, 4, 0, 6.9601330044347396, 16.131376681475359},
    Kept{"machine-251", 4, 2, 1, 4, 0, 6.6476455055042614, 6.7151925537450055},
    Kept{"machine-292", 5, 1, 2, 8, 0, 5.9547729556342315, 10.830420766081366},
    Kept{"machine-299", 7, 2, 1, 7, 0, 10.218266291703461, 9.2345036702032388},
    Kept{"machine-3", 7, 2, 1, 7, 0, 9.1363950135055898, 8.7597295046708865},
    Kept{"machine-46", 5, 3, 1, 5, 0, 8.6033650972290445, 7.4630298862150539},
    Kept{"machine-58", 6, 1, 1, 6, 0, 4.6879007817940233, 62.52989896341569},
    Kept{"machine-83", 7, 3, 1, 4, 3, 6.4001864454894726, 6.2789039288608208},
});

/// A scene that has become an error since, and a word that says why.
struct Refused {
  const char* file;
  const char* why;
};
constexpr auto refused_v1 = std::to_array<Refused>({
    Refused{"fields-313", "groove"},
    Refused{"fields-324", "groove"},
    Refused{"machine-152", "lifted"},
});

TEST(Corpus, RefusesOldScenesWithAReason) {
  for (const Refused& refused : refused_v1) {
    const std::string folder = SHEAVE_SOURCE_DIR "/tests/scenes/corpus/v1/";
    const SceneResult scene = load_scene(folder + refused.file + ".json");
    ASSERT_FALSE(scene) << refused.file;
    EXPECT_NE(to_string(scene.errors.front()).find(refused.why), std::string::npos) << refused.file;
  }
}

class Corpus : public testing::TestWithParam<Kept> {};

TEST_P(Corpus, ScenesOfEarlierVersionsKeepTheirMeaning) {
  const Kept& kept = GetParam();
  const std::string folder = SHEAVE_SOURCE_DIR "/tests/scenes/corpus/v1/";
  const SceneResult scene = load_scene(folder + kept.file + ".json");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  const Result<Simulation> simulation = Simulation::create(scene->model, scene->cables);
  ASSERT_TRUE(simulation);
  EXPECT_EQ(scene->model.bodies.size(), kept.bodies);
  EXPECT_EQ(scene->model.joints.size(), kept.joints);
  EXPECT_EQ(scene->cables.size(), kept.cables);
  EXPECT_EQ(scene->model.colliders.size(), kept.colliders);
  std::size_t links = 0;
  for (const CableDef& cable : scene->cables) links += cable.links.size();
  EXPECT_EQ(links, kept.links);
  double mass = 0.0;
  for (int i = 0; i < simulation->world.bodies().count(); ++i) {
    mass += simulation->world.bodies()[i].mass;
  }
  double length = 0.0;
  for (const CableReport& cable : simulation->cable_reports()) length += cable.total_length;
  // Seventeen digits are written; sums over some bodies round by as many times half of the last of
  // them.
  EXPECT_NEAR(mass, kept.mass, 1e-13 * kept.mass);
  EXPECT_NEAR(length, kept.length, 1e-13 * kept.length);
}

INSTANTIATE_TEST_SUITE_P(V1, Corpus, testing::ValuesIn(kept_v1),
                         [](const auto& kept) { return test_name(std::string(kept.param.file)); });

TEST(Corpus, NoSceneIsLeftOut) {
  const std::filesystem::directory_iterator files(SHEAVE_SOURCE_DIR "/tests/scenes/corpus/v1");
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(files), end(files))),
            kept_v1.size() + refused_v1.size());
}

}  // namespace
}  // namespace sheave::test
