#include "scenes/part_reader.h"

#include <utility>

namespace sheave {

using json::no_node;
using json::NodeId;

void PartReader::read_shape(NodeId node, std::vector<PlacedShape>& shapes) {
  PlacedShape placed;
  placed.shape = read_typed(node, shape_format(), shape_types(), [&](Shape&) { return &placed; });
  if (document_.kind(node) == json::Kind::object) {
    if (const auto turn = read_rotation(document_, fields_, node)) placed.orientation = *turn;
  }
  if (placed.shape) shapes.push_back(std::move(placed));
}

bool PartReader::read_shapes(NodeId node, std::vector<PlacedShape>& shapes) {
  const NodeId single = document_.member(node, "shape");
  if (single != no_node) read_shape(single, shapes);
  for (const NodeId shape : fields_.list(node, *body_format().member("shapes"))) {
    read_shape(shape, shapes);
  }
  return single != no_node || document_.member(node, "shapes") != no_node;
}

void PartReader::refuse_relative(NodeId node) {
  const NodeId given = document_.member(node, "relative_to");
  if (given == no_node) return;
  fields_.fail(
      given, FaultCode::meaning,
      "places are relative to a body in scene files only; here they are those of the world",
      "a place in the world's frame");
}

BodyDef PartReader::read_body(NodeId node, BodyPlacementDef* placement) {
  BodyDef body;
  BodyPlacementDef own;
  const std::array<void*, 2> objects{&body, &own};
  if (!fields_.read_object(node, body_format(), objects)) return body;
  read_shapes(node, body.shapes);
  if (const auto turn = read_rotation(document_, fields_, node)) body.orientation = *turn;
  if (placement != nullptr) {
    *placement = own;
  } else {
    refuse_relative(node);
  }
  return body;
}

std::shared_ptr<JointDef> PartReader::read_joint(NodeId node, const std::vector<BodyDef>* bodies) {
  const Variant* variant = fields_.read_type(node, joint_format());
  if (variant == nullptr) return nullptr;
  const std::span<const TypeEntry<JointDef>> types = joint_types();
  const auto entry = std::find_if(types.begin(), types.end(), [&](const TypeEntry<JointDef>& type) {
    return type.name == variant->name;
  });
  std::shared_ptr<JointDef> joint = entry->make();
  JointPlacementDef placement;
  const std::array<void*, 2> shared{joint.get(), &placement};
  fields_.read_object(node, joint_format(), shared, variant, settings_of(*joint));
  if (bodies == nullptr) {
    refuse_relative(node);
  } else if (placement.relative_to && !placement.relative_to->is_world()) {
    const auto base = static_cast<std::size_t>(placement.relative_to->index);
    if (base < bodies->size()) {
      PlacementResolver::place_joint(document_, node, (*bodies)[base], variant->table.fields,
                                     settings_of(*joint));
    }
  }
  return joint;
}

void PartReader::refuse_empty_tables(NodeId node) {
  // A table without points would count as none, and the rope as rigid.
  for (const std::string_view key : {"strain_table", "tension_table", "unloading_table"}) {
    const NodeId table = document_.member(node, key);
    if (table == no_node || document_.kind(table) != json::Kind::array) continue;
    if (!document_.children(table).empty()) continue;
    fields_.fail(table, FaultCode::out_of_range,
                 "a table has at least 2 points, and this one has none; give its points, or leave "
                 "it out");
  }
}

CableDef PartReader::read_cable(NodeId node) {
  CableDef cable;
  const std::array<void*, 1> objects{&cable};
  if (!fields_.read_object(node, cable_format(), objects)) return cable;
  refuse_empty_tables(node);
  for (const NodeId child : fields_.list(node, *cable_format().member("links"))) {
    if (auto link = read_link(child)) cable.links.push_back(std::move(link));
  }
  return cable;
}

std::shared_ptr<LinkDef> PartReader::read_link(NodeId node) {
  return read_typed(node, link_format(), link_types(), [](LinkDef& common) { return &common; });
}

ColliderDef PartReader::read_collider(NodeId node) {
  ColliderDef collider;
  const std::array<void*, 1> objects{&collider};
  fields_.read_object(node, collider_format(), objects);
  return collider;
}

std::string pointer_in_text(const json::Document& document, const std::string& path) {
  if (document.find(path).exact) return path;
  for (const auto& [ours, other] : {std::pair<std::string, std::string>{"/shape", "/shapes/0"},
                                    std::pair<std::string, std::string>{"/shapes/0", "/shape"}}) {
    const std::size_t at = path.find(ours);
    if (at == std::string::npos) continue;
    const std::size_t end = at + ours.size();
    if (end < path.size() && path[end] != '/') continue;  // "/shape" is not a prefix of "/shapes/1"
    const std::string replaced = path.substr(0, at) + other + path.substr(end);
    const std::string shape = path.substr(0, at) + other;
    if (document.find(shape).exact) return replaced;
  }
  return path;
}

}  // namespace sheave
