#include "render/view_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/body_mass.h"
#include "engine/body_set.h"
#include "engine/joints/hinge.h"
#include "render/number_text.h"

namespace sheave::render {
namespace {

/// A point in the world. The world itself does not move; every other body has a pose.
Vector3 place_in_world(const World& world, BodyId body, const Vector3& local) {
  return body.is_world() ? local : world.point(body, local);
}

Quaternion turn_in_world(const World& world, BodyId body, const Quaternion& local) {
  return body.is_world() ? local : Quaternion(world.orientation(body) * local);
}

/// Whether two directions are parallel or opposite.
bool parallel(const Vector3& a, const Vector3& b) { return a.cross(b).norm() < 1e-3; }

/// The direction that all have in common, up to sign; nothing if there is none.
std::optional<Vector3> common_direction(const std::vector<Vector3>& directions) {
  if (directions.empty()) return std::nullopt;
  for (const Vector3& d : directions) {
    if (!parallel(d, directions.front())) return std::nullopt;
  }
  Vector3 normal = directions.front();
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  // Scenes are usually seen from the positive side of an axis.
  return normal[largest] < 0.0 ? Vector3(-normal) : normal;
}

/// The place half-way along a line.
Vector3 middle_of(const std::vector<Vector3>& line) {
  double total = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) total += (line[i] - line[i - 1]).norm();
  double left = 0.5 * total;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double piece = (line[i] - line[i - 1]).norm();
    if (piece >= left && piece > 0.0) return line[i - 1] + (line[i] - line[i - 1]) * (left / piece);
    left -= piece;
  }
  return line.back();
}

/// With more spans than this, a label beside each one hides the machine.
constexpr std::size_t most_labels = 16;

/// Index of the span with the largest tension.
std::size_t largest_of(const CableReport& cable) {
  const auto largest = std::max_element(
      cable.spans.begin(), cable.spans.end(),
      [](const SpanReport& a, const SpanReport& b) { return a.tension < b.tension; });
  return static_cast<std::size_t>(largest - cable.spans.begin());
}

/// Keeps the label of the span with the largest tension. The labels from `first` on are those of the
/// cable's spans.
void keep_largest(const CableReport& cable, std::size_t first, std::vector<Label>& labels) {
  if (labels.size() == first) return;
  labels[first] = labels[first + largest_of(cable)];
  labels.resize(first + 1);
}

}  // namespace

double total_weight(const Model& model) {
  double mass = 0.0;
  for (const BodyDef& body : model.bodies) {
    mass += defined_mass_properties(body).mass;
  }
  return mass * model.gravity.norm();
}

Vector3 up_direction(const Model& model) {
  const double strength = model.gravity.norm();
  return strength > 0.0 ? Vector3(-model.gravity / strength) : Vector3(Vector3::UnitY());
}

std::optional<Vector3> motion_plane(const Model& model, std::span<const CableReport> cables) {
  std::vector<Vector3> normals;
  for (const CableReport& cable : cables) {
    for (const LinkReport& link : cable.links) {
      if (link.radius > 0.0) normals.push_back(link.normal);
    }
  }
  if (normals.empty()) {
    for (const BodyDef& body : model.bodies) {
      if (body.mobility != Mobility::planar) continue;
      normals.push_back(body.axis ? Vector3(body.axis->normalized()) : Vector3(Vector3::UnitZ()));
    }
  }
  if (normals.empty()) {
    for (const auto& joint : model.joints) {
      const auto* hinge = dynamic_cast<const HingeJoint*>(joint.get());
      if (hinge != nullptr) normals.push_back(hinge->axis.normalized());
    }
  }
  return common_direction(normals);
}

ViewBuilder::ViewBuilder(const World& world, std::span<const CableReport> cables,
                         ViewOptions options)
    : options_(std::move(options)),
      gravity_(world.model().gravity),
      weight_(total_weight(world.model())) {
  // The bodies are viewed twice: the size of the scene decides the radius of the cables, and that
  // radius the shape of the wheels.
  bodies_ = make_body_view(world, cables, 1e-9 * world.bodies().scale());
  DrawList draft;
  add_bodies(world, draft);
  Eigen::AlignedBox3d box = bounds(draft);
  for (const CableReport& cable : cables) {
    for (const LinkReport& link : cable.links) box.extend(link.center);
  }
  extend_by_joints(world, box);
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  const double diagonal = std::max(box.diagonal().norm(), 1e-9);
  cable_radius_ = options_.cable_radius.value_or(suitable_cable_radius(diagonal, cables));
  bodies_ = make_body_view(world, cables, cable_radius_);
  paint_bodies();
  if (options_.joints) joints_ = make_joint_view(world, cable_radius_, options_.travels);

  if (!world.model().ground) return;
  const Eigen::AlignedBox3d shown = options_.run_bounds.isEmpty() ? box : options_.run_bounds;
  Plane plane;
  plane.point = world.model().ground->point;
  plane.normal = world.model().ground->normal.normalized();
  plane.grid_spacing = round_down(std::max(0.15 * shown.diagonal().norm(), 1e-9));
  floor_ = plane;
}

void ViewBuilder::paint_bodies() {
  for (BodyPart& part : bodies_.parts) {
    const auto index = static_cast<std::size_t>(part.body.index);
    if (part.body.is_world() || index >= options_.body_colors.size()) continue;
    part.color = options_.body_colors[index].value_or(part.color);
  }
}

DrawList ViewBuilder::build(const World& world, std::span<const CableReport> cables,
                            const CutRopes* ropes) const {
  DrawList list;
  list.title = options_.title;
  if (options_.time) list.time = world.state().time;
  list.duration = options_.duration;
  list.axes = options_.axes;
  if (floor_) list.planes.push_back(*floor_);
  add_bodies(world, list);
  add_joints(joints_, world, list);
  add_cables(cables, ropes, list);
  add_annotations(world, list);
  return list;
}

void ViewBuilder::add_annotations(const World& world, DrawList& list) const {
  using Kind = AnnotationDef::Kind;
  const double time = world.state().time;
  const std::string_view title = shown_text(options_.annotations, Kind::title, time);
  if (!title.empty()) list.title = title;
  list.caption = shown_text(options_.annotations, Kind::caption, time);
  for (const AnnotationDef& text : options_.annotations) {
    if (text.kind != Kind::arrow || !text.is_shown(time)) continue;
    Label arrow;
    arrow.anchor = place_in_world(world, text.body, text.point);
    arrow.text = text.text;
    list.arrows.push_back(std::move(arrow));
  }
}

void ViewBuilder::add_bodies(const World& world, DrawList& list) const {
  for (const BodyPart& part : bodies_.parts) {
    Solid solid;
    solid.shape = part.shape;
    solid.position = place_in_world(world, part.body, part.position);
    solid.orientation = turn_in_world(world, part.body, part.orientation);
    solid.color = part.color;
    list.solids.push_back(std::move(solid));
  }
  for (const BodyBar& bar : bodies_.bars) {
    Tube tube;
    tube.radius = bar.radius;
    tube.points = {{place_in_world(world, bar.body, bar.start), bar.color},
                   {place_in_world(world, bar.body, bar.end), bar.color}};
    list.tubes.push_back(std::move(tube));
  }
}

double ViewBuilder::tension_scale(std::span<const CableReport> cables) const {
  if (options_.tension_max) return *options_.tension_max;
  double largest = 0.0;
  for (const CableReport& cable : cables) {
    for (const SpanReport& span : cable.spans) largest = std::max(largest, span.tension);
    for (const WrapReport& wrap : cable.wraps) largest = std::max(largest, wrap.span.tension);
  }
  if (largest > 1e-6 * weight_) return largest;
  return weight_ > 0.0 ? weight_ : 1.0;
}

CableStyle ViewBuilder::cable_style(std::size_t cable, const std::vector<int>& places,
                                    double tension_max) const {
  CableStyle style;
  style.radius = cable_radius_;
  style.tolerance = 0.03 * cable_radius_;  // far less than a pixel
  style.tension_max = tension_max;
  style.gravity = gravity_;
  style.floor = floor_;
  for (const int place : places) {
    const bool has_room = place >= 0 && cable < bodies_.winding_room.size();
    style.winding_room.push_back(
        has_room ? bodies_.winding_room[cable][static_cast<std::size_t>(place)] : 0.0);
  }
  return style;
}

void ViewBuilder::add_cables(std::span<const CableReport> cables, const CutRopes* ropes,
                             DrawList& list) const {
  if (cables.empty()) return;
  const double tension_max = tension_scale(cables);
  std::size_t spans = 0;
  for (const CableReport& cable : cables) spans += cable.spans.size() + cable.wraps.size();
  const bool crowded = spans > most_labels;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    std::vector<int> places;
    const CableReport cable = cables[c].with_wraps_in_place(&places);
    const CableStyle style = cable_style(c, places, tension_max);
    if (cable.cut && ropes != nullptr) {
      for (const auto& line : ropes->pieces(c))
        list.tubes.push_back(slack_tube(line, style.radius));
    } else {
      for (Tube& tube : cable_tubes(cable, style)) list.tubes.push_back(std::move(tube));
    }
    for (const LinkReport& link : cable.links) {
      if (link.radius > 0.0) continue;
      Solid knot;
      knot.shape = SphereShape{1.7 * cable_radius_};
      knot.position = link.center;
      knot.color = knot_color;
      list.solids.push_back(std::move(knot));
    }
    if (!options_.force_labels) continue;
    const std::size_t first = list.labels.size();
    add_labels(cable, style, list);
    if (crowded) keep_largest(cable, first, list.labels);
  }
  if (!options_.legend) return;
  Legend legend;
  legend.max = tension_max;
  legend.map = CableStyle{}.map;
  list.legend = legend;
}

void ViewBuilder::add_labels(const CableReport& cable, const CableStyle& style,
                             DrawList& list) const {
  if (cable.cut) return;
  const std::vector<std::vector<Vector3>> lines = span_lines(cable, style);
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    const SpanReport& span = cable.spans[k];
    const LinkReport& first = cable.links[k];
    const LinkReport& second = cable.links[(k + 1) % cable.links.size()];
    const Vector3 normal = first.radius > 0.0 ? first.normal : second.normal;
    const Vector3 along = span.end - span.start;
    Label label;
    label.text = quantity_text(span.tension, style.tension_max, "N");
    const bool named = options_.label_names && k == largest_of(cable);
    if (named) label.text = std::string(cable.name) + ": " + label.text;
    label.anchor = middle_of(lines[k]);
    // The label stands to the right of an upright span and above a level one.
    label.direction = along.cross(normal);
    const Vector3 up =
        gravity_.norm() > 0.0 ? Vector3(-gravity_.normalized()) : Vector3(Vector3::UnitY());
    const Vector3 right = up.cross(normal);
    if (label.direction.dot(right) + 0.3 * label.direction.dot(up) < 0.0) label.direction *= -1.0;
    if (is_slack(span)) {
      label.direction = -up;
    } else {
      label.slide = 0.35 * along;
    }
    list.labels.push_back(std::move(label));
  }
}

}  // namespace sheave::render
