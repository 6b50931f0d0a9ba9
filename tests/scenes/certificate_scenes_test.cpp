// Every scene of the repository is clean with the direct solver, whatever the integrator: nothing
// that is reported contradicts anything else. So are the machines of dev/faults that once
// came out wrong silently and are mended.

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/run_check.h"
#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

Certificate certify_scene(const Scene& scene, double time, int every) {
  auto simulation = create_simulation(scene);
  EXPECT_TRUE(simulation);
  Certificate all;
  const double end = std::min(scene.duration, time);
  for (int n = 0; simulation && simulation->world.state().time < end - 1e-9; ++n) {
    if (!simulation->step().ok()) {
      ADD_FAILURE() << "diverged";
      break;
    }
    if (n % every != 0) continue;
    if (const auto one = simulation->certificate()) all.merge(*one);
  }
  return all;
}

class CertifiedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(CertifiedScene, IsCleanWithTheDirectSolver) {
  // A rope of 100 links in contact with wheels: with a few rounds per substep its joints open, and
  // the certificate says so.
  if (GetParam().filename() == "naive-rope.json") GTEST_SKIP();
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    SceneResult loaded = load_scene(GetParam());
    ASSERT_TRUE(loaded);
    Scene scene = *loaded.scene;
    scene.model.step.solver = SolverKind::direct;
    scene.model.step.integrator = integrator;
    const Certificate all = certify_scene(scene, 0.5, 3);
    EXPECT_TRUE(all.clean()) << integrator_names[static_cast<std::size_t>(integrator)] << ": "
                             << (all.worst() == nullptr ? "" : all.worst()->sentence());
    EXPECT_GT(all.substeps, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CertifiedScene, testing::ValuesIn(valid_scene_files()),
                         [](const auto& scene) { return test_name(scene.param); });

std::vector<std::filesystem::path> mended_machines() {
  const std::filesystem::path folder = std::filesystem::path(SHEAVE_SOURCE_DIR) / "dev/faults";
  std::vector<std::filesystem::path> files;
  for (const char* name : {"a1-drum-and-post", "a1-eyelets", "a1-feed", "a1-holes", "a2-post",
                           "axles", "damped-friction", "elastic-friction", "feed",
                           "first-step-strains", "late-impulse", "levers"}) {
    files.push_back(folder / (std::string(name) + ".json"));
  }
  return files;
}

INSTANTIATE_TEST_SUITE_P(Faults, CertifiedScene, testing::ValuesIn(mended_machines()),
                         [](const auto& scene) { return test_name(scene.param); });

// A sheet holds a boom against its load, without gravity and at rest: neither weights nor motion
// tell what is much, and tension times the rounding of lengths, 500 N x 4 m x 2e-16 = 4e-13 J, is
// nothing.
TEST(CertificateOfScenes, ALoadAtRestWithoutGravityIsClean) {
  const SceneResult loaded =
      load_scene(std::string(SHEAVE_SOURCE_DIR) + "/dev/faults/mainsheet.json");
  ASSERT_TRUE(loaded);
  const Certificate all = certify_scene(*loaded.scene, 3.0, 1);
  EXPECT_TRUE(all.clean()) << all.worst()->sentence();
  EXPECT_LT(all.find(CertificateItem::Kind::energy)->relative, 1e-3);
}

// The energy of rounding alone grows with the masses: the kinetic energy of places that are rounded
// in each substep.
TEST(CertificateOfScenes, ALoadAtRestWithoutGravityIsCleanInAnyUnits) {
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    for (const int substeps : {1, 4, 64}) {
      SceneResult loaded =
          load_scene(std::string(SHEAVE_SOURCE_DIR) + "/dev/faults/mainsheet.json");
      ASSERT_TRUE(loaded);
      Scene& scene = *loaded.scene;
      scene.model.step.substeps = substeps;
      for (BodyDef& body : scene.model.bodies) {
        if (body.mass) *body.mass *= factor;
        if (body.inertia) *body.inertia *= factor;
        if (body.spin_inertia) *body.spin_inertia *= factor;
        body.torque *= factor;
      }
      auto simulation = create_simulation(scene);
      ASSERT_TRUE(simulation);
      RunCheck check(*simulation);
      for (int i = 0; i < 30; ++i) {
        const StepReport report = simulation->step({}, check.within(*simulation), {});
        ASSERT_TRUE(report.ok());
        check.observe(*simulation, report.statistics);
      }
      EXPECT_TRUE(check.certificate().clean())
          << factor << ' ' << substeps << ": " << check.certificate().worst()->sentence();
    }
  }
}

// What the settings of the paper make of a driven drum under a load that they cannot hold: it runs
// backwards, while tension and torque read right.
TEST(CertificateOfScenes, ADrumThatRunsBackwardsIsDoubtful) {
  const SceneResult loaded =
      load_scene(std::string(SHEAVE_SOURCE_DIR) + "/dev/faults/a3-drum.json");
  ASSERT_TRUE(loaded);
  const Certificate all = certify_scene(*loaded.scene, 0.5, 1);
  ASSERT_NE(all.find(CertificateItem::Kind::drive), nullptr);
  EXPECT_GT(all.find(CertificateItem::Kind::drive)->relative, 1.0);
  EXPECT_FALSE(all.clean());
}

}  // namespace
}  // namespace sheave::test
