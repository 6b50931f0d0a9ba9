// A sheave: a rim with a groove for the cable, a hub, an axle pin, and spokes with openings between
// them. The flanges end a little below the centre line of the cable, so that most of the cable is
// visible from the side.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/solid_mesh.h"

namespace sheave::render {
namespace {

/// Sizes of the parts [m].
struct Parts {
  double flange;        ///< outer radius
  double groove_depth;  ///< below the flange
  double groove_lip;    ///< half width at the flange
  double groove_floor;  ///< half width of the flat bottom
  double rim_inner;     ///< outer radius of the openings
  double hub;
  double axle;
  double half_length;
};

Parts measure(const SheaveShape& s) {
  Parts p{};
  p.half_length = 0.5 * s.length;
  p.flange = s.radius - 0.3 * std::min(s.cable_radius, 0.35 * s.radius);
  p.groove_depth = 0.7 * std::min(s.cable_radius, 0.35 * s.radius);
  const double widest = 0.84 * p.half_length;
  p.groove_floor = std::min(0.5 * s.groove_width, widest);
  p.groove_lip = std::min(p.groove_floor + 1.05 * s.cable_radius, widest);
  p.rim_inner = 0.86 * (p.flange - p.groove_depth);
  p.hub = 0.24 * s.radius;
  p.axle = 0.10 * s.radius;
  return p;
}

/// Outer surface of the rim, from one flange through the groove to the other.
void add_rim(MeshBuilder& builder, const Parts& p, int segments) {
  const double z = p.half_length;
  builder.add_cone(p.rim_inner, -z, p.flange, -z, segments);
  builder.add_cone(p.flange, -z, p.flange, -p.groove_lip, segments);
  if (p.groove_depth > 0.0) {
    // Half an ellipse, split by the flat floor; the normals of the ellipse make the groove look
    // round.
    std::vector<ProfilePoint> profile;
    const double width = std::max(p.groove_lip - p.groove_floor, 1e-3 * p.half_length);
    constexpr int steps = 4;
    for (int k = 0; k <= 2 * steps; ++k) {
      const double angle = pi * k / (2.0 * steps);  // 0 at the lower lip, pi at the upper
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      const double floor = k < steps ? -p.groove_floor : p.groove_floor;
      const double norm = std::hypot(s / p.groove_depth, c / width);
      const ProfilePoint point{p.flange - p.groove_depth * s, floor - width * c,
                               s / p.groove_depth / norm, c / width / norm};
      if (k == steps) profile.push_back({point.radius, -p.groove_floor, 1.0, 0.0});
      if (k != steps || p.groove_floor > 0.0) profile.push_back(point);
    }
    builder.set_paint({205, 208, 214, 0});
    builder.add_revolution(profile, segments);
    builder.set_paint(plain_paint);
  }
  builder.add_cone(p.flange, p.groove_lip, p.flange, z, segments);
  builder.add_cone(p.flange, z, p.rim_inner, z, segments);
}

void add_hub(MeshBuilder& builder, const Parts& p, int segments) {
  const double z = 0.96 * p.half_length;
  builder.add_cone(p.hub, -z, p.hub, z, segments);
  for (const double side : {-1.0, 1.0}) {
    builder.add_cone(side < 0.0 ? p.axle : p.hub, side * z, side < 0.0 ? p.hub : p.axle, side * z,
                     segments);
  }
  const double pin = p.half_length + 0.35 * p.axle;
  builder.set_paint({90, 92, 98, 0});
  builder.add_cone(0.0, -pin, p.axle, -pin, segments);
  builder.add_cone(p.axle, -pin, p.axle, pin, segments);
  builder.add_cone(p.axle, pin, 0.0, pin, segments);
  builder.set_paint(plain_paint);
}

/// A bar from the hub to the rim, tapering outwards.
void add_spoke(MeshBuilder& builder, const Parts& p, double angle, double hub_width) {
  const Vector3 out(std::cos(angle), std::sin(angle), 0.0);
  const Vector3 side(-out.y(), out.x(), 0.0);
  const Vector3 up = Vector3::UnitZ() * (0.6 * p.half_length);
  const Vector3 in_left = out * (0.9 * p.hub) + side * (0.5 * hub_width);
  const Vector3 in_right = out * (0.9 * p.hub) - side * (0.5 * hub_width);
  const double reach = p.rim_inner + 0.02 * p.flange;
  const Vector3 out_left = out * reach + side * (0.36 * hub_width);
  const Vector3 out_right = out * reach - side * (0.36 * hub_width);
  const auto quad = [&](const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d,
                        const Vector3& towards) {
    Vector3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(towards) < 0.0) normal = -normal;
    builder.add_polygon(std::array<Vector3, 4>{a, b, c, d}, normal);
  };
  quad(in_left + up, out_left + up, out_right + up, in_right + up, up);
  quad(in_left - up, out_left - up, out_right - up, in_right - up, -up);
  quad(in_left + up, out_left + up, out_left - up, in_left - up, side);
  quad(in_right + up, out_right + up, out_right - up, in_right - up, -side);
}

/// A closed web instead of spokes, with one painted sector.
void add_web(MeshBuilder& builder, const Parts& p, int segments) {
  const double z = 0.5 * p.half_length;
  builder.add_cone(p.hub, -z, p.rim_inner, -z, segments);
  builder.add_cone(p.rim_inner, z, p.hub, z, segments);
  builder.set_paint(accent_paint);
  add_spoke(builder, p, 0.0, 0.7 * p.hub);
  builder.set_paint(plain_paint);
}

}  // namespace

void add_sheave(MeshBuilder& builder, const SheaveShape& sheave, int segments) {
  const Parts p = measure(sheave);
  add_rim(builder, p, segments);
  // The inner side of the rim is visible through the openings.
  builder.add_cone(p.rim_inner, p.half_length, p.rim_inner, -p.half_length, segments);
  add_hub(builder, p, std::max(8, segments / 2));
  if (sheave.spokes <= 0) {
    add_web(builder, p, segments);
    return;
  }
  const double room = 2.0 * pi * p.hub / sheave.spokes;
  for (int k = 0; k < sheave.spokes; ++k) {
    builder.set_paint(k == 0 ? accent_paint : plain_paint);
    add_spoke(builder, p, 2.0 * pi * k / sheave.spokes, std::min(0.8 * room, 0.85 * p.hub));
  }
  builder.set_paint(plain_paint);
}

}  // namespace sheave::render
