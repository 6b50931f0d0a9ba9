#include "cable/links/surface.h"

#include <limits>

#include "cable/link_geometry.h"
#include "cable/wrap_candidate.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> SurfaceLink::field_table() {
  static const std::array table{
      choice_field<&SurfaceLink::winding>(
          "winding", winding_names, optional,
          "side on which the cable passes the body: which way it runs round the normal; or give "
          "side"),
      choice_field<&SurfaceLink::side>(
          "side", std::span(side_names).first<2>(), optional,
          "instead of winding: the side of the cable's way on which the body lies, seen against "
          "the normal (left: counter-clockwise)"),
      field<&SurfaceLink::normal>("normal", "", any_number(), optional,
                                  "direction from which the winding is seen, body frame; default: "
                                  "the z axis of the body's shape"),
      field<&SurfaceLink::friction>("friction", "", at_least(0.0), optional,
                                    "capstan coefficient along the cable; nothing holds the cable "
                                    "sideways"),
      field<&SurfaceLink::shape>("shape", "", between(0, 4095), optional,
                                 "which of the body's shapes, from 0: a sphere, a cylinder or a "
                                 "capsule"),
      field<&SurfaceLink::lifted>("lifted", "", {}, optional,
                                  "whether the cable passes the body by at time 0; it is laid on "
                                  "when it comes to touch it"),
  };
  return table;
}

Result<LinkGeometry> SurfaceLink::compile(const BodySet& bodies, const std::string& path) const {
  const Result<int> turns = given_side(winding, side, path);
  if (!turns) return turns.errors();
  const int index = bodies.index(body);
  const std::string name = "\"" + bodies.name(index) + "\"";
  if (bodies[index].massless()) {
    return Error{path + "/body", name +
                                     " has no spin inertia, so it turns with the cable; use a "
                                     "\"rolling\" link"};
  }
  const int shapes = body.is_world() ? 0 : static_cast<int>(bodies.definition(index).shapes.size());
  if (shapes > 0 && shape >= shapes) {
    return Error{path + "/shape", name + " has " + std::to_string(shapes) +
                                      (shapes == 1 ? " shape" : " shapes") +
                                      "; the first one has the number 0"};
  }
  std::optional<SmoothSurface> surface;
  if (shapes > 0) surface = smooth_surface(bodies, index, shape);
  if (!surface) {
    return Error{path + "/body", "a surface link needs a sphere, a cylinder or a capsule; " + name +
                                     (shapes == 0 ? " has no shape" : " has another shape there") +
                                     "; choose one by \"shape\", or use a \"rolling\" link"};
  }
  Vector3 seen_from = surface->axis;
  if (normal) {
    if (!(normal->norm() > 1e-12)) {
      return Error{path + "/normal", "the normal must have a direction; its length is 0"};
    }
    seen_from = normal->normalized();
  }
  if (!surface->round_ends && std::abs(seen_from.dot(surface->axis)) < 1e-6) {
    return Error{path + "/normal",
                 "the normal must not be perpendicular to the axis of the "
                 "cylinder, because the cable runs round the axis"};
  }
  LinkGeometry link;
  link.body = link.carrier = index;
  link.mounted = bodies[index].mount >= 0;
  link.given_stored_length = std::numeric_limits<double>::quiet_NaN();
  link.friction = friction;
  link.starts_lifted = lifted;
  link.geodesic.emplace().surface = *surface;
  const Vector3 across = *turns > 0 ? seen_from : Vector3(-seen_from);
  start_geodesic(link, surface->center + surface->radius * any_perpendicular(across), across, 0.0);
  return link;
}

}  // namespace sheave
