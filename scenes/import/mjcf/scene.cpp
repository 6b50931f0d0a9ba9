// The scene as a whole: start, step, and the order of its parts.

#include "scenes/import/mjcf/scene.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "scenes/import/mjcf/joint_kind.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// The keyframe that the options name; null without a name, or with an error.
const Keyframe* chosen_keyframe(const Model& model, const Options& options, Log& log) {
  if (options.keyframe.empty()) return nullptr;
  std::string known;
  for (std::size_t i = 0; i < model.keyframes.size(); ++i) {
    const Keyframe& key = model.keyframes[i];
    if (key.name == options.keyframe || std::to_string(i) == options.keyframe) return &key;
    constexpr std::size_t most = 10;
    if (i < most) known += (i == 0 ? "" : ", ") + (key.name.empty() ? std::to_string(i) : key.name);
  }
  const std::string allowed = known.empty() ? "the model has none" : "the model has " + known;
  log.error(*model.bodies.front().element,
            fmt::format("there is no keyframe \"{}\"; {}", options.keyframe, allowed), {},
            FaultCode::meaning);
  return nullptr;
}

void set_start(const Keyframe* key, Writer& writer) {
  const Model& model = writer.model;
  std::vector<double> positions =
      model.start_positions.empty() ? writer.reference.positions : model.start_positions;
  writer.controls.assign(model.actuators.size(), 0.0);
  writer.activations.assign(model.actuators.size(), 0.0);
  if (key != nullptr) {
    if (!key->positions.empty()) positions = key->positions;
    if (!key->controls.empty()) writer.controls = key->controls;
    writer.velocities = key->velocities;
    writer.log.same(*key->element, "the scene starts in it");
  }
  for (const Keyframe& other : model.keyframes) {
    if (&other != key) writer.log.skipped(*other.element, "--key chooses it as the start");
  }
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const int activation = model.actuators[i].activation;
    if (model.actuators[i].muscle) writer.activations[i] = model.actuators[i].muscle->activation;
    if (key != nullptr && activation >= 0 && !key->activations.empty()) {
      writer.activations[i] = key->activations[static_cast<std::size_t>(activation)];
    }
    const auto& range = model.actuators[i].control_range;
    if (range) writer.controls[i] = std::clamp(writer.controls[i], (*range)[0], (*range)[1]);
  }
  writer.start = pose_of(model, std::move(positions), writer.velocities);
}

}  // namespace

Json json_of(const Vector3& vector) { return {vector.x(), vector.y(), vector.z()}; }
Json json_of(const Quaternion& o) { return {o.w(), o.x(), o.y(), o.z()}; }

std::string Names::take(const std::string& wanted, const std::string& otherwise) {
  constexpr std::size_t longest = 100;  // a number may follow
  std::string name = (wanted.empty() ? otherwise : wanted).substr(0, longest);
  for (char& c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && (c < '0' || c > '9') && c != '_' && c != '-' && c != ' ') c = '_';
  }
  if (!name.empty() && name.front() == ' ') name.front() = '_';
  if (!name.empty() && name.back() == ' ') name.back() = '_';
  std::string unique = name;
  if (taken_.insert(unique).second) return unique;
  int& number = last_.emplace(name, 1).first->second;
  do {
    unique = fmt::format("{} {}", name, ++number);
  } while (!taken_.insert(unique).second);
  return unique;
}

Json scene_of(Model model, const Options& options, const std::string& file_name, Log& log) {
  split_joints(model, log);
  Writer writer{model, log, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  writer.reference = pose_of(model, reference_positions(model), {});
  const Keyframe* const key = chosen_keyframe(model, options, log);
  if (log.failed()) return {};
  set_start(key, writer);
  const std::string file = std::filesystem::path(file_name).filename().string();
  writer.scene = {
      {"format", "sheave-scene/1"},
      {"name", model.name.empty() ? file : model.name},
      {"description", fmt::format("Made by `sheave import` from {} ({}).", file, model.format)},
      {"gravity", json_of(model.option.gravity)},
      {"duration", 1.0},
      {"start", "pose"},
      {"step", {{"dt", model.option.timestep}, {"substeps", 1}}}};
  merge_bodies(writer);
  find_drives(writer);
  write_bodies(writer);
  write_joints(writer);
  write_equalities(writer);
  write_couplings(writer);
  write_cables(writer);
  return std::move(writer.scene);
}

}  // namespace sheave::import::mjcf
