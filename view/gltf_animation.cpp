#include "view/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/joint_report.h"
#include "engine/math/turn_between.h"
#include "render/color_map.h"
#include "render/solid_mesh.h"
#include "view/gltf_builder.h"

namespace sheave::view {
namespace {

constexpr int facets = 48;
constexpr int line_facets = 10;
/// Distance of a line from its cable as a share of the cable's radius; each piece is a node.
constexpr double coarseness = 0.15;
/// Number of stops of the colour map. Colours between two stops are blended.
constexpr std::size_t stops = 9;

/// The values of a node in all frames; a single value if they are constant.
struct Course {
  std::vector<double> values;
  std::size_t width;

  [[nodiscard]] bool is_constant() const {
    for (std::size_t k = width; k < values.size(); ++k) {
      if (std::abs(values[k] - values[k % width]) > 1e-9 * std::abs(values[k % width]))
        return false;
    }
    return true;
  }
  void add(const Vector3& v) { values.insert(values.end(), {v.x(), v.y(), v.z()}); }
  /// Adds a rotation as x, y, z, w. Of the two equivalent quaternions the one closer to the last
  /// value is used, so that interpolation takes the short way.
  void add(const Quaternion& q) {
    Eigen::Vector4d next = q.normalized().coeffs();
    if (!values.empty()) {
      const Eigen::Map<const Eigen::Vector4d> last(values.data() + values.size() - 4);
      if (last.dot(next) < 0.0) next = -next;
    }
    values.insert(values.end(), next.data(), next.data() + 4);
  }
};

/// Writes one machine's animation.
class AnimationWriter {
 public:
  AnimationWriter(double tension_max, const std::vector<double>& times)
      : tension_max_(tension_max), moments_(times.size()) {
    gltf_.set_times(times);
    for (std::size_t k = 0; k < stops; ++k) {
      blends_.push_back(
          render::sample(render::ColorMap::tension, static_cast<double>(k) / (stops - 1)));
    }
  }

  /// Adds the root node, which rotates the machine's up direction to glTF's.
  void add_root(const std::string& name, const Vector3& up) {
    NodePlace place;
    place.rotation = turn_between(up, Vector3::UnitY());
    root_ = gltf_.node(name, -1, -1, place);
  }

  template <class Poses>
  void add_body(const std::string& name, const Poses& poses) {
    Course translation{{}, 3};
    Course rotation{{}, 4};
    for (const auto& pose : poses) {
      translation.add(pose.position);
      rotation.add(pose.orientation);
    }
    NodePlace place;
    place.translation = poses.front().position;
    place.rotation = poses.front().orientation;
    const int node = gltf_.node(name, root_, -1, place);
    animate(node, NodePath::translation, translation);
    animate(node, NodePath::rotation, rotation);
    bodies_.push_back(node);
  }

  int add_part(const render::BodyPart& part, const std::string& name) {
    const int mesh = gltf_.mesh(name, render::make_mesh(part.shape, facets),
                                gltf_.material(part.color), render::Solid{}.accent);
    return gltf_.node(name, holder(part.body), mesh,
                      {part.position, part.orientation, Vector3::Ones()});
  }

  int add_bar(const render::BodyBar& bar, const std::string& name) {
    const Vector3 along = bar.end - bar.start;
    NodePlace place;
    place.translation = 0.5 * (bar.start + bar.end);
    place.rotation = turn_to(along);
    place.scale = {bar.radius, bar.radius, along.norm()};
    return gltf_.node(name, holder(bar.body), plain_line(bar.color), place);
  }

  /// Hides a node from a frame on.
  void hide_from(int node, const Vector3& scale, std::size_t first) {
    if (first >= moments_) return;
    Course course{{}, 3};
    for (std::size_t k = 0; k < moments_; ++k) course.add(k < first ? scale : Vector3::Zero());
    gltf_.animate(node, NodePath::scale, gltf_.track(NodePath::scale, course.values, true));
  }

  void add_line(const LineTrack& line) {
    const std::size_t pieces = line.piece_count();
    if (pieces == 0) return;
    std::vector<std::vector<Vector3>> ends(moments_);
    for (std::size_t k = 0; k < moments_; ++k) {
      if (!line.lines[k].empty()) ends[k] = line.piece_ends(k, pieces);
    }
    const int group = gltf_.node(line.name, root_, -1, {});
    const int mesh = line.color ? plain_line(*line.color) : tension_line();
    Course weights{{}, stops};
    if (!line.color) {
      for (const double tension : line.tensions) add_weights(tension, weights);
    }
    const bool blended = !line.color && !weights.is_constant();
    const int track = blended ? gltf_.track(NodePath::weights, weights.values) : -1;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const int node =
          add_piece(fmt::format("{} {}", line.name, piece), group, mesh, ends, piece, line.radius);
      if (!line.color) {
        gltf_.set_weights(node, {weights.values.begin(), weights.values.begin() + stops});
      }
      if (blended) gltf_.animate(node, NodePath::weights, track);
    }
  }

  [[nodiscard]] std::string bytes() { return gltf_.bytes(); }

 private:
  int holder(BodyId body) const {
    return body.is_world() ? root_ : bodies_[static_cast<std::size_t>(body.index)];
  }

  static Quaternion turn_to(const Vector3& along) { return turn_between(Vector3::UnitZ(), along); }

  void animate(int node, NodePath path, const Course& course) {
    if (!course.is_constant()) gltf_.animate(node, path, gltf_.track(path, course.values));
  }

  int add_piece(const std::string& name, int parent, int mesh,
                const std::vector<std::vector<Vector3>>& ends, std::size_t piece, double radius) {
    Course translation{{}, 3};
    Course rotation{{}, 4};
    Course scale{{}, 3};
    Vector3 middle = Vector3::Zero();
    Vector3 direction = Vector3::UnitZ();
    Quaternion turn = Quaternion::Identity();
    for (const std::vector<Vector3>& now : ends) {
      double length = 0.0;
      if (!now.empty()) {
        const Vector3 along = now[piece + 1] - now[piece];
        middle = 0.5 * (now[piece] + now[piece + 1]);
        length = along.norm();
        if (length > 0.0) {
          // Continues from the last rotation, so that the cylinder does not spin about its axis.
          turn = (turn_between(direction, along / length) * turn).normalized();
          direction = along / length;
        }
      }
      translation.add(middle);
      rotation.add(turn);
      scale.add(length > 0.0 ? Vector3(radius, radius, length) : Vector3::Zero());
    }
    const auto first = [](const Course& course) {
      return Vector3(course.values[0], course.values[1], course.values[2]);
    };
    const auto& q = rotation.values;
    const NodePlace place{first(translation), Quaternion(q[3], q[0], q[1], q[2]), first(scale)};
    const int node = gltf_.node(name, parent, mesh, place);
    animate(node, NodePath::translation, translation);
    animate(node, NodePath::rotation, rotation);
    animate(node, NodePath::scale, scale);
    return node;
  }

  /// Weights of the two stops around the tension; all 0 for slack cable.
  void add_weights(double tension, Course& weights) const {
    std::vector<double> row(stops, 0.0);
    if (tension > 1e-6 * tension_max_) {
      const double place = std::min(tension / tension_max_, 1.0) * (stops - 1);
      const auto below = std::min(static_cast<std::size_t>(place), stops - 2);
      row[below + 1] = place - static_cast<double>(below);
      row[below] = 1.0 - row[below + 1];
    }
    weights.values.insert(weights.values.end(), row.begin(), row.end());
  }

  static render::Mesh unit_line() {
    return render::make_mesh(render::CylinderShape{1.0, 1.0}, line_facets);
  }
  int tension_line() {
    if (tension_line_ < 0) {
      tension_line_ = gltf_.blended_mesh("cable", unit_line(), render::slack_color, blends_);
    }
    return tension_line_;
  }
  int plain_line(const render::Color& color) {
    const int material = gltf_.material(color);
    for (const auto& [known, mesh] : plain_lines_) {
      if (known == material) return mesh;
    }
    plain_lines_.emplace_back(material, gltf_.mesh("rod", unit_line(), material, color));
    return plain_lines_.back().second;
  }

  double tension_max_;
  std::size_t moments_;
  GltfBuilder gltf_;
  std::vector<render::Color> blends_;
  int root_ = -1;
  std::vector<int> bodies_;
  int tension_line_ = -1;
  std::vector<std::pair<int, int>> plain_lines_;  // material, mesh
};

}  // namespace

GltfAnimation::GltfAnimation(const render::ViewBuilder& builder, double tension_max)
    : builder_(builder), tension_max_(tension_max) {}

void GltfAnimation::add(double time, const World& world, std::span<const CableReport> cables,
                        const render::CutRopes& ropes) {
  times_.push_back(time);
  lines_.begin_frame();
  const auto bodies = world.model().bodies.size();
  poses_.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    const BodyId body{static_cast<int>(i)};
    poses_[i].push_back({world.position(body), world.orientation(body)});
  }
  if (times_.size() == 1) add_knots(world, cables);
  for (std::size_t c = 0; c < cables.size(); ++c) add_cable(c, cables[c], ropes);
  add_joints(world);
}

void GltfAnimation::add_knots(const World& world, std::span<const CableReport> cables) {
  for (const CableReport& cable : cables) {
    for (const LinkReport& link : cable.links) {
      if (link.radius > 0.0) continue;
      Vector3 local = link.center;
      if (!link.body.is_world()) {
        local = world.orientation(link.body).conjugate() * (local - world.position(link.body));
      }
      knots_.push_back({link.body, local});
    }
  }
}

void GltfAnimation::add_cable(std::size_t index, const CableReport& listed,
                              const render::CutRopes& ropes) {
  std::vector<int> places;
  const CableReport cable = listed.with_wraps_in_place(&places);
  render::CableStyle style = builder_.cable_style(index, places, tension_max_);
  style.tolerance = coarseness * style.radius;
  const std::string name(cable.name);
  if (cable.cut) {
    const auto pieces = ropes.pieces(index);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      lines_.put(fmt::format("{} piece {}", name, k), style.radius, {}, pieces[k], 0.0);
    }
    return;
  }
  std::vector<std::vector<Vector3>> links = render::link_lines(cable, style);
  std::vector<std::vector<Vector3>> spans = render::span_lines(cable, style);
  const std::size_t n = spans.size();
  int wraps = 0;
  for (std::size_t i = 0; i < cable.links.size(); ++i) {
    const bool is_wrap = places[i] < 0;
    const std::string place = is_wrap ? fmt::format("{} wrap {}", name, wraps++)
                                      : fmt::format("{} link {}", name, places[i]);
    const double before = cable.spans[i > 0 || cable.closed ? (i + n - 1) % n : 0].tension;
    const double after = cable.spans[std::min(i, n - 1)].tension;
    lines_.put(place, style.radius, {}, std::move(links[i]), 0.5 * (before + after));
    if (i >= n) continue;
    lines_.put(place + " span", style.radius, {}, std::move(spans[i]), cable.spans[i].tension);
  }
}

void GltfAnimation::add_joints(const World& world) {
  const render::JointView& view = builder_.joints();
  if (view.pieces.empty()) return;
  broken_.resize(world.model().joints.size());
  const JointReader reader(world);
  for (const render::JointView::Piece& piece : view.pieces) {
    const auto joint = static_cast<std::size_t>(piece.joint);
    if (reader.report(piece.joint).broken_at) {
      if (!broken_[joint]) broken_[joint] = times_.size() - 1;
      continue;
    }
    render::JointView moving;
    moving.unit = view.unit;
    moving.pieces.push_back({piece.joint, {}, {}, piece.lines});
    render::DrawList list;
    render::add_joints(moving, world, list);
    for (std::size_t k = 0; k < list.tubes.size(); ++k) {
      std::vector<Vector3> line;
      for (const render::TubePoint& point : list.tubes[k].points) line.push_back(point.position);
      lines_.put(fmt::format("{} {}", world.model().joints[joint]->name, k), list.tubes[k].radius,
                 list.tubes[k].points.front().color, std::move(line), 0.0);
    }
  }
}

std::string GltfAnimation::finish(const Model& model) {
  AnimationWriter writer(tension_max_, times_);
  writer.add_root("machine", render::up_direction(model));
  for (std::size_t i = 0; i < poses_.size(); ++i) writer.add_body(model.bodies[i].name, poses_[i]);
  const auto name_of = [&](BodyId body) {
    return body.is_world() ? std::string("world")
                           : model.bodies[static_cast<std::size_t>(body.index)].name;
  };
  for (const render::BodyPart& part : builder_.bodies().parts) {
    writer.add_part(part, name_of(part.body) + " shape");
  }
  for (const render::BodyBar& bar : builder_.bodies().bars) {
    writer.add_bar(bar, name_of(bar.body) + " strap");
  }
  for (const Knot& knot : knots_) {
    writer.add_part({knot.body, render::SphereShape{1.7 * builder_.cable_radius()}, knot.position,
                     Quaternion::Identity(), render::knot_color},
                    "knot");
  }
  for (const render::JointView::Piece& piece : builder_.joints().pieces) {
    const auto joint = static_cast<std::size_t>(piece.joint);
    const std::string& name = model.joints[joint]->name;
    std::size_t broken = std::numeric_limits<std::size_t>::max();
    if (joint < broken_.size() && broken_[joint]) broken = *broken_[joint];
    for (const render::BodyPart& part : piece.parts) {
      writer.hide_from(writer.add_part(part, name), Vector3::Ones(), broken);
    }
    for (const render::BodyBar& bar : piece.bars) {
      const Vector3 scale(bar.radius, bar.radius, (bar.end - bar.start).norm());
      writer.hide_from(writer.add_bar(bar, name), scale, broken);
    }
  }
  for (const LineTrack& line : lines_.finish()) writer.add_line(line);
  return writer.bytes();
}

}  // namespace sheave::view
