#include "cable/links/rolling.h"

#include <limits>

#include "engine/field_check.h"

namespace sheave {
namespace {

/// The first shape of a body that a cable can roll on; null if there is none.
const PlacedShape* wheel_shape(const BodySet& bodies, int body) {
  if (body == bodies.count()) return nullptr;
  for (const PlacedShape& placed : bodies.definition(body).shapes) {
    if (placed.shape->wheel_radius() > 0.0) return &placed;
  }
  return nullptr;
}

/// A cable plane must be perpendicular to the wheel's axis, or its section would be no circle, and
/// to the axis the body turns about, or the wheel would leave the plane.
bool plane_fits(const BodySet& bodies, int body, const PlacedShape* wheel, const Vector3& normal) {
  constexpr double tolerance = 1e-6;  // what six printed decimals leave
  const bool round = wheel != nullptr && wheel->shape->type() == "sphere";
  if (wheel != nullptr && !round &&
      (wheel->orientation * Vector3::UnitZ()).cross(normal).norm() > tolerance) {
    return false;
  }
  if (body == bodies.count()) return true;
  const BodyProperties& properties = bodies[body];
  if (properties.mobility != Mobility::rotor) return true;
  const Vector3 axle =
      properties.mount < 0
          ? properties.axis
          : Vector3(bodies.initial_orientation(properties.mount) * properties.axis);
  return (bodies.initial_orientation(body).conjugate() * axle).cross(normal).norm() <= tolerance;
}

}  // namespace

std::span<const Field> RollingLink::field_table() {
  static const std::array table{
      choice_field<&RollingLink::winding>(
          "winding", winding_names, required,
          "which way the cable runs round the wheel, seen against the plane's normal"),
      field<&RollingLink::center>("center", "m", any_number(), optional,
                                  "centre of the wheel, body frame; default: the centre of the "
                                  "body's first wheel-like shape"),
      field<&RollingLink::normal>("normal", "", any_number(), optional,
                                  "normal of the cable's plane, body frame; default: that shape's "
                                  "z axis"),
      field<&RollingLink::radius>("radius", "m", above(0.0), optional,
                                  "default: that shape's radius"),
      field<&RollingLink::stored_length>(
          "stored_length", "m", at_least(0.0), optional,
          "cable wound on the wheel at time 0; required at the end of an open cable, elsewhere it "
          "follows from the tangents"),
      field<&RollingLink::turns>("turns", "", between(0, 1000), optional,
                                 "whole turns in addition to the arc between the tangents"),
  };
  return table;
}

Result<LinkGeometry> RollingLink::compile(const BodySet& bodies, const std::string& path) const {
  const int index = bodies.index(body);
  const PlacedShape* wheel = wheel_shape(bodies, index);
  Errors errors;
  if (!radius && wheel == nullptr) {
    errors.push_back({path + "/body", "body \"" + bodies.name(index) +
                                          "\" has no wheel-like shape (cylinder, sphere, capsule) "
                                          "to roll on; give the link a \"radius\""});
  }
  Vector3 plane_normal = Vector3::UnitZ();
  if (wheel != nullptr) plane_normal = wheel->orientation * plane_normal;
  if (normal) {
    if (!(normal->norm() > 1e-12)) {
      errors.push_back({path + "/normal", "the normal must have a direction; its length is 0"});
    } else {
      plane_normal = normal->normalized();
    }
  }
  if (errors.empty() && !plane_fits(bodies, index, wheel, plane_normal)) {
    errors.push_back({path + (normal ? "/normal" : "/body"),
                      "the cable's plane on body \"" + bodies.name(index) +
                          "\" must be perpendicular to the wheel's axis and to its axle"});
  }
  if (!errors.empty()) return errors;

  LinkGeometry link;
  link.body = link.carrier = index;
  const double size = radius.value_or(wheel != nullptr ? wheel->shape->wheel_radius() : 0.0);
  link.signed_radius = winding == Winding::counter_clockwise ? size : -size;
  const Vector3 body_center =
      center.value_or(wheel != nullptr ? wheel->position : Vector3(Vector3::Zero()));
  link.center = body_center - bodies[index].center_of_mass;
  link.normal = plane_normal;
  link.given_stored_length = stored_length.value_or(std::numeric_limits<double>::quiet_NaN());
  link.extra_turns = turns;
  const int mount = bodies[index].mount;
  if (mount < 0) return link;
  // The wheel's centre lies on the axle, which is fixed to the carrier.
  const Quaternion to_carrier =
      bodies.initial_orientation(mount).conjugate() * bodies.initial_orientation(index);
  link.carrier = mount;
  link.mounted = true;
  link.center = bodies[index].mount_position + to_carrier * body_center;
  link.normal = to_carrier * plane_normal;
  if ((to_carrier * body_center).cross(bodies[index].axis).norm() > 1e-9 * size) {
    return Error{path + "/center", "the wheel on the mounted rotor \"" + bodies.name(index) +
                                       "\" must be centred on its axle"};
  }
  return link;
}

}  // namespace sheave
