// Writes the results of MuJoCo for muscles, as references for the tests of imports:
//
//   sheave_muscle_reference MODEL.xml POSES SEED > references/NAME.json
//
// The numbers that MuJoCo finds itself (acc0, lengthrange). With POSES above 0 also the curves of a
// muscle and the rate of its activation at random arguments; forces and
// accelerations at random poses, velocities, activations and controls; the motion of 1 s by
// Runge-Kutta steps of two sizes.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include <mujoco/mujoco.h>

#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::ordered_json;

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

Json list(const mjtNum* values, int count) {
  Json json = Json::array();
  for (int i = 0; i < count; ++i) json.push_back(values[i]);
  return json;
}

class MuscleReference {
 public:
  MuscleReference(mjModel& model, unsigned seed)
      : model_(model), data_(mj_makeData(&model)), random_(seed) {}

  /// Gain and bias of a muscle of the force 1 whose lengthrange is its range.
  Json curves(int count) {
    Json rows = Json::array();
    for (int i = 0; i < count; ++i) {
      const std::array<mjtNum, 9> law{0.75,
                                      1.05,
                                      1.0,
                                      0.0,
                                      uniform(0.2, 0.8),
                                      uniform(1.2, 2.0),
                                      uniform(1.0, 5.0),
                                      uniform(0.5, 2.0),
                                      uniform(1.05, 1.8)};
      const std::array<mjtNum, 2> range{0.75, 1.05};
      const double length = uniform(0.1, 2.2);
      const double speed = uniform(-1.3, 1.3) * law[6];
      rows.push_back({{"law", list(law.data(), 9)},
                      {"length", length},
                      {"speed", speed},
                      {"gain", mju_muscleGain(length, speed, range.data(), 1.0, law.data())},
                      {"bias", mju_muscleBias(length, range.data(), 1.0, law.data())}});
    }
    return rows;
  }

  Json activations(int count) {
    Json rows = Json::array();
    for (int i = 0; i < count; ++i) {
      const std::array<mjtNum, 2> times{uniform(0.005, 0.05), uniform(0.01, 0.1)};
      const double control = uniform(0.0, 1.0);
      const double now = uniform(0.0, 1.0);
      rows.push_back({{"times", list(times.data(), 2)},
                      {"control", control},
                      {"activation", now},
                      {"rate", mju_muscleDynamics(control, now, times.data())}});
    }
    return rows;
  }

  Json constants() {
    Json rows = Json::array();
    for (int i = 0; i < model_.nu; ++i) {
      rows.push_back({{"name", mj_id2name(&model_, mjOBJ_ACTUATOR, i)},
                      {"acc0", model_.actuator_acc0[i]},
                      {"lengthrange", list(model_.actuator_lengthrange + 2 * i, 2)}});
    }
    return rows;
  }

  Json at_random_poses(int count) {
    Json poses = Json::array();
    for (int i = 0; i < count; ++i) {
      mj_resetData(&model_, data_.get());
      for (int k = 0; k < model_.nq; ++k) data_->qpos[k] = uniform(-0.7, 0.7);
      for (int k = 0; k < model_.nv; ++k) data_->qvel[k] = uniform(-2.0, 2.0);
      for (int k = 0; k < model_.na; ++k) data_->act[k] = uniform(0.0, 1.0);
      for (int k = 0; k < model_.nu; ++k) data_->ctrl[k] = uniform(0.0, 1.0);
      mj_forward(&model_, data_.get());
      poses.push_back({{"qpos", list(data_->qpos, model_.nq)},
                       {"qvel", list(data_->qvel, model_.nv)},
                       {"act", list(data_->act, model_.na)},
                       {"ctrl", list(data_->ctrl, model_.nu)},
                       {"force", list(data_->actuator_force, model_.nu)},
                       {"qacc", list(data_->qacc, model_.nv)}});
    }
    return poses;
  }

  Json motion() {
    Json ends = Json::array();
    Json controls;
    for (const double step : {2e-4, 1e-4}) {
      model_.opt.timestep = step;
      model_.opt.integrator = mjINT_RK4;
      mj_resetData(&model_, data_.get());
      for (int k = 0; k < model_.nu; ++k) data_->ctrl[k] = 0.05 + 0.04 * k;
      controls = list(data_->ctrl, model_.nu);
      const int steps = static_cast<int>(std::lround(1.0 / step));
      for (int i = 0; i < steps; ++i) mj_step(&model_, data_.get());
      mj_kinematics(&model_, data_.get());
      ends.push_back({{"xpos", list(data_->xpos + 3, 3 * (model_.nbody - 1))},
                      {"qpos", list(data_->qpos, model_.nq)},
                      {"act", list(data_->act, model_.na)}});
    }
    return {{"ctrl", controls}, {"ends", ends}};
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }

  mjModel& model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::mt19937 random_;
};

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fputs("usage: sheave_muscle_reference MODEL.xml POSES SEED\n", stderr);
    return 2;
  }
  std::array<char, 1000> error{};
  const std::unique_ptr<mjModel, ModelDeleter> model(
      mj_loadXML(words[1], nullptr, error.data(), static_cast<int>(error.size())));
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", words[1], error.data());
    return 1;
  }
  mju_user_warning = [](const char* text) { std::fprintf(stderr, "%s\n", text); };
  model->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS;
  MuscleReference reference(*model, static_cast<unsigned>(std::atoi(words[3])));
  Json json = {{"mujoco", mj_versionString()}};
  json["constants"] = reference.constants();
  if (std::atoi(words[2]) == 0) {
    std::puts(json.dump().c_str());
    return 0;
  }
  json["curves"] = reference.curves(200);
  json["activations"] = reference.activations(100);
  json["poses"] = reference.at_random_poses(std::atoi(words[2]));
  json["motion"] = reference.motion();
  std::puts(json.dump().c_str());
  return 0;
}
