// The root of a model: its sections in an order in which names are known before they are used.

#include <fmt/format.h>

#include "scenes/import/mjcf/muscle_range.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

template <class Visit>
void each(const xml::Element& root, std::string_view tag, Visit visit) {
  for (const xml::Element& child : root.children) {
    if (child.tag == tag) visit(child);
  }
}

void note_other_sections(const xml::Element& root, Log& log) {
  for (const xml::Element& child : root.children) {
    const std::string& tag = child.tag;
    if (tag == "asset") {
      for (const xml::Element& part : child.children) {
        if (part.tag == "mesh") continue;
        log.skipped(part, part.tag == "hfield" ? "a scene has no fields of heights"
                                               : "looks have no counterpart");
      }
    } else if (tag == "contact" || tag == "sensor" || tag == "deformable" || tag == "extension") {
      for (const xml::Element& part : child.children) {
        log.skipped(part, tag == "sensor" ? "observables of a scene need no declaration"
                                          : "it has no counterpart");
      }
    } else if (tag == "visual" || tag == "statistic" || tag == "size" || tag == "custom") {
      log.skipped(child, "it concerns MuJoCo's own memory and pictures");
    } else if (tag != "compiler" && tag != "option" && tag != "default" && tag != "worldbody" &&
               tag != "tendon" && tag != "actuator" && tag != "equality" && tag != "keyframe") {
      log.skipped(child, "no section that is known here");
    }
  }
}

}  // namespace

Model read_model(const xml::Element& root, Log& log, const std::string& folder) {
  Model model;
  model.folder = folder;
  if (const std::string* name = root.value("model")) model.name = *name;
  model.file = *root.file;
  Defaults defaults;
  Reader reader{model, defaults, log, {}};
  each(root, "compiler", [&](const auto& e) { read_compiler(e, model.compiler, log); });
  each(root, "option", [&](const auto& e) { read_option(e, model.option, log); });
  each(root, "default", [&](const auto& e) { defaults.read(e, log); });
  std::size_t bytes = most_mesh_bytes;
  each(root, "asset", [&](const auto& e) { read_meshes(e, bytes, reader); });
  each(root, "worldbody", [&](const auto& e) { read_bodies(e, reader); });
  if (model.bodies.empty()) {
    log.error(root, "there is no <worldbody>", {}, FaultCode::missing_key);
    return model;
  }
  each(root, "tendon", [&](const auto& e) { read_tendons(e, reader); });
  each(root, "actuator", [&](const auto& e) { read_actuators(e, reader); });
  each(root, "equality", [&](const auto& e) { read_equalities(e, reader); });
  each(root, "keyframe", [&](const auto& e) { read_keyframes(e, reader); });
  note_other_sections(root, log);
  find_masses(model, log);
  if (!log.failed()) complete_muscles(model, log);
  return model;
}

}  // namespace sheave::import::mjcf
