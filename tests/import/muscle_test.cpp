// Muscles against MuJoCo's own numbers: curves, activation, forces, accelerations, 1 s of motion.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "scenes/control/muscle_curves.h"
#include "scenes/control/scene_supervisor.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

using testing::HasSubstr;

class ImportedMuscles : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }

  /// The scene in a keyframe with these activations and controls.
  Scene scene_at(const nlohmann::json& qpos, const nlohmann::json& qvel, const nlohmann::json& act,
                 const nlohmann::json& ctrl) const {
    std::string keyed = test::with_keyframe(text, test::numbers(qpos), test::numbers(qvel));
    std::string more = " act=\"";
    for (const double value : test::numbers(act)) more += fmt::format("{:.17g} ", value);
    more += "\" ctrl=\"";
    for (const double value : test::numbers(ctrl)) more += fmt::format("{:.17g} ", value);
    keyed.insert(keyed.find("<key ") + 4, more + "\"");
    return test::scene_in_keyframe(keyed, "muscles");
  }

  std::string text = test::plain_model("muscles");
  test::ReadModel model{text};
  nlohmann::json reference = test::references("muscles");
};

// The same formulas: sums and products of a few terms of size 1. Below lmin version 2.2.2 has a force
// that pushes; its documentation and later versions have none, as here.
TEST_F(ImportedMuscles, CurvesAreThoseOfMujoco) {
  std::size_t active = 0;
  for (const auto& row : reference["curves"]) {
    const std::vector<double> law = test::numbers(row["law"]);
    const MuscleCurves curves{law[4], law[5], law[7], law[8]};
    // The lengthrange of the reference is its range, so its optimal length is 1.
    const double length = row["length"].get<double>();
    const double speed = row["speed"].get<double>() / law[6];
    const double gain = -row["gain"].get<double>();
    const double expected = length < law[4] ? 0.0 : gain;
    EXPECT_NEAR(curves.by_length(length) * curves.by_velocity(speed), expected, 1e-13);
    EXPECT_NEAR(curves.passive(length), -row["bias"].get<double>(), 1e-13);
    active += gain > 0.0 ? 1 : 0;
  }
  EXPECT_GE(active, 50U);
}

// (a(h) - a) / h = a' + O(h): with h = 1e-9 s and time constants above 5e-3 s, a'' h is below 1e-4
// and the rounding of the difference 1e-7.
TEST_F(ImportedMuscles, ActivationHasTheRateOfMujoco) {
  for (const auto& row : reference["activations"]) {
    const std::vector<double> times = test::numbers(row["times"]);
    const MuscleActivation dynamics{times[0], times[1]};
    const double now = row["activation"].get<double>();
    const double control = row["control"].get<double>();
    const double tau = dynamics.time_constant(now, control);
    EXPECT_NEAR((control - now) / tau, row["rate"].get<double>(), 1e-10);
    EXPECT_NEAR((dynamics.after(now, control, 1e-9) - now) / 1e-9, row["rate"].get<double>(), 1e-3);
  }
}

// The tension of a step is that of its middle. Steps h and h / 2 leave an error of h^2 times the
// second derivative: with h = 1e-6 s some 1e-9 of the force.
TEST_F(ImportedMuscles, ForcesAreThoseOfMujoco) {
  for (const auto& pose : reference["poses"]) {
    const Scene scene = scene_at(pose["qpos"], pose["qvel"], pose["act"], pose["ctrl"]);
    std::array<std::vector<MuscleState>, 2> muscles;
    for (const int halves : {0, 1}) {
      Scene own = scene;
      own.model.step.dt = halves == 0 ? 1e-6 : 0.5e-6;
      Result<Simulation> simulation = create_simulation(own);
      ASSERT_TRUE(simulation.ok()) << simulation.errors().front().message;
      static_cast<void>(simulation->step());
      const auto& supervisor = dynamic_cast<const SceneSupervisor&>(*simulation->supervisor);
      muscles[static_cast<std::size_t>(halves)] = supervisor.muscles(simulation->world.state());
    }
    const std::vector<double> gears{1.0, 1.0, 1.5, 0.5, 1.0, 1.0};
    // The muscles are written tendon by tendon.
    const std::vector<std::string> names{"flexor",  "extensor", "biceps",
                                         "triceps", "long",     "second"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      double tension = -1.0;
      for (std::size_t k = 0; k < names.size(); ++k) {
        if (muscles[0][k].name != names[i]) continue;
        tension = 2.0 * muscles[1][k].tension - muscles[0][k].tension;
      }
      const double expected = -pose["force"][i].get<double>();
      EXPECT_NEAR(tension / gears[i], expected, 1e-6 * (1.0 + expected)) << names[i];
    }
  }
}

/// Velocities of the two links of the arm.
std::vector<Vector3> arm_rates(const World& world) {
  std::vector<Vector3> rates;
  for (const char* name : {"upper", "fore"}) {
    for (int i = 0; i < world.bodies().count(); ++i) {
      if (world.bodies().name(i) != name) continue;
      rates.push_back(world.velocity(BodyId{i}));
      rates.push_back(world.angular_velocity(BodyId{i}));
    }
  }
  return rates;
}

// As Imported.AccelerationsAreEqual: three steps leave the third order.
TEST_F(ImportedMuscles, AccelerationsAreThoseOfMujoco) {
  for (const auto& pose : reference["poses"]) {
    const Scene scene = scene_at(pose["qpos"], pose["qvel"], pose["act"], pose["ctrl"]);
    const auto mean = [&](double dt) {
      Scene own = scene;
      own.model.step.dt = dt;
      Result<Simulation> simulation = create_simulation(own);
      std::vector<Vector3> rates = arm_rates(simulation->world);
      static_cast<void>(simulation->step());
      const std::vector<Vector3> after = arm_rates(simulation->world);
      for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (after[i] - rates[i]) / dt;
      return rates;
    };
    constexpr double h = 4e-5;
    const auto coarse = mean(h);
    const auto middle = mean(h / 2.0);
    const auto fine = mean(h / 4.0);
    const auto at = [&](double time) {
      std::vector<double> q = test::numbers(pose["qpos"]);
      std::vector<double> v = test::numbers(pose["qvel"]);
      test::move_on(*model, time, test::numbers(pose["qacc"]), q, v);
      const import::mjcf::Pose there = pose_of(*model, std::move(q), v);
      std::vector<Vector3> rates;
      for (const std::size_t i : {1U, 2U}) {
        rates.push_back(there.bodies[i].velocity);
        rates.push_back(there.bodies[i].angular_velocity);
      }
      return rates;
    };
    constexpr double small = 1e-5;
    const auto before = at(-small);
    const auto after = at(small);
    double size = 1.0;
    for (const Vector3& a : fine) size = std::max(size, a.norm());
    ASSERT_EQ(fine.size(), before.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const Vector3 expected = (after[i] - before[i]) / (2.0 * small);
      const Vector3 first = 2.0 * middle[i] - coarse[i];
      const Vector3 second = 2.0 * fine[i] - middle[i];
      EXPECT_LT(((4.0 * second - first) / 3.0 - expected).norm(), 5e-6 * size) << i;
    }
  }
}

struct EndOfMotion {
  Vector3 place;
  std::vector<MuscleState> muscles;
};

EndOfMotion after_one_second(Scene scene, double dt) {
  scene.model.step.dt = dt;
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  for (int i = 0; i < static_cast<int>(std::lround(1.0 / dt)); ++i) {
    static_cast<void>(simulation->step());
  }
  EndOfMotion end;
  const World& world = simulation->world;
  for (int i = 0; i < world.bodies().count(); ++i) {
    if (world.bodies().name(i) == "fore") end.place = world.position(BodyId{i});
  }
  end.muscles =
      dynamic_cast<const SceneSupervisor&>(*simulation->supervisor).muscles(world.state());
  return end;
}

// The error of second order shows in two steps, as in Imported.OneSecondOfMotionIsEqualToSecondOrder.
TEST_F(ImportedMuscles, OneSecondOfMotionIsEqualToSecondOrder) {
  const auto& motion = reference["motion"];
  const nlohmann::json rest = {0.0, 0.0, 0.0};
  const nlohmann::json relaxed = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const Scene scene = scene_at(rest, rest, relaxed, motion["ctrl"]);
  const EndOfMotion coarse = after_one_second(scene, 1e-3);
  const EndOfMotion fine = after_one_second(scene, 5e-4);
  const Vector3 exact = test::vector_at(motion["ends"][1]["xpos"], 3);
  const Vector3 rough = test::vector_at(motion["ends"][0]["xpos"], 3);
  EXPECT_LT((rough - exact).norm(), 1e-8) << "the reference is not converged";
  const double difference = (coarse.place - fine.place).norm();
  EXPECT_LT(difference, 1e-3);
  EXPECT_LT((fine.place - exact).norm(), 0.4 * difference + 1e-8);
  RecordProperty("difference", fmt::format("{:.3g}", difference));
  RecordProperty("error", fmt::format("{:.3g}", (fine.place - exact).norm()));
  for (const MuscleState& muscle : fine.muscles) {
    for (std::size_t i = 0; i < model->actuators.size(); ++i) {
      if (model->actuators[i].name != muscle.name) continue;
      EXPECT_NEAR(muscle.activation, motion["ends"][1]["act"][i].get<double>(), 1e-9);
    }
  }
}

std::string muscle_note(const std::string& attributes, const std::string& tendon = "flexor") {
  const std::string text = R"(<mujoco><worldbody><site name="a" pos="0.1 0 0"/>
    <body name="b"><joint name="j" axis="0 1 0"/><geom size="0.1"/><site name="c" pos="0 0 -0.3"/></body></worldbody>
    <tendon><spatial name="flexor"><site site="a"/><site site="c"/></spatial>
      <fixed name="sum"><joint joint="j" coef="1"/></fixed></tendon>
    <actuator><muscle name="m" )" +
                           attributes + (tendon.empty() ? "" : " tendon=\"" + tendon + "\"") +
                           "/></actuator></mujoco>";
  const import::Outcome made = import::import_model(text, "m.xml");
  std::string all;
  for (const import::Note& note : made.notes) all += note.text + "\n";
  for (const SceneError& error : made.errors) all += to_string(error) + "\n";
  return all;
}

TEST_F(ImportedMuscles, WhatHasNoCounterpartIsTold) {
  EXPECT_THAT(muscle_note("force=\"0\" lengthrange=\"0.1 0.4\""), HasSubstr("its force is 0"));
  const std::string law = "force=\"5\" lengthrange=\"0.1 0.4\" ";
  EXPECT_THAT(muscle_note(law), HasSubstr("\"m\": a muscle of 5 N and 1 m along the cable"));
  EXPECT_THAT(muscle_note(law + "lmin=\"1.2\""), HasSubstr("0 <= lmin < 1"));
  EXPECT_THAT(muscle_note(law + "range=\"1.1 0.7\""), HasSubstr("that rise"));
  EXPECT_THAT(muscle_note(law + "gear=\"-1\""), HasSubstr("gear of 0 or below"));
  EXPECT_THAT(muscle_note(law, "sum"), HasSubstr("on a fixed one"));
  EXPECT_THAT(muscle_note(law + "joint=\"j\"", ""), HasSubstr("on a joint"));
}

}  // namespace
}  // namespace sheave
