#include "scenes/part_reader.h"

#include <utility>

namespace sheave {

using json::no_node;
using json::NodeId;

void PartReader::read_shape(NodeId node, std::vector<PlacedShape>& shapes) {
  PlacedShape placed;
  placed.shape = read_typed(node, shape_format(), shape_types(), [&](Shape&) { return &placed; });
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

BodyDef PartReader::read_body(NodeId node) {
  BodyDef body;
  const std::array<void*, 1> objects{&body};
  if (fields_.read_object(node, body_format(), objects)) read_shapes(node, body.shapes);
  return body;
}

std::shared_ptr<JointDef> PartReader::read_joint(NodeId node) {
  return read_typed(node, joint_format(), joint_types(), [](JointDef& common) { return &common; });
}

CableDef PartReader::read_cable(NodeId node) {
  CableDef cable;
  const std::array<void*, 1> objects{&cable};
  if (!fields_.read_object(node, cable_format(), objects)) return cable;
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
    if (end < path.size() && path[end] != '/') continue;  // "/shape" is no part of "/shapes/1"
    const std::string replaced = path.substr(0, at) + other + path.substr(end);
    const std::string shape = path.substr(0, at) + other;
    if (document.find(shape).exact) return replaced;
  }
  return path;
}

}  // namespace sheave
