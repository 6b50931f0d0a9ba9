#include "tests/import/opensim_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "cable/links/surface.h"
#include "tests/import/model_files.h"

namespace sheave::test {

std::string opensim_text(const std::string& name) {
  std::ifstream file(model_path(name), std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string with_coordinates(std::string text, const std::map<std::string, double>& values) {
  for (const auto& [name, value] : values) {
    const std::string begin = "<default_value>";
    std::size_t at = text.find("<Coordinate name=\"" + name + "\"");
    at = at == std::string::npos ? at : text.find(begin, at);
    if (at == std::string::npos) throw std::runtime_error("no coordinate " + name);
    at += begin.size();
    text.replace(at, text.find("</default_value>", at) - at, fmt::format("{:.17g}", value));
  }
  return text;
}

Scene opensim_scene(const std::string& text) {
  const import::Outcome made = import::import_model(text, "model.osim");
  if (!made.errors.empty()) throw std::runtime_error(to_string(made.errors.front()));
  SceneResult scene = load_scene_text(made.json, "made.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

bool touches_surface(const CableDef& cable) {
  return std::any_of(cable.links.begin(), cable.links.end(), [](const auto& link) {
    return link->type() == SurfaceLink::type_name && !static_cast<const SurfaceLink&>(*link).lifted;
  });
}

std::string opensim_document(const std::string& sections) {
  return "<OpenSimDocument Version=\"40000\"><Model name=\"m\">\n" + sections +
         "\n</Model></OpenSimDocument>\n";
}

std::string opensim_body(const std::string& name) {
  return "<Body name=\"" + name +
         "\"><mass>1</mass><mass_center>0 -0.2 0</mass_center>"
         "<inertia>0.01 0.01 0.01 0 0 0</inertia></Body>\n";
}

std::string opensim_joint(const std::string& type, const std::string& name,
                          const std::string& child, const std::vector<std::string>& coordinates,
                          const std::string& more) {
  std::string text = "<" + type + " name=\"" + name + "\"><socket_parent_frame>/ground" +
                     "</socket_parent_frame><socket_child_frame>/bodyset/" + child +
                     "</socket_child_frame><coordinates>";
  for (const std::string& one : coordinates) {
    text += "<Coordinate name=\"" + one +
            "\"><default_value>0</default_value><range>-1 1</range></Coordinate>\n";
  }
  return text + "</coordinates>" + more + "</" + type + ">\n";
}

std::string opensim_axis(const std::string& name, const std::string& coordinate,
                         const std::string& axis, const std::string& function) {
  return "<TransformAxis name=\"" + name + "\"><coordinates>" + coordinate +
         "</coordinates><axis>" + axis + "</axis><function>" + function +
         "</function></TransformAxis>\n";
}

}  // namespace sheave::test
