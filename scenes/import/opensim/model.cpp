// <OpenSimDocument>: the sections of a model, in an order in which names are known before they are
// used, and the tree of its bodies.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/attributes.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr double least_version = 20000;
constexpr double newest_version = 49999;

/// The <Model> of a document; null with an error if there is none.
const xml::Element* model_of(const xml::Element& root, Properties& properties, Log& log) {
  const std::string* const text = root.value("Version");
  const auto version =
      text == nullptr ? std::optional<std::vector<double>>() : parse_numbers(*text, 1);
  const bool known = version && version->size() == 1 && version->front() >= least_version &&
                     version->front() <= newest_version;
  if (!known) {
    log.error(root,
              "Version must be a number from 20000 to 49999; save the model in OpenSim 3 or 4",
              text == nullptr ? "" : *text, FaultCode::meaning);
    return nullptr;
  }
  const xml::Element* const model = properties.child(root, "Model");
  if (model == nullptr) {
    log.error(root, "<Model> is missing", {}, FaultCode::missing_key);
    return nullptr;
  }
  if (const xml::Element* defaults = properties.child(*model, "defaults")) {
    properties.set_defaults(*defaults);
  }
  return model;
}

void read_units(Reader& reader) {
  const auto check = [&](const char* tag, std::initializer_list<std::string_view> words) {
    const xml::Element* const unit = reader.properties.child(reader.root, tag);
    if (unit == nullptr || unit->text.empty()) return;
    for (const std::string_view word : words) {
      if (unit->text == word) return;
    }
    if (unit->text == "Unassigned") {
      reader.log.changed(*unit, fmt::format("taken as {}", *words.begin()));
      return;
    }
    reader.log.error(*unit,
                     fmt::format("must be \"{}\": other units are not known here", *words.begin()),
                     unit->text, FaultCode::unknown_choice);
  };
  check("length_units", {"meters", "m", "meter"});
  check("force_units", {"N", "Newtons", "newtons"});
  if (const auto gravity = reader.properties.vector(reader.root, "gravity")) {
    reader.model.option.gravity = *gravity;
  } else {
    reader.model.option.gravity = {0.0, -9.80665, 0.0};
  }
}

/// Adds the bodies from ground on, each behind its parent.
void grow(Reader& reader) {
  std::vector<std::vector<int>> below(reader.bodies.size());
  std::vector<int> joint_of(reader.bodies.size(), -1);
  for (std::size_t j = 0; j < reader.joints.size(); ++j) {
    const RawJoint& joint = reader.joints[j];
    if (joint.child.body == 0 || joint_of[at(joint.child.body)] >= 0) {
      reader.log.error(
          *joint.element,
          fmt::format("\"{}\" is ground or has another parent; joints form a tree, and "
                      "a constraint closes a loop",
                      reader.bodies[at(joint.child.body)].name),
          {}, FaultCode::meaning);
      return;
    }
    joint_of[at(joint.child.body)] = static_cast<int>(j);
    below[at(joint.parent.body)].push_back(joint.child.body);
  }
  for (std::size_t i = 1; i < reader.bodies.size(); ++i) {
    if (joint_of[i] < 0) below[0].push_back(static_cast<int>(i));
  }
  std::vector<int> next(below[0].rbegin(), below[0].rend());
  std::size_t added = 1;
  while (!next.empty() && !reader.log.failed()) {
    const int body = next.back();
    next.pop_back();
    const int joint = joint_of[at(body)];
    add_body(body, joint < 0 ? nullptr : &reader.joints[at(joint)], reader);
    ++added;
    next.insert(next.end(), below[at(body)].rbegin(), below[at(body)].rend());
  }
  if (added == reader.bodies.size() || reader.log.failed()) return;
  reader.log.error(reader.root, "some joints form a loop; joints form a tree from ground", {},
                   FaultCode::meaning);
}

/// A body without joints is a part of its parent.
void set_carriers(Reader& reader) {
  const std::vector<mjcf::Body>& bodies = reader.model.bodies;
  reader.carriers.assign(bodies.size(), 0);
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    reader.carriers[i] =
        bodies[i].joints.empty() ? reader.carriers[at(bodies[i].parent)] : static_cast<int>(i);
  }
}

void set_start(Reader& reader) {
  std::vector<double> values;
  for (const Coordinate& one : reader.coordinates) values.push_back(one.start);
  reader.model.start_positions = positions_at(values, reader);
}

void note_wraps(const Reader& reader) {
  for (const auto& [name, wrap] : reader.wraps) {
    if (!wrap.active) reader.log.changed(*wrap.element, "not active: no path wraps over it");
  }
}

void fill(Reader& reader) {
  find_frames(reader);
  read_bodies(reader);
  if (!reader.log.failed()) read_joints(reader);
  mjcf::Body world;
  world.element = reader.bodies.front().element;
  world.name = "world";
  reader.model.bodies.push_back(std::move(world));
  reader.start_frames.emplace_back();
  if (!reader.log.failed()) read_couplers(reader);
  if (!reader.log.failed()) grow(reader);
  if (!reader.log.failed()) read_moving_points(reader);
  if (!reader.log.failed()) finish_joints(reader);
  if (reader.log.failed()) return;
  set_carriers(reader);
  read_wraps(reader);
  if (reader.log.failed()) return;
  read_constraints(reader);
  read_forces(reader);
  set_start(reader);
  note_wraps(reader);
}

}  // namespace

mjcf::Model read_model(const xml::Element& root, Log& log) {
  mjcf::Model model;
  model.format = "OpenSim";
  model.file = *root.file;
  model.compiler.from_geoms = mjcf::FromGeoms::never;
  model.has_contacts = false;
  model.is_soft = false;
  model.option.timestep = 0.001;
  Properties properties(log);
  const xml::Element* const element = model_of(root, properties, log);
  if (element == nullptr) return model;
  if (const std::string* name = element->value("name")) model.name = *name;
  Reader reader{*element, model, properties, log};
  read_units(reader);
  fill(reader);
  if (!log.failed()) properties.note_unread(*element);
  return model;
}

}  // namespace sheave::import::opensim
