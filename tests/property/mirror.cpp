#include "tests/property/mirror.h"

#include <algorithm>
#include <stdexcept>

#include "cable/links/hybrid.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
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
  for (PlacedShape& placed : body.shapes) {
    placed.position = test::mirrored(placed.position);
    placed.orientation = test::mirrored(placed.orientation);
    placed.shape = mirrored_shape(placed.shape);
  }
  return body;
}

/// A copy of a link, changed by `point` (attachments and pinholes) or `wheel` (all others).
template <class Point, class Wheel>
std::shared_ptr<const LinkDef> changed(const LinkDef& link, Point point, Wheel wheel) {
  const auto copy = [&](const auto* original, auto change) {
    auto result = std::make_shared<std::remove_cvref_t<decltype(*original)>>(*original);
    change(*result);
    return std::shared_ptr<const LinkDef>(result);
  };
  if (const auto* a = dynamic_cast<const AttachmentLink*>(&link)) return copy(a, point);
  if (const auto* p = dynamic_cast<const PinholeLink*>(&link)) return copy(p, point);
  if (const auto* r = dynamic_cast<const RollingLink*>(&link)) return copy(r, wheel);
  if (const auto* h = dynamic_cast<const HybridLink*>(&link)) return copy(h, wheel);
  if (const auto* s = dynamic_cast<const SpoolLink*>(&link)) return copy(s, wheel);
  throw std::logic_error("no such link type");
}

}  // namespace

Machine mirrored(const Machine& machine) {
  Machine image = machine;
  image.model.gravity = mirrored(machine.model.gravity);
  for (BodyDef& body : image.model.bodies) body = mirrored_body(body);
  for (CableDef& cable : image.cables) {
    for (auto& link : cable.links) {
      link = changed(
          *link, [](auto& point) { point.point = mirrored(point.point); },
          [](auto& wheel) {
            wheel.winding = other(wheel.winding);
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
          *link, [](auto&) {}, [](auto& wheel) { wheel.winding = other(wheel.winding); });
    }
  }
  return result;
}

}  // namespace sheave::test
