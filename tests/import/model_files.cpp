#include "tests/import/model_files.h"

#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"
#include "scenes/import/xml.h"

namespace sheave::test {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string joined(const std::vector<double>& list) {
  std::string text;
  for (const double number : list) text += fmt::format("{:.17g} ", number);
  return text;
}

std::string at_end(std::string text, const std::string& more) {
  const std::size_t end = text.rfind("</mujoco>");
  if (end == std::string::npos) throw std::runtime_error("no </mujoco>");
  return text.insert(end, more);
}

void require(const std::vector<SceneError>& errors) {
  std::string all;
  for (const SceneError& error : errors) all += to_string(error) + "\n";
  if (!all.empty()) throw std::runtime_error(all);
}

}  // namespace

std::string model_path(const std::string& name) {
  return SHEAVE_SOURCE_DIR "/tests/import/models/" + name;
}

std::string plain_model(const std::string& name) {
  const std::string text = file_text(model_path(name + ".xml"));
  const bool whole = name == "couplings";  // its references have armature
  // References of models with muscles are those without actuators, but for "muscles".
  const bool rests = name != "muscles" && text.find("<muscle ") != std::string::npos;
  return at_end(whole ? text : std::regex_replace(text, std::regex("armature=\"[^\"]*\""), ""),
                fmt::format("<option><flag limit=\"disable\" frictionloss=\"disable\"{}/></option>",
                            rests ? " actuation=\"disable\"" : ""));
}

nlohmann::json references(const std::string& name) {
  return nlohmann::json::parse(
      file_text(SHEAVE_SOURCE_DIR "/tests/import/references/" + name + ".json"));
}

std::string with_keyframe(const std::string& text, const std::vector<double>& qpos,
                          const std::vector<double>& qvel) {
  std::string key = "<keyframe><key name=\"test\" qpos=\"" + joined(qpos) + "\"";
  if (!qvel.empty()) key += " qvel=\"" + joined(qvel) + "\"";
  return at_end(text, key + "/></keyframe>");
}

Scene scene_in_keyframe(const std::string& text, const std::string& name) {
  import::Options options;
  options.keyframe = "test";
  const import::Outcome made = import::import_model(text, model_path(name + ".xml"), options);
  require(made.errors);
  SceneResult scene = load_scene_text(made.json, name);
  require(scene.errors);
  return std::move(*scene.scene);
}

struct ReadModel::Content {
  import::xml::Tree tree;
  import::Log log{import::Limits{}};
  import::mjcf::Model model;
};

ReadModel::ReadModel(const std::string& text) : content_(std::make_unique<Content>()) {
  if (!import::is_available()) return;  // the tests are skipped
  content_->tree = import::xml::parse(text, model_path("text.xml"), {});
  if (content_->tree.fault) require({*content_->tree.fault});
  content_->model = import::mjcf::read_model(*content_->tree.root, content_->log);
  require(content_->log.take().errors);
}
ReadModel::~ReadModel() = default;

const import::mjcf::Model& ReadModel::operator*() const { return content_->model; }

std::vector<double> numbers(const nlohmann::json& list) { return list.get<std::vector<double>>(); }

Vector3 vector_at(const nlohmann::json& list, std::size_t first) {
  return {list[first].get<double>(), list[first + 1].get<double>(), list[first + 2].get<double>()};
}

void move_on(const import::mjcf::Model& model, double time,
             const std::vector<double>& accelerations, std::vector<double>& positions,
             std::vector<double>& velocities) {
  using import::mjcf::JointType;
  for (const import::mjcf::Joint& joint : model.joints) {
    double* q = &positions[static_cast<std::size_t>(joint.qpos)];
    const auto first = static_cast<std::size_t>(joint.qvel);
    const auto way = [&](std::size_t i) {
      return time * velocities[first + i] + 0.5 * time * time * accelerations[first + i];
    };
    std::size_t turning = 0;
    if (joint.type == JointType::free) {
      for (std::size_t i = 0; i < 3; ++i) *q++ += way(i);
      turning = 3;
    }
    if (joint.type == JointType::hinge || joint.type == JointType::slide) {
      *q += way(0);
      continue;
    }
    const Vector3 turn(way(turning), way(turning + 1), way(turning + 2));
    Quaternion now(q[0], q[1], q[2], q[3]);
    if (turn.norm() > 0.0) now = now * import::mjcf::turn_about(turn, turn.norm());
    q[0] = now.w();
    q[1] = now.x();
    q[2] = now.y();
    q[3] = now.z();
  }
  for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] += time * accelerations[i];
}

}  // namespace sheave::test
