// The two files of a robot.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "scenes/import/caspr/reader.h"
#include "scenes/import/file_within.h"
#include "scenes/import/mjcf/pose.h"
#include "scenes/scene_text.h"

namespace sheave::import::caspr {
namespace {

constexpr std::string_view bodies_end = "_bodies.xml";
constexpr std::string_view cables_end = "_cables.xml";

xml::Tree without(const std::string& file_name, std::string message) {
  xml::Tree tree;
  tree.fault = SceneError{file_name, 1, 1, {}, std::move(message), {}, {}, FaultCode::not_found};
  return tree;
}

}  // namespace

bool is_part(const xml::Element& root) {
  return root.tag == "bodies_system" || root.tag == "cables";
}

xml::Tree other_part(const xml::Element& root, const std::string& file_name, const Options& options,
                     const Limits& limits) {
  if (options.other_text) return xml::parse(*options.other_text, file_name, limits);
  const bool has_bodies = root.tag == "bodies_system";
  const std::string_view own = has_bodies ? bodies_end : cables_end;
  const std::string_view other = has_bodies ? cables_end : bodies_end;
  const std::string name = std::filesystem::path(file_name).filename().string();
  if (!name.ends_with(own) || limits.includes == 0) {
    return without(file_name,
                   fmt::format("a robot of CASPR has two files in one folder, NAME{} and "
                               "NAME{}; name this one so",
                               bodies_end, cables_end));
  }
  const std::string wanted = name.substr(0, name.size() - own.size()) + std::string(other);
  const auto path = path_within(folder_of(file_name), wanted);
  std::error_code code;
  if (!path || !std::filesystem::is_regular_file(*path, code)) {
    return without(file_name,
                   fmt::format("the robot's other file \"{}\" must be in the same folder", wanted));
  }
  const SceneText text = read_scene_text(path->string());
  if (!text.failure.errors.empty()) {
    return without(file_name,
                   fmt::format("\"{}\": {}", wanted, text.failure.errors.front().message));
  }
  return xml::parse(text.text, path->string(), limits);
}

mjcf::Model read_model(const xml::Element& first, const xml::Element& second, Log& log) {
  mjcf::Model model;
  model.format = "CASPR";
  model.file = *first.file;
  model.compiler.from_geoms = mjcf::FromGeoms::never;
  model.has_contacts = false;
  model.is_soft = false;
  model.option.timestep = 0.001;
  const xml::Element& bodies = first.tag == "bodies_system" ? first : second;
  const xml::Element& cables = first.tag == "bodies_system" ? second : first;
  if (bodies.tag != "bodies_system" || cables.tag != "cables") {
    log.error(second, "a robot needs a file with <bodies_system> and one with <cables>", {},
              FaultCode::meaning);
    return model;
  }
  mjcf::Body world;
  world.element = &bodies;
  world.name = "world";
  model.bodies.push_back(std::move(world));
  opensim::Properties properties(log);
  read_links(bodies, model, properties, log);
  if (log.failed()) return model;
  read_cables(cables, model, properties, log);
  if (log.failed()) return model;
  properties.note_unread(bodies);
  properties.note_unread(cables);
  return model;
}

}  // namespace sheave::import::caspr
