#include "tests/property/mirror.h"

#include <algorithm>
#include <stdexcept>

#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/shapes/half_space.h"
#include "tests/property/link_change.h"
#include "tests/property/machine_values.h"
#include "tests/support/shapes.h"

namespace sheave::test {
namespace {

Winding other(Winding winding) { return winding == left ? right : left; }

std::shared_ptr<const Shape> mirrored_shape(const std::shared_ptr<const Shape>& shape) {
  const auto turned_over = [](std::vector<Vector3> points) {
    for (Vector3& point : points) point = test::mirrored(point);
    return points;
  };
  if (const auto* prism = dynamic_cast<const Prism*>(shape.get())) {
    return polygon(turned_over(prism->outline), prism->length);
  }
  if (const auto* hull = dynamic_cast<const Polyhedron*>(shape.get())) {
    return polyhedron(turned_over(hull->points));
  }
  if (const auto* space = dynamic_cast<const HalfSpace*>(shape.get())) {
    return make<HalfSpace>([&](HalfSpace& s) { s.normal = test::mirrored(space->normal); });
  }
  return shape;  // boxes and cylinders are their own mirror image
}

BodyDef mirrored_body(BodyDef body) {
  if (body.axis) body.axis = test::mirrored(*body.axis);
  body.position = test::mirrored(body.position);
  body.orientation = test::mirrored(body.orientation);
  body.velocity = test::mirrored(body.velocity);
  body.angular_velocity = mirrored_axial(body.angular_velocity);
  body.force = test::mirrored(body.force);
  body.torque = mirrored_axial(body.torque);
  body.oscillation = test::mirrored(body.oscillation);
  for (double& value : body.drive_values) value = -value;  // about an axis mirrored as a polar one
  for (PlacedShape& placed : body.shapes) {
    placed.position = test::mirrored(placed.position);
    placed.orientation = test::mirrored(placed.orientation);
    placed.shape = mirrored_shape(placed.shape);
  }
  return body;
}

/// The coordinate counted the other way.
void turn_round(JointCoordinate& c) {
  std::swap(c.lower, c.upper);
  for (std::optional<double>* stop : {&c.lower, &c.upper}) {
    if (*stop) **stop = -**stop;
  }
  c.rest = -c.rest;
  for (double& value : c.drive_values) value = -value;
  c.drive_amplitude = -c.drive_amplitude;
}

/// Axes of rotation are mirrored as axial vectors, so that angles keep their signs; directions of
/// translation as polar ones.
void mirror_joint(JointDef& any) {
  const auto polar = [](Vector3& v) { v = test::mirrored(v); };
  const auto axial = [](Vector3& v) { v = mirrored_axial(v); };
  if (auto* j = dynamic_cast<HingeJoint*>(&any)) polar(j->anchor), axial(j->axis);
  if (auto* j = dynamic_cast<SliderJoint*>(&any)) polar(j->anchor), polar(j->axis);
  if (auto* j = dynamic_cast<PlaneJoint*>(&any)) polar(j->anchor), axial(j->normal);
  if (auto* j = dynamic_cast<FixedJoint*>(&any)) polar(j->anchor);
  if (auto* j = dynamic_cast<DistanceJoint*>(&any)) polar(j->anchor_a), polar(j->anchor_b);
  if (auto* j = dynamic_cast<GearJoint*>(&any)) axial(j->axis_a), axial(j->axis_b);
  if (auto* j = dynamic_cast<CylindricalJoint*>(&any)) {
    polar(j->anchor), polar(j->axis);
    turn_round(j->angle);
  }
  if (auto* j = dynamic_cast<BallJoint*>(&any)) {
    polar(j->anchor);
    // Without an axis there is no twist, and swing has no direction.
    if (j->axis) axial(*j->axis);
  }
  if (auto* j = dynamic_cast<UniversalJoint*>(&any)) {
    polar(j->anchor), axial(j->axis_a), axial(j->axis_b);
  }
  if (auto* j = dynamic_cast<RackJoint*>(&any)) {
    axial(j->axis), polar(j->direction), polar(j->anchor);
  }
}

}  // namespace

Machine mirrored(const Machine& machine) {
  Machine image = machine;
  image.model.gravity = mirrored(machine.model.gravity);
  for (BodyDef& body : image.model.bodies) body = mirrored_body(body);
  for (auto& joint : image.model.joints) {
    auto copy = copy_of(*joint);
    mirror_joint(*copy);
    joint = copy;
  }
  if (image.model.ground) {
    image.model.ground->point = mirrored(image.model.ground->point);
    image.model.ground->normal = mirrored(image.model.ground->normal);
  }
  for (CableDef& cable : image.cables) {
    for (auto& link : cable.links) {
      link = changed(
          *link, [](auto& point) { point.point = mirrored(point.point); },
          [](auto& wheel) {
            wheel.winding = other(*wheel.winding);
            if (wheel.center) wheel.center = mirrored(*wheel.center);
            if (wheel.normal) wheel.normal = mirrored(*wheel.normal);
          });
    }
  }
  return image;
}

Machine reversed(const Machine& machine) {
  Machine result = machine;
  for (CableDef& cable : result.cables) {
    // Of a belt the first link stays the first, and span k becomes span n - 1 - k either way.
    std::reverse(cable.links.begin() + (cable.closed ? 1 : 0), cable.links.end());
    std::reverse(cable.rest_lengths.begin(), cable.rest_lengths.end());
    for (auto& link : cable.links) {
      link = changed(
          *link, [](auto&) {}, [](auto& wheel) { wheel.winding = other(*wheel.winding); });
    }
  }
  return result;
}

}  // namespace sheave::test
