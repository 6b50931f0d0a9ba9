#include "scenes/placement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/format_tables.h"

namespace sheave {

using json::no_node;
using json::NodeId;

std::span<const Field> RotationDef::field_table() {
  static const std::array table{
      field<&RotationDef::axis>("axis", "", any_number(), optional,
                                "of the turn, of any length but 0"),
      field<&RotationDef::degrees>("degrees", "", any_number(), required,
                                   "by how much, counter-clockwise seen against the axis"),
  };
  return table;
}

std::span<const Field> BodyPlacementDef::field_table() {
  static const std::array table{
      field<&BodyPlacementDef::relative_to>(
          "relative_to", "", {}, optional,
          "the body whose frame position, orientation (or rotation) and axis refer to; in scene "
          "files"),
  };
  return table;
}

std::span<const Field> JointPlacementDef::field_table() {
  static const std::array table{
      field<&JointPlacementDef::relative_to>(
          "relative_to", "", {}, optional,
          "the body whose frame at time 0 the points and directions below refer to; in scene "
          "files"),
  };
  return table;
}

const ObjectFormat& rotation_format() {
  static const ObjectFormat format{
      "rotation", "a turn about an axis, in degrees", false, {table_of<RotationDef>()}, {}, {}, {}};
  return format;
}

std::optional<Quaternion> read_rotation(const json::Document& document, FieldReader& reader,
                                        NodeId object) {
  const NodeId node = document.member(object, "rotation");
  if (node == no_node) return {};
  RotationDef rotation;
  const std::array<void*, 1> objects{&rotation};
  if (!reader.read_object(node, rotation_format(), objects)) return {};
  const double length = rotation.axis.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    reader.fail(document.member(node, "axis"), FaultCode::out_of_range,
                "an axis must not be of length 0", "a direction");
    return {};
  }
  const double half = 0.5 * rotation.degrees * pi / 180.0;
  const Vector3 vector = std::sin(half) / length * rotation.axis;
  return Quaternion(std::cos(half), vector.x(), vector.y(), vector.z());
}

namespace {

/// Transforms a body from the frame of its base to the frame of that base's own placement.
void place(const json::Document& document, NodeId node, const BodyDef& base, BodyDef& body) {
  body.position = base.position + base.orientation * body.position;
  body.orientation = (base.orientation * body.orientation).normalized();
  if (document.member(node, "axis") != no_node && body.axis) {
    body.axis = base.orientation * *body.axis;
  }
}

}  // namespace

void PlacementResolver::place_bodies(std::span<const NodeId> nodes,
                                     std::span<const std::optional<BodyId>> relative_to,
                                     std::vector<BodyDef>& bodies) {
  enum class Mark : std::uint8_t { open, on_the_way, placed };
  std::vector<Mark> marks(bodies.size(), Mark::open);
  const auto base_of = [&](std::size_t i) -> std::optional<std::size_t> {
    const std::optional<BodyId> base = relative_to[i];
    if (!base || base->index < 0) return {};
    return static_cast<std::size_t>(base->index);
  };
  std::vector<std::size_t> way;
  for (std::size_t first = 0; first < bodies.size(); ++first) {
    way.clear();
    std::size_t i = first;
    while (marks[i] == Mark::open) {
      marks[i] = Mark::on_the_way;
      way.push_back(i);
      const std::optional<std::size_t> base = base_of(i);
      if (!base) break;
      i = *base;
      if (marks[i] != Mark::on_the_way) continue;
      std::string circle;
      for (auto at = std::find(way.begin(), way.end(), i); at != way.end(); ++at) {
        circle += fmt::format("\"{}\" to ", bodies[*at].name);
      }
      reader_.fail(document_.member(nodes[way.back()], "relative_to"), FaultCode::meaning,
                   fmt::format("bodies are relative to each other in a circle: {}\"{}\"", circle,
                               bodies[i].name));
      break;
    }
    // The base is placed before the bodies relative to it.
    for (auto at = way.rbegin(); at != way.rend(); ++at) {
      if (const auto base = base_of(*at)) place(document_, nodes[*at], bodies[*base], bodies[*at]);
      marks[*at] = Mark::placed;
    }
  }
}

void PlacementResolver::place_joint(const json::Document& document, NodeId node,
                                    const BodyDef& base, std::span<const Field> fields,
                                    void* settings) {
  const auto placed = [&](const Field& field, const Vector3& value) -> Vector3 {
    const Vector3 turned = base.orientation * value;
    return field.unit == "m" ? Vector3(base.position + turned) : turned;
  };
  for (const Field& field : fields) {
    if (document.member(node, field.name) == no_node) continue;
    const FieldSlot slot = field.slot(settings);
    if (Vector3* const* vector = std::get_if<Vector3*>(&slot)) {
      **vector = placed(field, **vector);
    } else if (auto* const* optional_vector = std::get_if<std::optional<Vector3>*>(&slot)) {
      if (**optional_vector) **optional_vector = placed(field, ***optional_vector);
    }
  }
}

}  // namespace sheave
