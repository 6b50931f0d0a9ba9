#include "cable/links/surface.h"

#include <array>
#include <cmath>
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
          "side, or side_point"),
      choice_field<&SurfaceLink::side>(
          "side", std::span(side_names).first<2>(), optional,
          "instead of winding: the side of the cable's way on which the body lies, seen against "
          "the normal (left: counter-clockwise)"),
      field<&SurfaceLink::normal>("normal", "", any_number(), optional,
                                  "direction from which the winding is seen, body frame; default: "
                                  "the z axis of the body's shape"),
      field<&SurfaceLink::side_point>(
          "side_point", "m", any_number(), optional,
          "point outside the shape, body frame, on whose side the cable "
          "passes the body at time 0; of a torus it selects the place, too"),
      field<&SurfaceLink::friction>("friction", "", at_least(0.0), optional,
                                    "capstan coefficient along the cable; nothing holds the cable "
                                    "sideways"),
      field<&SurfaceLink::shape>("shape", "", between(0, 4095), optional,
                                 "which of the body's shapes, from 0: a sphere, a cylinder, a "
                                 "capsule, a cone, a torus or an ellipsoid"),
      field<&SurfaceLink::lifted>("lifted", "", {}, optional,
                                  "whether the cable passes the body by at time 0; it is laid on "
                                  "when it comes to touch it"),
  };
  return table;
}

namespace {

/// The faults of the settings by which a surface link tells its side.
Errors check_side(const SurfaceLink& link, const SmoothSurface& surface,
                  const std::optional<Vector3>& side, const std::string& path) {
  const bool turns = link.winding || link.side;
  if (turns == link.side_point.has_value()) {
    return {{path + (turns ? "/side_point" : "/winding"),
             "a surface link needs exactly one of \"winding\", \"side\" and \"side_point\", which "
             "say on which side the cable passes the body"}};
  }
  if (link.normal && !turns) {
    return {
        {path + "/normal",
         "\"normal\" belongs to \"winding\" or \"side\"; leave it out, or give one of these for "
         "\"side_point\""}};
  }
  if (side && surface.contains(*side)) {
    return {{path + "/side_point",
             "the point lies inside the shape; give one outside, on the side of the cable"}};
  }
  if (link.normal && !(link.normal->norm() > 1e-12)) {
    return {{path + "/normal", "the normal must have a direction; its length is 0"}};
  }
  if (surface.form == SurfaceForm::cylinder && link.normal &&
      std::abs(link.normal->normalized().dot(surface.axis)) < 1e-6) {
    return {{path + "/normal",
             "the normal must not be perpendicular to the axis of the "
             "cylinder, because the cable runs round the axis"}};
  }
  return {};
}

}  // namespace

Result<LinkGeometry> SurfaceLink::compile(const BodySet& bodies, const std::string& path) const {
  int turns = 1;
  if (winding || side) {
    const Result<int> given = given_side(winding, side, path);
    if (!given) return given.errors();
    turns = *given;
  }
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
    return Error{path + "/body",
                 "a surface link needs a sphere, a cylinder, a capsule, a cone, a torus or an "
                 "ellipsoid; " +
                     name + (shapes == 0 ? " has no shape" : " has another shape there") +
                     "; choose one by \"shape\", or use a \"rolling\" link"};
  }
  std::optional<Vector3> beside;
  if (side_point) beside = *side_point - bodies[index].center_of_mass;
  const Errors errors = check_side(*this, *surface, beside, path);
  if (!errors.empty()) return errors.front();
  const Vector3 seen_from = normal ? Vector3(normal->normalized()) : surface->axis;
  LinkGeometry link;
  link.body = link.carrier = index;
  link.mounted = bodies[index].mount >= 0;
  link.given_stored_length = std::numeric_limits<double>::quiet_NaN();
  link.friction = friction;
  link.starts_lifted = lifted;
  link.geodesic.emplace().surface = *surface;
  const Vector3 across = turns > 0 ? seen_from : Vector3(-seen_from);
  link.geodesic->about = across;
  link.geodesic->beside = beside;
  start_geodesic(link, surface->center + surface->radius * any_perpendicular(across), across, 0.0);
  return link;
}

}  // namespace sheave
