#include "view/machine_json.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "engine/joint.h"

namespace sheave::view {
namespace {

Json json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Json json(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
int json(BodyId body) { return body.is_world() ? -1 : body.index; }

Json json(const render::BoxShape& s) { return {{"type", "box"}, {"size", json(s.size)}}; }
Json json(const render::SphereShape& s) { return {{"type", "sphere"}, {"radius", s.radius}}; }
Json json(const render::CylinderShape& s) {
  return {{"type", "cylinder"}, {"radius", s.radius}, {"length", s.length}};
}
Json json(const render::CapsuleShape& s) {
  return {{"type", "capsule"}, {"radius", s.radius}, {"length", s.length}};
}
Json json(const render::SheaveShape& s) {
  return {{"type", "sheave"},
          {"radius", s.radius},
          {"length", s.length},
          {"cable_radius", s.cable_radius},
          {"groove_width", s.groove_width},
          {"spokes", s.spokes}};
}
Json json(const render::MeshShape& s) {
  Json vertices = Json::array();
  for (const Vector3& v : s.mesh->vertices) vertices.push_back(json(v));
  return {{"type", "mesh"}, {"vertices", vertices}, {"triangles", s.mesh->triangles}};
}

Json json(const render::BodyPart& part) {
  return {{"body", json(part.body)},
          {"shape", std::visit([](const auto& s) { return json(s); }, part.shape)},
          {"position", json(part.position)},
          {"orientation", json(part.orientation)},
          {"color", color_text(part.color)}};
}

Json json(const render::BodyBar& bar) {
  return {{"body", json(bar.body)},
          {"start", json(bar.start)},
          {"end", json(bar.end)},
          {"radius", bar.radius},
          {"color", color_text(bar.color)}};
}

Json json(const render::JointLine& line) {
  constexpr std::array<const char*, 5> kinds{"rod", "string", "spring", "telescope", "bumper"};
  return {{"kind", kinds[static_cast<std::size_t>(line.kind)]},
          {"body_a", json(line.body_a)},
          {"body_b", json(line.body_b)},
          {"start", json(line.start)},
          {"end", json(line.end)},
          {"side", json(line.side)},
          {"length", line.length}};
}

// list() below finds only functions that are declared before it.
Json json(const render::JointView::Piece& piece);
Json json(const render::CameraKey& key);
Json json(const AnnotationDef& text);

template <class T>
Json list(const std::vector<T>& items) {
  Json made = Json::array();
  for (const T& item : items) made.push_back(json(item));
  return made;
}

Json json(const render::JointView::Piece& piece) {
  return {{"joint", piece.joint},
          {"parts", list(piece.parts)},
          {"bars", list(piece.bars)},
          {"lines", list(piece.lines)}};
}

Json json(const render::Camera& camera) {
  Json made{{"position", json(camera.position)},
            {"target", json(camera.target)},
            {"up", json(camera.up)}};
  if (const auto* p = std::get_if<render::Perspective>(&camera.projection)) {
    made["vertical_fov"] = p->vertical_fov;
  } else {
    made["height"] = std::get<render::Orthographic>(camera.projection).height;
  }
  return made;
}

Json json(const render::CameraKey& key) {
  Json made = json(key.camera);
  made["time"] = key.time;
  return made;
}

Json json(const AnnotationDef& text) {
  Json made{{"kind", AnnotationDef::kind_names[static_cast<std::size_t>(text.kind)]},
            {"text", text.text},
            {"from", text.from}};
  if (text.to) made["to"] = *text.to;
  if (text.kind == AnnotationDef::Kind::arrow) {
    made["body"] = json(text.body);
    made["point"] = json(text.point);
  }
  return made;
}

Json floor_json(const std::optional<render::Plane>& floor) {
  if (!floor) return nullptr;
  return {{"point", json(floor->point)},
          {"normal", json(floor->normal)},
          {"grid_spacing", floor->grid_spacing},
          {"color", color_text(floor->color)}};
}

Json cables_json(const std::vector<CableReport>& reports, const FrameChannels& channels,
                 const render::BodyView& view) {
  Json made = Json::array();
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    Json links = Json::array();
    for (std::size_t k = 0; k < report.links.size(); ++k) {
      links.push_back({{"type", report.links[k].type},
                       {"body", json(report.links[k].body)},
                       {"winding_room", view.winding_room[c][k]}});
    }
    made.push_back({{"name", report.name},
                    {"closed", report.closed},
                    {"links", links},
                    {"spans", report.spans.size()},
                    {"wraps", channels.wrap_slots(c)}});
  }
  return made;
}

}  // namespace

std::string color_text(const render::Color& color) {
  const auto byte = [](float x) { return std::lround(255.0F * std::clamp(x, 0.0F, 1.0F)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

Json channel_json(const FrameChannel& channel) {
  return {{"name", channel.name}, {"unit", channel.unit}, {"hidden", channel.hidden}};
}

Json machine_json(const Scene& scene, const std::vector<CableReport>& reports,
                  const FrameChannels& channels, const MachineLook& look) {
  const Model& model = scene.model;
  Json bodies = Json::array();
  for (const BodyDef& body : model.bodies) {
    bodies.push_back({{"name", body.name},
                      {"mobility", mobility_names[static_cast<std::size_t>(body.mobility)]}});
  }
  Json joints = Json::array();
  for (const auto& joint : model.joints) {
    joints.push_back({{"name", joint->name},
                      {"type", joint->type()},
                      {"bodies", {json(joint->body_a), json(joint->body_b)}}});
  }
  Eigen::AlignedBox3d bounds = look.bounds;
  if (bounds.isEmpty()) bounds.extend(Eigen::Vector3d::Zero());
  const render::ViewBuilder& view = look.builder;
  return {{"format", "sheave-view/1"},
          {"name", scene.name},
          {"description", scene.description},
          {"gravity", json(model.gravity)},
          {"dt", model.step.dt},
          {"duration", scene.duration},
          {"bodies", bodies},
          {"joints", joints},
          {"cables", cables_json(reports, channels, view.bodies())},
          {"parts", list(view.bodies().parts)},
          {"bars", list(view.bodies().bars)},
          {"joint_pieces", list(view.joints().pieces)},
          {"joint_unit", view.joints().unit},
          {"cable_radius", view.cable_radius()},
          {"tension_max", look.tension_max},
          {"floor", floor_json(view.floor())},
          {"camera", json(look.camera.keys().front().camera)},
          {"camera_path", look.camera.keys().size() > 1 ? list(look.camera.keys()) : Json::array()},
          {"annotations", list(scene.annotations)},
          {"bounds", {{"min", json(Vector3(bounds.min()))}, {"max", json(Vector3(bounds.max()))}}}};
}

}  // namespace sheave::view
