#include "cable/links/wheel_link.h"

#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/index.h"

namespace sheave {
namespace {

constexpr double parallel_tolerance = 1e-6;  // settings with six decimals

/// The first wheel-like shape of a body; null if there is none.
const PlacedShape* wheel_shape(const BodySet& bodies, int body) {
  if (body == bodies.count()) return nullptr;
  for (const PlacedShape& placed : bodies.definition(body).shapes) {
    if (placed.shape->wheel_radius() > 0.0) return &placed;
  }
  return nullptr;
}

/// Whether the wheel's section with a plane of this normal is a circle.
bool is_circle(const PlacedShape& wheel, const Vector3& normal) {
  if (wheel.shape->type() == "sphere") return true;
  return (wheel.orientation * Vector3::UnitZ()).cross(normal).norm() <= parallel_tolerance;
}

/// The cable's plane must be perpendicular to the axis of rotation, otherwise the body would leave
/// the plane.
bool plane_fits_axle(const BodySet& bodies, int body, const Vector3& normal) {
  if (body == bodies.count()) return true;
  const BodyProperties& properties = bodies[body];
  if (properties.mobility != Mobility::rotor) return true;
  const Vector3 axle =
      properties.mount < 0
          ? properties.axis
          : Vector3(bodies.initial_orientation(properties.mount) * properties.axis);
  return (bodies.initial_orientation(body).conjugate() * axle).cross(normal).norm() <=
         parallel_tolerance;
}

/// Hull of the section of all shapes of the body with the plane; an error if the section has no
/// area.
Result<LinkOutline> section_outline(const BodySet& bodies, int body, const Vector3& center,
                                    const Vector3& normal) {
  std::vector<Vector3> points;
  for (const PlacedShape& placed : bodies.definition(body).shapes) {
    const Quaternion to_shape = placed.orientation.conjugate();
    std::vector<Vector3> section;
    placed.shape->append_section({to_shape * (center - placed.position), to_shape * normal},
                                 section);
    for (const Vector3& point : section) {
      points.emplace_back(placed.position + placed.orientation * point);
    }
  }
  LinkOutline outline;
  outline.y = any_perpendicular(normal);
  outline.x = outline.y.cross(normal);
  for (Vector3& point : points) {
    const Vector3 offset = point - center;
    point = {outline.x.dot(offset), outline.y.dot(offset), 0.0};
  }
  Result<Outline> curve = Outline::create(points);
  if (!curve) return curve.errors();
  outline.curve = std::move(*curve);
  for (int i = 0; i < outline.curve.corner_count(); ++i) {
    const Vector3& corner = outline.curve.corner(i);
    outline.corners.emplace_back(center - bodies[body].center_of_mass + corner.x() * outline.x +
                                 corner.y() * outline.y);
  }
  return outline;
}

}  // namespace

Result<LinkGeometry> WheelLink::place(const BodySet& bodies, const std::string& path) const {
  const Result<int> turns = given_side(winding, side, path);
  if (!turns) return turns.errors();
  const int index = bodies.index(body);
  const PlacedShape* wheel = wheel_shape(bodies, index);
  const PlacedShape* shape = wheel;
  if (shape == nullptr && index != bodies.count() && !bodies.definition(index).shapes.empty()) {
    shape = &bodies.definition(index).shapes.front();
  }
  if (!radius && shape == nullptr) {
    return Error{path + "/body", "body \"" + bodies.name(index) +
                                     "\" has no shape to roll on; give the link a \"radius\""};
  }
  Vector3 plane_normal = Vector3::UnitZ();
  if (shape != nullptr) plane_normal = shape->orientation * plane_normal;
  if (normal) {
    if (!(normal->norm() > 1e-12)) {
      return Error{path + "/normal", "the normal must have a direction; its length is 0"};
    }
    plane_normal = normal->normalized();
  }
  if (!plane_fits_axle(bodies, index, plane_normal)) {
    return Error{path + (normal ? "/normal" : "/body"), "the cable's plane on body \"" +
                                                            bodies.name(index) +
                                                            "\" must be perpendicular to its axle"};
  }
  const Vector3 body_center =
      center.value_or(shape != nullptr ? shape->position : Vector3(Vector3::Zero()));

  LinkGeometry link;
  link.body = link.carrier = index;
  link.side = *turns;
  link.takes_shortest = side == Side::shortest;
  link.center = body_center - bodies[index].center_of_mass;
  link.normal = plane_normal;
  link.mounted = bodies[index].mount >= 0;
  link.massless = bodies[index].massless();
  if (radius || (wheel != nullptr && is_circle(*wheel, plane_normal))) {
    link.signed_radius =
        link.side * radius.value_or(wheel != nullptr ? wheel->shape->wheel_radius() : 0.0);
    return link;
  }
  Result<LinkOutline> outline = section_outline(bodies, index, body_center, plane_normal);
  if (!outline) {
    return Error{path + (center ? "/center" : "/body"),
                 "the cable's plane does not cut the shapes of body \"" + bodies.name(index) +
                     "\" in an area"};
  }
  link.outline = std::make_shared<const LinkOutline>(std::move(*outline));
  return link;
}

void carry_by_axle(const BodySet& bodies, LinkGeometry& link) {
  const int wheel = link.body;
  if (wheel == bodies.count() || bodies[wheel].mobility != Mobility::rotor || link.outline) return;
  const int mount = bodies[wheel].mount;
  const bool mounted = mount >= 0;
  const Quaternion orientation = bodies.initial_orientation(wheel);
  // A mounted rotor turns about the origin of its frame, a rotor on a fixed axle about its centre
  // of mass.
  const Vector3& center_of_mass = bodies[wheel].center_of_mass;
  const Quaternion to_carrier =
      mounted ? Quaternion(bodies.initial_orientation(mount).conjugate() * orientation)
              : orientation;
  const Vector3 offset =
      to_carrier * (mounted ? Vector3(link.center + center_of_mass) : link.center);
  if (offset.cross(bodies[wheel].axis).norm() > 1e-9 * std::abs(link.signed_radius)) return;
  const Vector3 on_axle =
      mounted ? bodies[wheel].mount_position : bodies.initial_point(wheel, center_of_mass);
  link.carrier = mounted ? mount : bodies.count();
  link.center = on_axle + offset;
  link.normal = to_carrier * link.normal;
}

}  // namespace sheave
