#include "render/body_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "engine/body_set.h"
#include "engine/math/turn_between.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "engine/shapes/torus.h"
#include "render/curved_mesh.h"

namespace sheave::render {
namespace {

constexpr Color frame_color = rgb(0x66717f);
constexpr Color wheel_color = rgb(0x9aabbe);
constexpr Color strap_color = rgb(0x7b8794);

MeshShape mesh_of(std::vector<Vector3> vertices,
                  std::vector<std::array<std::uint32_t, 3>> triangles) {
  TriangleMesh mesh{std::move(vertices), std::move(triangles)};
  return {std::make_shared<TriangleMesh>(std::move(mesh))};
}

MeshShape drawable_hull(const Polyhedron& polyhedron) {
  const Hull hull = polyhedron.hull();
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : hull.triangles) {
    triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                         static_cast<std::uint32_t>(t[2])});
  }
  return mesh_of(hull.vertices, std::move(triangles));
}

MeshShape drawable_prism(const Prism& prism) {
  const std::vector<Vector3> outline = prism.hull();
  const auto n = static_cast<std::uint32_t>(outline.size());
  std::vector<Vector3> vertices;
  for (const double side : {-0.5, 0.5}) {
    for (const Vector3& p : outline) {
      vertices.push_back(p + Vector3::UnitZ() * (side * prism.length));
    }
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    triangles.push_back({k, next, n + next});
    triangles.push_back({k, n + next, n + k});
  }
  for (std::uint32_t k = 2; k < n; ++k) {
    triangles.push_back({0, k, k - 1});
    triangles.push_back({n, n + k - 1, n + k});
  }
  return mesh_of(std::move(vertices), std::move(triangles));
}

/// Place of one wheel of a cable in the frame of its body.
struct WheelPlace {
  Vector3 center;
  Vector3 normal;
  double radius = 0.0;
};

class Builder {
 public:
  Builder(const World& world, std::span<const CableReport> cables, double cable_radius)
      : world_(world), cables_(cables), cable_radius_(cable_radius) {
    for (const CableReport& cable : cables)
      view_.winding_room.emplace_back(cable.links.size(), 0.0);
  }

  BodyView run() {
    const auto& bodies = world_.model().bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      add_body(BodyId{static_cast<int>(i)}, bodies[i]);
    }
    add_shapeless_wheels();
    return std::move(view_);
  }

 private:
  [[nodiscard]] WheelPlace place_of(const LinkReport& link) const {
    const Quaternion to_body = world_.orientation(link.body).conjugate();
    const double radius = link.groove ? link.groove->drum_radius : link.radius;
    return {to_body * (link.center - world_.position(link.body)), to_body * link.normal, radius};
  }

  /// Whether the cable runs round this cylinder. Its distance from the cylinder's middle is added
  /// to `offset` if so.
  [[nodiscard]] static bool fits(const WheelPlace& wheel, const PlacedShape& placed, double radius,
                                 double length, double& offset) {
    const Vector3 axis = placed.orientation * Vector3::UnitZ();
    const Vector3 d = wheel.center - placed.position;
    const double along = axis.dot(d);
    const double tolerance = 1e-3 * radius;
    if (std::abs(wheel.radius - radius) > tolerance || (d - axis * along).norm() > tolerance ||
        std::abs(along) > 0.5 * length + tolerance || axis.cross(wheel.normal).norm() > 1e-3) {
      return false;
    }
    offset = std::max(offset, std::abs(along));
    return true;
  }

  [[nodiscard]] static bool is_wheel_like(const BodyDef& body) {
    return std::all_of(body.shapes.begin(), body.shapes.end(), [](const PlacedShape& s) {
      return dynamic_cast<const Cylinder*>(s.shape.get()) != nullptr;
    });
  }

  Color color_of(BodyId id, const BodyDef& body) {
    if (body.mobility == Mobility::fixed) return frame_color;
    if (body.mobility == Mobility::rotor || (carries_cable(id) && is_wheel_like(body))) {
      return wheel_color;
    }
    return load_color(body.name);
  }

  [[nodiscard]] bool carries_cable(BodyId id) const {
    for (const CableReport& cable : cables_) {
      for (const LinkReport& link : cable.links) {
        if (link.body == id && link.radius > 0.0) return true;
      }
    }
    return false;
  }

  void add_body(BodyId id, const BodyDef& body) {
    const Color color = color_of(id, body);
    double thickness = 4.0 * cable_radius_;
    for (const PlacedShape& placed : body.shapes) {
      BodyPart part{id, drawable(*placed.shape), placed.position, placed.orientation, color};
      if (const auto* cylinder = dynamic_cast<const Cylinder*>(placed.shape.get())) {
        if (const auto sheave = sheave_for(id, body, placed, *cylinder)) part.shape = *sheave;
        thickness = std::max(thickness, cylinder->length);
      }
      if (const auto* plane = dynamic_cast<const HalfSpace*>(placed.shape.get())) {
        lay_slab(*plane, part);
      }
      view_.parts.push_back(std::move(part));
    }
    if (body.shapes.empty() && !carries_cable(id)) {
      view_.parts.push_back(
          {id, SphereShape{2.5 * cable_radius_}, Vector3::Zero(), Quaternion::Identity(), color});
    }
    if (body.mount) add_cheeks(id, *body.mount, thickness);
  }

  /// Replaces a half-space by a thin slab under its plane, wider than the scene.
  void lay_slab(const HalfSpace& plane, BodyPart& part) const {
    const double scale = world_.bodies().scale();
    const double depth = 0.01 * scale;
    const Vector3 normal = plane.normal.normalized();
    part.shape = BoxShape{Vector3(3.0 * scale, depth, 3.0 * scale)};
    part.position = placed_at(part, -0.5 * depth * normal);
    part.orientation = part.orientation * turn_between(Vector3::UnitY(), normal);
  }
  static Vector3 placed_at(const BodyPart& part, const Vector3& local) {
    return part.position + part.orientation * local;
  }

  /// Whether a cylinder turns about an axle other than its own axis; spokes would show the wrong
  /// axle.
  [[nodiscard]] static bool is_eccentric(const BodyDef& body, const PlacedShape& placed) {
    if (body.mobility != Mobility::rotor) return false;
    const Quaternion& turn = body.orientation;
    const Vector3 axle = turn.conjugate() * body.axis.value_or(turn * Vector3::UnitZ());
    return axle.normalized().cross(placed.position).norm() > 1e-3 * placed.shape->wheel_radius();
  }

  /// The sheave to draw for a cylinder; nothing if no cable runs round it and its body is no rotor,
  /// or if it is eccentric.
  std::optional<SheaveShape> sheave_for(BodyId id, const BodyDef& body, const PlacedShape& placed,
                                        const Cylinder& cylinder) {
    SheaveShape sheave;
    sheave.radius = cylinder.radius;
    sheave.length = cylinder.length;
    sheave.cable_radius = 0.0;
    double offset = 0.0;
    double most_turns = 0.0;
    std::vector<double*> rooms;
    double no_room = 0.0;
    for (std::size_t c = 0; c < cables_.size(); ++c) {
      for (std::size_t i = 0; i < cables_[c].links.size(); ++i) {
        const LinkReport& link = cables_[c].links[i];
        if (!(link.body == id) || !(link.radius > 0.0)) continue;
        if (!fits(place_of(link), placed, cylinder.radius, cylinder.length, offset)) continue;
        sheave.cable_radius = std::min(cable_radius_, 0.5 * cylinder.radius);
        most_turns = std::max(most_turns, link.wrap_angle / (2.0 * pi));
        matched_.push_back(&link);
        // The groove tells the places of the turns.
        rooms.push_back(link.groove ? &no_room : &view_.winding_room[c][i]);
      }
    }
    if (rooms.empty() && body.mobility != Mobility::rotor) return std::nullopt;
    if (is_eccentric(body, placed)) return std::nullopt;
    // The groove for one cable is round; the groove for several turns side by side is as wide as
    // the drum.
    sheave.groove_width = 2.0 * offset;
    if (most_turns > 1.0)
      sheave.groove_width = std::max(sheave.groove_width, 0.8 * cylinder.length);
    for (double* room : rooms) *room = 0.84 * cylinder.length;
    return sheave;
  }

  /// Joins the axle of a mounted wheel to its carrier by a strap on either side.
  void add_cheeks(BodyId wheel, BodyId carrier, double thickness) {
    const Vector3 center = world_.position(wheel);
    const BodyDef& body = world_.model().bodies[static_cast<std::size_t>(wheel.index)];
    const Vector3 axis = body.axis ? Vector3(body.axis->normalized())
                                   : Vector3(world_.orientation(wheel) * Vector3::UnitZ());
    const Vector3 target = nearest_point(carrier, center);
    const Vector3 reach = (target - center) - axis * axis.dot(target - center);
    if (reach.norm() < 2.0 * cable_radius_) return;
    const Quaternion to_frame = world_.orientation(carrier).conjugate();
    const auto local = [&](const Vector3& p) {
      return Vector3(to_frame * (p - world_.position(carrier)));
    };
    for (const double side : {-1.0, 1.0}) {
      const Vector3 out = axis * (side * (0.5 * thickness + cable_radius_));
      // The bar is given in the carrier's frame, because the axle is fixed to the carrier.
      view_.bars.push_back(
          {carrier, local(center + out), local(center + reach + out), cable_radius_, strap_color});
    }
  }

  /// The point of a body's shapes (of the boxes round them) that is nearest to `point`; the body's
  /// origin if it has no shapes.
  [[nodiscard]] Vector3 nearest_point(BodyId id, const Vector3& point) const {
    const BodyDef& body = world_.model().bodies[static_cast<std::size_t>(id.index)];
    Vector3 nearest = world_.position(id);
    double best = std::numeric_limits<double>::infinity();
    for (const PlacedShape& placed : body.shapes) {
      const Quaternion turn = world_.orientation(id) * placed.orientation;
      const Vector3 origin = world_.point(id, placed.position);
      const Vector3 half = 0.97 * placed.shape->half_extent();
      const Vector3 inside = turn.conjugate() * (point - origin);
      const Vector3 here = origin + turn * inside.cwiseMin(half).cwiseMax(-half);
      const double distance = (here - point).norm();
      if (distance < best) {
        best = distance;
        nearest = here;
      }
    }
    return nearest;
  }

  void add_shapeless_wheels() {
    for (const CableReport& cable : cables_) {
      for (const LinkReport& link : cable.links) {
        if (!(link.radius > 0.0)) continue;
        if (std::find(matched_.begin(), matched_.end(), &link) != matched_.end()) continue;
        if (is_round_body(link)) continue;
        const WheelPlace place = place_of(link);
        SheaveShape sheave;
        sheave.radius = link.radius;
        sheave.cable_radius = std::min(cable_radius_, 0.5 * link.radius);
        sheave.length = 4.0 * sheave.cable_radius;
        const Quaternion turn = turn_between(Vector3::UnitZ(), place.normal);
        view_.parts.push_back({link.body, sheave, place.center, turn, wheel_color});
      }
    }
  }

  /// Whether the link's wheel is a ball, a capsule or another smooth body. Cables may run round
  /// those, too, and they are drawn with their own shape.
  [[nodiscard]] bool is_round_body(const LinkReport& link) const {
    if (link.body.is_world()) return false;
    const auto& body = world_.model().bodies[static_cast<std::size_t>(link.body.index)];
    return std::any_of(body.shapes.begin(), body.shapes.end(), [&](const PlacedShape& s) {
      const bool curved = !link.path.empty() && (dynamic_cast<const Cone*>(s.shape.get()) ||
                                                 dynamic_cast<const Torus*>(s.shape.get()) ||
                                                 dynamic_cast<const Ellipsoid*>(s.shape.get()));
      return curved || (std::abs(s.shape->wheel_radius() - link.radius) <= 1e-3 * link.radius &&
                        dynamic_cast<const Cylinder*>(s.shape.get()) == nullptr);
    });
  }

  const World& world_;
  std::span<const CableReport> cables_;
  double cable_radius_;
  BodyView view_;
  std::vector<const LinkReport*> matched_;
};

}  // namespace

Color load_color(std::string_view name) {
  constexpr std::array<std::string_view, 11> sides{"left",   "right", "front",    "rear",
                                                   "back",   "upper", "lower",    "top",
                                                   "bottom", "port",  "starboard"};
  // FNV-1a, so that names that differ in the last digit alone get different colours.
  std::uint32_t hash = 2166136261U;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of(" -_"), name.size() - 1) + 1;
    const std::string_view part = name.substr(0, end);
    const std::string_view word = part.substr(0, part.find_first_of(" -_"));
    name.remove_prefix(end);
    if (std::find(sides.begin(), sides.end(), word) != sides.end()) continue;
    for (const char c : part) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  }
  return load_colors[hash % load_colors.size()];
}

Shape drawable(const sheave::Shape& shape) {
  if (const auto* s = dynamic_cast<const Box*>(&shape)) return BoxShape{s->size};
  if (const auto* s = dynamic_cast<const Sphere*>(&shape)) return SphereShape{s->radius};
  if (const auto* s = dynamic_cast<const Cylinder*>(&shape)) {
    return CylinderShape{s->radius, s->length};
  }
  if (const auto* s = dynamic_cast<const Capsule*>(&shape))
    return CapsuleShape{s->radius, s->length};
  if (const auto* s = dynamic_cast<const Cone*>(&shape)) return drawable_cone(*s);
  if (const auto* s = dynamic_cast<const Torus*>(&shape)) return drawable_torus(*s);
  if (const auto* s = dynamic_cast<const Ellipsoid*>(&shape)) return drawable_ellipsoid(*s);
  if (const auto* s = dynamic_cast<const Polyhedron*>(&shape)) return drawable_hull(*s);
  if (const auto* s = dynamic_cast<const Prism*>(&shape)) return drawable_prism(*s);
  return BoxShape{2.0 * shape.half_extent()};
}

BodyView make_body_view(const World& world, std::span<const CableReport> cables,
                        double cable_radius) {
  return Builder(world, cables, cable_radius).run();
}

double suitable_cable_radius(double diagonal, std::span<const CableReport> cables) {
  double smallest = diagonal;
  for (const CableReport& cable : cables) {
    for (const LinkReport& link : cable.links) {
      if (link.radius > 0.0) smallest = std::min(smallest, link.radius);
    }
  }
  const double wanted = std::clamp(0.08 * smallest, 0.003 * diagonal, 0.006 * diagonal);
  return std::min(wanted, 0.35 * smallest);
}

}  // namespace sheave::render
