#include "tests/property/shrink.h"

#include <exception>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/scene.h"

namespace sheave::test {
namespace {

using ShrinkJson = nlohmann::ordered_json;
using Pointer = ShrinkJson::json_pointer;

/// Places of all that could be left out, the largest things first: elements of lists of objects,
/// then single settings.
void collect_parts(const ShrinkJson& json, const Pointer& at, std::vector<Pointer>& lists,
                   std::vector<Pointer>& settings) {
  if (at.to_string() == "/step") return;
  if (json.is_array()) {
    for (std::size_t i = json.size(); i-- > 0;) {
      if (!json[i].is_object()) return;
      lists.push_back(at / i);
      collect_parts(json[i], at / i, lists, settings);
    }
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      const bool list = value.is_array() && !value.empty() && value[0].is_object();
      if (!list && key != "step") settings.push_back(at / key);
      if (list || value.is_object()) collect_parts(value, at / key, lists, settings);
    }
  }
}

ShrinkJson without(const ShrinkJson& json, const Pointer& part) {
  ShrinkJson less = json;
  ShrinkJson& parent = less[part.parent_pointer()];
  if (parent.is_array()) {
    parent.erase(static_cast<std::size_t>(std::stoul(part.back())));
  } else {
    parent.erase(part.back());
  }
  return less;
}

}  // namespace

std::string scene_of(const Machine& machine, const std::string& description) {
  Scene scene;
  scene.description = description;
  scene.duration = 100.0 * machine.model.step.dt;
  scene.model = machine.model;
  scene.cables = machine.cables;
  return write_scene(scene);
}

Machine shrunk(const Machine& machine, const std::function<bool(const Machine&)>& fails,
               int tries) {
  Machine smallest = machine;
  ShrinkJson json = ShrinkJson::parse(scene_of(machine));
  const auto try_without = [&](const Pointer& part) {
    ShrinkJson less = without(json, part);
    const SceneResult scene = load_scene_text(less.dump(), "shrunk");
    if (!scene) return false;
    --tries;
    const Machine smaller{scene->model, scene->cables};
    try {
      if (!fails(smaller)) return false;
    } catch (const std::exception&) {
      return false;
    }
    json = std::move(less);
    smallest = smaller;
    return true;
  };
  for (bool smaller = true; smaller && tries > 0;) {
    smaller = false;
    std::vector<Pointer> parts;
    std::vector<Pointer> settings;
    collect_parts(json, Pointer(), parts, settings);
    parts.insert(parts.end(), settings.begin(), settings.end());
    for (const Pointer& part : parts) {
      // Places behind one that has gone are others now.
      if (tries <= 0 || !json.contains(part)) continue;
      smaller = try_without(part) || smaller;
    }
  }
  return smallest;
}

}  // namespace sheave::test
