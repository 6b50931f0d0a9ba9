// Rungs of the model against closed forms, and what each may touch.

#include "measure/model_rung.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "measure/run_error.h"

namespace sheave::measure {
namespace {

const std::string root = SHEAVE_SOURCE_DIR "/scenes/";

Scene shipped(const std::string& file) {
  SceneResult scene = load_scene(root + file);
  EXPECT_TRUE(scene) << file;
  return std::move(scene.scene).value_or(Scene{});
}

/// Solved to the solver's precision, with no error of the step where acceleration is constant.
Scene exact(Scene scene, double duration) {
  scene.model.step.solver = SolverKind::direct;
  scene.model.step.integrator = IntegratorKind::rattle;
  scene.model.step.substeps = 2;
  scene.model.step.iterations = 40;
  scene.duration = duration;
  return scene;
}

const ModelRung& rung(const std::string& name) {
  const auto rungs = model_rungs();
  const auto found =
      std::find_if(rungs.begin(), rungs.end(), [&](const auto& one) { return one.name == name; });
  EXPECT_NE(found, rungs.end()) << name;
  return *found;
}

RungScene changed(const std::string& name, const Scene& scene) {
  RungScene result = on_rung(rung(name), scene);
  EXPECT_GT(result.changed, 0) << name;
  EXPECT_TRUE(result.faults.empty()) << name << ": " << result.faults.front().message;
  return result;
}

Trajectory run(const Scene& scene) {
  Result<Trajectory> own = record(scene);
  EXPECT_TRUE(own && own->complete());
  return std::move(own).value();
}

double travel(const Trajectory& run, const std::string& body) {
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    if (run.bodies[i].name != body) continue;
    return (run.frames.back().poses[i].position - run.frames.front().poses[i].position).y();
  }
  ADD_FAILURE() << "no body " << body;
  return 0.0;
}

double seconds_of(const Scene& scene) {
  return scene.model.step.dt * static_cast<double>(frame_count(scene));
}

/// Two weights, m1 = 1 kg and m2 = 2 kg, over a wheel of I / r^2 = 2 kg.
Scene atwood() { return exact(shipped("analytic/atwood.json"), 1.0); }

TEST(ModelRung, AtwoodWithAMasslessWheel) {
  const RungScene massless = changed("massless wheels", atwood());
  EXPECT_EQ(massless.changed, 1);
  const double t = seconds_of(massless.scene);
  const Trajectory own = run(massless.scene);
  // (m2 - m1) g / (m1 + m2), with one tension 2 m1 m2 g / (m1 + m2) on both sides.
  EXPECT_NEAR(travel(own, "light"), 0.5 * (9.81 / 3.0) * t * t, 1e-9);
  EXPECT_NEAR(own.frames.back().tensions[0], 4.0 * 9.81 / 3.0, 1e-6);
  EXPECT_NEAR(own.frames.back().tensions[1], 4.0 * 9.81 / 3.0, 1e-6);
  // As written it is (m2 - m1) g / 5: the rung's difference is that of the closed forms. Rotors
  // turn by way / r, and count with their rim, r x angle = way, so all three bodies are displaced
  // by as much.
  const Trajectory written = run(atwood());
  const double apart = 0.5 * 9.81 * (1.0 / 3.0 - 1.0 / 5.0) * t * t;
  EXPECT_NEAR(model_difference(own, written).position, apart / written.scale, 1e-9);
  // Tensions: 13.08 for 11.772 and 15.696 N, root mean square over both.
  const double square = std::pow(13.08 - 11.772, 2) + std::pow(13.08 - 15.696, 2);
  EXPECT_NEAR(model_difference(own, written).tension,
              std::sqrt(square / (11.772 * 11.772 + 15.696 * 15.696)), 1e-6);
}

ModelDifference difference_of_hinges(const std::string& file, int substeps) {
  Scene scene = exact(shipped(file), 1.0);
  scene.model.step.substeps = substeps;
  const RungScene hinged = changed("rotors as bodies with hinges", scene);
  return model_difference(run(hinged.scene), run(scene));
}

TEST(ModelRung, RotorsAreTheSameAsBodiesWithHinges) {
  // The direct solver leaves violations of 1e-10 of the scene, and the steps are the same: a hinge
  // about a fixed axis and the rotor's own coordinate integrate the same angle. A tension is a
  // violation over h^2, in units of a weight.
  for (const std::string file :
       {"analytic/atwood.json", "analytic/belt.json", "analytic/block-and-tackle-4.json"}) {
    SCOPED_TRACE(file);
    EXPECT_LT(difference_of_hinges(file, 2).position, 1e-10);
    EXPECT_LT(difference_of_hinges(file, 2).tension, 1e-8);
  }
}

TEST(ModelRung, RotorsWithDragAreTheSameAsBodiesWithHinges) {
  // Drag takes e^(-c h / J) of a rotor's speed, and of a body with unequal moments the same to
  // first order in h (engine/integrators/loads.cpp). The constraints put the speed right at once,
  // so only their forces differ, by half as much with half the step.
  const ModelDifference coarse = difference_of_hinges("paper/hilbert2-stretched.json", 2);
  const ModelDifference fine = difference_of_hinges("paper/hilbert2-stretched.json", 4);
  EXPECT_LT(coarse.position, 1e-10);
  EXPECT_LT(coarse.tension, 1e-4);
  EXPECT_NEAR(coarse.tension / fine.tension, 2.0, 0.05);
}

TEST(ModelRung, HingedRotorsOfABodyThatTurns) {
  // The gyroscope's rotor is mounted on a body that precesses, so the six-degree body turns about a
  // moving axis, where both integrators have their own error of second order: it must fall by four
  // when the step is halved.
  std::array<double, 2> differences{};
  for (std::size_t i = 0; i < 2; ++i) {
    Scene scene = exact(shipped("analytic/gyroscope.json"), 0.2);
    scene.model.step.substeps = i == 0 ? 64 : 128;
    const RungScene hinged = changed("rotors as bodies with hinges", scene);
    differences[i] = model_difference(run(hinged.scene), run(scene)).position;
  }
  EXPECT_LT(differences[1], 1e-3);
  EXPECT_NEAR(differences[0] / differences[1], 4.0, 0.4);
}

TEST(ModelRung, SlidersAreTheSameAsBodiesOnRails) {
  const RungScene railed = changed("sliders as bodies on rails", atwood());
  EXPECT_EQ(railed.changed, 2);
  const ModelDifference difference = model_difference(run(railed.scene), run(atwood()));
  EXPECT_LT(difference.position, 1e-9);
  EXPECT_LT(difference.tension, 1e-7);
}

TEST(ModelRung, PlanarBodiesInSpaceMoveAsBefore) {
  const Scene scene = exact(shipped("analytic/yo-yo.json"), 0.5);
  const RungScene spatial = changed("planar bodies in space", scene);
  EXPECT_LT(model_difference(run(spatial.scene), run(scene)).position, 1e-8);
  // And back again, it is the scene as it was.
  const RungScene planar = changed("free bodies in a plane", spatial.scene);
  EXPECT_LT(model_difference(run(planar.scene), run(scene)).position, 1e-12);
}

TEST(ModelRung, RigidCablesMoveLikeCablesThatWereNeverElastic) {
  Scene elastic = atwood();
  elastic.cables[0].compliance = 1e-3;
  elastic.cables[0].damping = 5.0;
  const RungScene rigid = changed("rigid cables", elastic);
  EXPECT_EQ(model_difference(run(rigid.scene), run(atwood())).position, 0.0);
  const RungScene undamped = changed("undamped cables", elastic);
  EXPECT_EQ(undamped.scene.cables[0].compliance, 1e-3);
  EXPECT_EQ(undamped.scene.cables[0].damping, 0.0);
}

TEST(ModelRung, BodiesWithoutDragFallFreely) {
  Scene scene;
  scene.model.gravity = {0.0, -10.0, 0.0};
  scene.duration = 1.0;
  BodyDef stone;
  stone.name = "stone";
  stone.mass = 1.0;
  stone.inertia = Vector3::Constant(1.0);
  stone.damping = 2.0;
  scene.model.add(stone);
  scene = exact(scene, 1.0);
  const RungScene light = changed("no drag", scene);
  const double t = seconds_of(scene);
  EXPECT_NEAR(travel(run(light.scene), "stone"), -5.0 * t * t, 1e-9);
  // Drag b = 2 kg/s on 1 kg: way = g / b (t - (1 - e^(-b t)) / b).
  EXPECT_GT(travel(run(scene), "stone"), -5.0 * 0.6 * t * t);
}

TEST(ModelRung, FrictionOfEachKindIsRemovedAlone) {
  // A rope round a post: without friction at the link it rolls; on a fixed post it is then held.
  const Scene capstan = exact(shipped("analytic/capstan-1-turns.json"), 0.5);
  const RungScene held = changed("wheels without slip", capstan);
  for (const CableDef& cable : held.scene.cables) {
    for (const auto& link : cable.links) {
      const auto* const rolling = dynamic_cast<const RollingLink*>(link.get());
      EXPECT_TRUE(rolling == nullptr || !rolling->friction);
    }
  }
  EXPECT_GT(model_difference(run(held.scene), run(capstan)).position, 1e-3);
  // A box on a slope: without friction it slides down it with g sin of the slope.
  const Scene box = exact(shipped("analytic/sliding-box.json"), 0.5);
  const RungScene smooth = changed("smooth contacts", box);
  for (const ColliderDef& collider : smooth.scene.model.colliders) {
    EXPECT_EQ(collider.friction, 0.0);
    EXPECT_FALSE(collider.static_friction);
  }
  const RungScene through = changed("no contacts", box);
  EXPECT_TRUE(through.scene.model.colliders.empty());
}

TEST(ModelRung, JointsLoseTheNamedSettingsAndKeepTheRest) {
  const Scene hand = shipped("paper/hand.json");
  const RungScene undamped = changed("undamped joints", hand);
  const RungScene smooth = changed("joints without friction", shipped("analytic/four-bar.json"));
  EXPECT_EQ(smooth.scene.model.joints.size(),
            shipped("analytic/four-bar.json").model.joints.size());
  ASSERT_EQ(undamped.scene.model.joints.size(), hand.model.joints.size());
  const std::string before = write_scene(hand);
  EXPECT_THAT(before.substr(before.find("\"joints\"")), testing::HasSubstr("\"damping\""));
  const std::string after = write_scene(undamped.scene);
  const std::size_t begin = after.find("\"joints\"");
  const std::string joints = after.substr(begin, after.find("\"cables\"") - begin);
  EXPECT_THAT(joints, testing::Not(testing::HasSubstr("damping")));
  EXPECT_THAT(joints, testing::HasSubstr("\"stiffness\""));
}

TEST(ModelRung, TangentsAreSetForAllCables) {
  const RungScene rough = changed("tangents per substep", atwood());
  EXPECT_EQ(on_rung(rung("tangents per iteration"), atwood()).changed, 0);
  const RungScene back = changed("tangents per iteration", rough.scene);
  EXPECT_EQ(back.scene.cables[0].tangent_update, TangentUpdate::iteration);
}

TEST(ModelRung, ChangesShippedScenesCompletely) {
  // Once done there is nothing left to do, and what is no valid scene any more says why.
  std::set<std::string> used;
  for (const std::string folder : {"analytic", "paper", "machines"}) {
    for (const auto& file : std::filesystem::directory_iterator(root + folder)) {
      if (file.path().extension() != ".json" || file.path().stem() == "hilbert3") continue;
      const Scene scene = shipped(folder + ("/" + file.path().filename().string()));
      for (const ModelRung& one : model_rungs()) {
        SCOPED_TRACE(file.path().string() + ": " + one.name);
        const RungScene first = on_rung(one, scene);
        if (first.changed == 0) continue;
        used.insert(one.name);
        EXPECT_EQ(on_rung(one, first.scene).changed, 0);
        for (const Error& fault : first.faults) EXPECT_FALSE(fault.message.empty());
      }
    }
  }
  // Rungs of which no shipped scene has anything are untested by them.
  EXPECT_GE(used.size() + 4U, model_rungs().size());
}

TEST(ModelRung, NamesAreUnique) {
  std::set<std::string> names;
  for (const ModelRung& one : model_rungs()) EXPECT_TRUE(names.insert(one.name).second) << one.name;
}

}  // namespace
}  // namespace sheave::measure
