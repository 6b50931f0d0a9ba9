// Every scene goes on after an edit that changes nothing of it: what there is of links, joints,
// contacts, wraps, controllers is taken from one world into the next.

#include <gtest/gtest.h>

#include "cable/live_world.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

/// A world of the scene, a few steps after its start. Scenes that are too large for tests are left
/// out.
std::optional<LiveWorld> running(const std::filesystem::path& file, int steps) {
  const SceneResult scene = load_scene(file.string());
  EXPECT_TRUE(scene) << to_string(scene.errors.front());
  if (!scene || scene->model.bodies.size() > 5000) return std::nullopt;
  Result<Simulation> simulation = create_simulation(*scene);
  EXPECT_TRUE(simulation.ok());
  if (!simulation) return std::nullopt;
  LiveWorld world = LiveWorld::of(std::move(*simulation));
  for (int i = 0; i < steps; ++i) {
    if (!world.step().ok()) return std::nullopt;
  }
  return world;
}

BodyDef guest() {
  BodyDef body;
  body.name = "guest of a moment";
  body.mass = 1.0;
  body.inertia = Vector3(1.0, 1.0, 1.0);
  return body;
}

class EditScenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(EditScenes, UnchangedPartsAreKeptBitForBit) {
  std::optional<LiveWorld> world = running(GetParam(), 10);
  if (!world) GTEST_SKIP();
  const State before = world->state();
  const Energy energy = world->energy();
  const std::vector<CableReport> reports = world->simulation().cable_reports();
  const Result<EditReport> done = world->edit([](Edit&) {});
  ASSERT_TRUE(done.ok()) << done.errors().front().message;
  EXPECT_EQ(hash(world->state()), hash(before));
  EXPECT_EQ(world->energy().total(), energy.total());
  EXPECT_TRUE(done->cables.empty());
  const std::vector<CableReport> after = world->simulation().cable_reports();
  ASSERT_EQ(after.size(), reports.size());
  for (std::size_t c = 0; c < after.size(); ++c) {
    EXPECT_EQ(after[c].length_error, reports[c].length_error);
    EXPECT_EQ(after[c].total_length, reports[c].total_length);
  }
  std::optional<LiveWorld> alone = running(GetParam(), 12);
  ASSERT_TRUE(alone);
  std::optional<LiveWorld> compiled = running(GetParam(), 10);
  // A body that comes and goes lets all cables be compiled again; else they are taken as they are.
  ASSERT_TRUE(compiled->edit([](Edit& edit) { edit.remove(edit.add(guest())); }).ok());
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(world->step().ok());
    ASSERT_TRUE(compiled->step().ok());
  }
  const State& taken = world->state();
  ASSERT_EQ(taken.features.size(), compiled->state().features.size());
  for (std::size_t f = 0; f < taken.features.size(); ++f) {
    EXPECT_EQ(taken.features[f].reals, compiled->state().features[f].reals) << f;
    EXPECT_EQ(taken.features[f].integers, compiled->state().features[f].integers) << f;
  }
  // A course that is not that of time 0 is not stepped by the same code before as after, which
  // rounds differently.
  const double scale = world->simulation().world.bodies().scale();
  for (std::size_t i = 0; i < before.bodies.size(); ++i) {
    const BodyState& a = world->state().bodies[i];
    const BodyState& b = alone->state().bodies[i];
    EXPECT_LE((a.position - b.position).norm(), 1e-9 * scale) << i;
  }
}

// Each cable is split in the middle of a span and joined there again, all in one edit.
TEST_P(EditScenes, SplicedCablesHaveTheirLengths) {
  std::optional<LiveWorld> world = running(GetParam(), 10);
  if (!world) GTEST_SKIP();
  for (const CableHandle cable : world->cables()) {
    const double length = *world->length(cable);
    const CableReport before = world->simulation().cable_reports()[at(cable.slot)];
    if (before.cut) continue;
    // Edits refuse a cable between two points of one body, which moves nothing.
    const auto& links = (*world->simulation().cable_definitions)[at(cable.slot)].links;
    if (links.size() == 2 && links[0]->body == links[1]->body) continue;
    // Edits refuse to take apart a rope that remembers how it was stretched.
    if ((*world->simulation().cable_definitions)[at(cable.slot)].has_memory()) continue;
    int span = 0;
    while (at(span) < before.links.size() && !before.links[at(span)].touched) ++span;
    const bool closed = (*world->simulation().cable_definitions)[at(cable.slot)].closed;
    const Result<EditReport> done = world->edit([&](Edit& edit) {
      if (closed) edit.open(cable, span, 0.5);
      edit.join(cable, closed ? cable : edit.split(cable, span, 0.5, "the rest"));
    });
    ASSERT_TRUE(done.ok()) << done.errors().front().message;
    EXPECT_EQ(*world->length(cable), length);
    if (closed) continue;  // its links are numbered from elsewhere now
    const CableReport after = world->simulation().cable_reports()[at(cable.slot)];
    ASSERT_EQ(after.spans.size(), before.spans.size());
    for (std::size_t k = 0; k < after.spans.size(); ++k) {
      EXPECT_EQ(after.spans[k].length, before.spans[k].length);
    }
    for (std::size_t i = 0; i < after.links.size(); ++i) {
      EXPECT_EQ(after.links[i].stored_length, before.links[i].stored_length) << i;
    }
    EXPECT_LT(std::abs(after.length_error), 1e-15);
  }
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(world->step().ok());
}

INSTANTIATE_TEST_SUITE_P(Scenes, EditScenes, testing::ValuesIn(valid_scene_files()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace sheave::test
