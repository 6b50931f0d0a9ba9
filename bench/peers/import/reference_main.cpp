// Writes the results of MuJoCo for a model, as references for the tests of imports:
//
//   sheave_import_reference MODEL.xml POSES SEED [armature] > references/NAME.json
//
// Masses, inertias and places at the reference pose; lengths of tendons, their derivatives and
// places of bodies at random poses; accelerations for random velocities; the motion of 1 s by
// Runge-Kutta steps of two sizes. Limits, contacts and friction do not act: they differ in meaning.
// Armature acts if the last word asks for it; as a part of the masses of bodies it would hide them.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

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

class Reference {
 public:
  Reference(const mjModel& model, unsigned seed)
      : model_(model), data_(mj_makeData(&model)), random_(seed) {}

  Json at_reference_pose() {
    mj_resetData(&model_, data_.get());
    mj_forward(&model_, data_.get());
    Json bodies = Json::array();
    for (int i = 1; i < model_.nbody; ++i) {
      // The inertia tensor about the centre of mass, world axes.
      const mjtNum* const turn = data_->ximat + 9 * i;
      const mjtNum* const moments = model_.body_inertia + 3 * i;
      std::array<double, 9> tensor{};
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          for (int k = 0; k < 3; ++k) {
            tensor[static_cast<std::size_t>(3 * r + c)] +=
                turn[3 * r + k] * moments[k] * turn[3 * c + k];
          }
        }
      }
      bodies.push_back({{"joints", model_.body_jntnum[i]},
                        {"parent", model_.body_parentid[i]},
                        {"mass", model_.body_mass[i]},
                        {"center", list(data_->xipos + 3 * i, 3)},
                        {"tensor", tensor}});
    }
    Json sites = Json::object();
    for (int i = 0; i < model_.nsite; ++i) {
      const char* const name = mj_id2name(&model_, mjOBJ_SITE, i);
      if (name != nullptr) sites[name] = list(data_->site_xpos + 3 * i, 3);
    }
    return {{"bodies", bodies}, {"sites", sites}};
  }

  Json at_random_poses(int count) {
    Json poses = Json::array();
    for (int i = 0; i < count; ++i) {
      mj_resetData(&model_, data_.get());
      draw();
      mj_forward(&model_, data_.get());
      Json pose = {{"qpos", list(data_->qpos, model_.nq)},
                   {"lengths", list(data_->ten_length, model_.ntendon)}};
      constexpr int detailed = 20;  // keeps the files small
      if (i < detailed) {
        pose["qvel"] = list(data_->qvel, model_.nv);
        pose["qacc"] = list(data_->qacc, model_.nv);
        pose["xpos"] = list(data_->xpos + 3, 3 * (model_.nbody - 1));
        pose["xquat"] = list(data_->xquat + 4, 4 * (model_.nbody - 1));
        Json arms = Json::array();
        for (int t = 0; t < model_.ntendon; ++t) arms.push_back(row(t));
        pose["moment_arms"] = std::move(arms);
      }
      poses.push_back(std::move(pose));
    }
    return poses;
  }

  /// The end of 1 s from the reference pose with small velocities.
  Json motion(mjModel& model) {
    Json ends = Json::array();
    mj_resetData(&model, data_.get());
    Json start = Json::array();
    for (int i = 0; i < model.nv; ++i) start.push_back(0.1 * (i + 1));
    for (const double step : {1e-3, 5e-4}) {
      model.opt.timestep = step;
      model.opt.integrator = mjINT_RK4;
      mj_resetData(&model, data_.get());
      for (int i = 0; i < model.nv; ++i) data_->qvel[i] = start[static_cast<std::size_t>(i)];
      for (int i = 0; i < static_cast<int>(std::lround(1.0 / step)); ++i) {
        mj_step(&model, data_.get());
      }
      mj_kinematics(&model, data_.get());
      ends.push_back({{"xpos", list(data_->xpos + 3, 3 * (model.nbody - 1))},
                      {"qpos", list(data_->qpos, model.nq)}});
    }
    return {{"qvel", start}, {"ends", ends}};
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }

  void draw() {
    for (int j = 0; j < model_.njnt; ++j) {
      mjtNum* const q = data_->qpos + model_.jnt_qposadr[j];
      const int type = model_.jnt_type[j];
      if (type == mjJNT_FREE) {
        for (int i = 0; i < 3; ++i) q[i] += uniform(-0.05, 0.05);
      } else if (type == mjJNT_BALL) {
        for (int i = 0; i < 4; ++i) q[i] += uniform(-0.3, 0.3);
        mju_normalize4(q);
      } else {
        const bool limited = model_.jnt_limited[j] != 0;
        const double wide = type == mjJNT_SLIDE ? 0.02 : 0.6;
        q[0] = limited ? uniform(model_.jnt_range[2 * j], model_.jnt_range[2 * j + 1])
                       : q[0] + uniform(-wide, wide);
      }
    }
    for (int i = 0; i < model_.nv; ++i) data_->qvel[i] = uniform(-1.0, 1.0);
  }

  Json row(int tendon) const {
    std::vector<double> dense(static_cast<std::size_t>(model_.nv), 0.0);
    if (mj_isSparse(&model_) != 0) {
      const int at = data_->ten_J_rowadr[tendon];
      for (int k = 0; k < data_->ten_J_rownnz[tendon]; ++k) {
        dense[static_cast<std::size_t>(data_->ten_J_colind[at + k])] = data_->ten_J[at + k];
      }
    } else {
      for (int k = 0; k < model_.nv; ++k) {
        dense[static_cast<std::size_t>(k)] = data_->ten_J[tendon * model_.nv + k];
      }
    }
    return dense;
  }

  const mjModel& model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::mt19937 random_;
};

}  // namespace

int main(int count, char** words) {
  const bool armature = count == 5 && std::string(words[4]) == "armature";
  if (count != 4 && !armature) {
    std::fputs("usage: sheave_import_reference MODEL.xml POSES SEED [armature]\n", stderr);
    return 2;
  }
  std::array<char, 1000> error{};
  const std::unique_ptr<mjModel, ModelDeleter> model(
      mj_loadXML(words[1], nullptr, error.data(), static_cast<int>(error.size())));
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", words[1], error.data());
    return 1;
  }
  // Standard output is for the references; a motion that diverges has numbers that are null.
  mju_user_warning = [](const char* text) { std::fprintf(stderr, "%s\n", text); };
  model->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS;
  if (!armature) mju_zero(model->dof_armature, model->nv);
  mj_setConst(model.get(), std::unique_ptr<mjData, DataDeleter>(mj_makeData(model.get())).get());
  // Muscles have references of their own: muscle_main.cpp.
  for (int i = 0; i < model->nu; ++i) {
    if (model->actuator_dyntype[i] != mjDYN_NONE) model->opt.disableflags |= mjDSBL_ACTUATION;
  }
  Reference reference(*model, static_cast<unsigned>(std::atoi(words[3])));
  Json json = {{"mujoco", mj_versionString()}, {"reference", reference.at_reference_pose()}};
  json["poses"] = reference.at_random_poses(std::atoi(words[2]));
  json["motion"] = reference.motion(*model);
  std::puts(json.dump().c_str());
  return 0;
}
