#include "cable/wrap_candidate.h"

#include <algorithm>
#include <cmath>

#include "cable/links/rolling.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/torus.h"

namespace sheave {
namespace {

/// The shape that a wheel on the body would use (cable/links/wheel_link.h); null if there is none.
const PlacedShape* first_wheel(const std::vector<PlacedShape>& shapes) {
  const auto wheel = std::find_if(shapes.begin(), shapes.end(), [](const PlacedShape& placed) {
    return placed.shape->wheel_radius() > 0.0;
  });
  return wheel == shapes.end() ? nullptr : &*wheel;
}

/// Half the length of the shapes' bounding box along an axis through `center` [m].
double half_length_along(const std::vector<PlacedShape>& shapes, const Vector3& center,
                         const Vector3& axis) {
  double longest = 0.0;
  for (const PlacedShape& placed : shapes) {
    const Vector3 own = placed.orientation.conjugate() * axis;
    longest = std::max(longest, std::abs(axis.dot(placed.position - center)) +
                                    own.cwiseAbs().dot(placed.shape->half_extent()));
  }
  return longest;
}

/// The surface of a shape with this centre in the own frame of its body.
std::optional<SmoothSurface> surface_of(const PlacedShape& form, const Vector3& center) {
  SmoothSurface surface;
  surface.center = center;
  surface.axis = form.orientation * Vector3::UnitZ();
  surface.radius = form.shape->wheel_radius();
  if (const auto* bar = dynamic_cast<const Cylinder*>(form.shape.get())) {
    surface.half_length = 0.5 * bar->length;
    surface.form = SurfaceForm::cylinder;
  } else if (const auto* capsule = dynamic_cast<const Capsule*>(form.shape.get())) {
    surface.half_length = 0.5 * capsule->length;
  } else if (const auto* cone = dynamic_cast<const Cone*>(form.shape.get())) {
    surface.form = SurfaceForm::cone;
    surface.half_length = 0.5 * cone->length;
    surface.radius = 0.5 * (cone->radius + cone->top_radius);
    surface.slope = (cone->top_radius - cone->radius) / cone->length;
  } else if (const auto* torus = dynamic_cast<const Torus*>(form.shape.get())) {
    surface.form = SurfaceForm::torus;
    surface.radius = torus->tube_radius;
    surface.ring = torus->radius;
  } else if (const auto* egg = dynamic_cast<const Ellipsoid*>(form.shape.get())) {
    surface.form = SurfaceForm::ellipsoid;
    surface.side = form.orientation * Vector3::UnitX();
    surface.half_axes = egg->half_axes;
    surface.radius = portable::exp(portable::log(egg->half_axes.prod()) / 3.0);
  } else if (form.shape->type() != "sphere") {
    return std::nullopt;
  }
  return surface;
}

}  // namespace

SmoothSurface surface_now(const Substep& substep, int body, const SmoothSurface& surface) {
  SmoothSurface now = surface;
  now.center = substep.point(body, surface.center);
  now.axis = substep.orientation(body) * surface.axis;
  if (surface.form == SurfaceForm::ellipsoid) now.side = substep.orientation(body) * surface.side;
  return now;
}

std::optional<SmoothSurface> smooth_surface(const BodySet& bodies, int body, int shape) {
  const PlacedShape& form = bodies.definition(body).shapes[static_cast<std::size_t>(shape)];
  return surface_of(form, form.position - bodies[body].center_of_mass);
}

WrapCandidate listed_candidate(const LinkGeometry& link) {
  WrapCandidate candidate;
  candidate.body = link.body;
  candidate.surface = link.geodesic->surface;
  candidate.center = candidate.surface->center;
  candidate.reach = candidate.surface->reach();
  return candidate;
}

WrapCandidate wrap_candidate(const BodySet& bodies, int body) {
  const std::vector<PlacedShape>& shapes = bodies.definition(body).shapes;
  const PlacedShape* wheel = first_wheel(shapes);
  const PlacedShape& form = wheel != nullptr ? *wheel : shapes.front();
  WrapCandidate candidate;
  candidate.body = body;
  // A wheel without inertia turns with the cable; the cable does not slide over it.
  if (shapes.size() == 1 && !bodies[body].massless()) {
    candidate.surface = smooth_surface(bodies, body, 0);
  }
  // The centroid of a polyhedron lies within its hull; its origin need not.
  const bool has_origin_inside = wheel != nullptr || candidate.surface.has_value();
  const Vector3 center = has_origin_inside ? form.position : combine(shapes, 1.0).center_of_mass;
  candidate.center = center - bodies[body].center_of_mass;
  for (const PlacedShape& placed : shapes) {
    candidate.reach = std::max(
        candidate.reach, (placed.position - center).norm() + placed.shape->half_extent().norm());
  }
  const std::string_view type = form.shape->type();
  const bool rotor = bodies[body].mobility == Mobility::rotor;
  if (wheel == nullptr && shapes.size() > 1 && !rotor) return candidate;
  const auto add_axis = [&](const Vector3& axis) {
    candidate.axes.push_back({axis, half_length_along(shapes, center, axis)});
  };
  const Matrix3 axes = form.orientation.toRotationMatrix();
  if (type == "cylinder" || type == "prism" || rotor) add_axis(axes.col(2));
  if (type == "box" && !rotor) {
    for (int i = 0; i < 3; ++i) add_axis(axes.col(i));
  }
  return candidate;
}

namespace {

/// Whether two points of the core count as one place on the body. Near the middle of a torus's hole
/// the nearest point of the ring jumps, and the span has not passed through the tube.
bool is_same_place(const WrapCandidate& candidate, const Vector3& before, const Vector3& now) {
  return !is_geodesic(candidate) || candidate.surface->form != SurfaceForm::torus ||
         (now - before).norm() <= candidate.surface->radius;
}

}  // namespace

WrapSide wrap_side(const Substep& substep, const WrapCandidate& candidate, const SpanGeometry& span,
                   const WrapSide* before) {
  WrapSide side;
  Vector3 center = substep.point(candidate.body, candidate.center);
  if (is_geodesic(candidate)) {
    const Vector3 near =
        before != nullptr ? substep.point(candidate.body, before->core) : Vector3::Zero();
    center = core_passage(surface_now(substep, candidate.body, *candidate.surface), span.start,
                          span.direction, before != nullptr ? &near : nullptr)
                 .core;
    if (candidate.surface->form == SurfaceForm::torus) {
      side.core = substep.orientation(candidate.body).conjugate() *
                  (center - substep.position(candidate.body));
    }
  }
  center -= span.start;
  side.moment = cross(span.direction, center);
  side.along = dot(span.direction, center);
  side.between = side.along > 0.0 && side.along < span.length &&
                 (before == nullptr || is_same_place(candidate, before->core, side.core));
  side.distance = (center - std::clamp(side.along, 0.0, span.length) * span.direction).norm();
  return side;
}

std::optional<SurfaceTouch> surface_touch(const Substep& substep, const WrapCandidate& candidate,
                                          const SpanGeometry& span, const WrapSide& before) {
  const SmoothSurface surface = surface_now(substep, candidate.body, *candidate.surface);
  const Vector3 near = substep.point(candidate.body, before.core);
  const CorePassage passage = core_passage(surface, span.start, span.direction, &near);
  if (!(passage.along > 0.0) || !(passage.along < span.length) || passage.beyond > 0.0) {
    return std::nullopt;
  }
  const Vector3 place = substep.orientation(candidate.body).conjugate() *
                        (passage.core - substep.position(candidate.body));
  const Vector3 moment = is_same_place(candidate, before.core, place)
                             ? before.moment
                             : cross(span.direction, passage.core - span.start);
  Vector3 outward = passage.point - passage.core;
  double distance = outward.norm();
  if (distance > 1e-9 * surface.radius) {
    outward /= distance;
  } else {
    // The span passes through the core. The moment alone gives the side.
    const Vector3 side = cross(span.direction, moment);
    outward = side.norm() > 0.0 ? Vector3(side.normalized()) : any_perpendicular(span.direction);
  }
  if (dot(cross(outward, span.direction), moment) < 0.0) {
    outward = -outward;
    distance = -distance;
  }
  const SurfaceFrame now = touched_frame(surface, passage.core, outward, span.direction);
  SurfaceTouch touch;
  touch.depth = depth_of(surface, passage, span.direction, distance);
  const Quaternion to_own = substep.orientation(candidate.body).conjugate();
  touch.at.point = to_own * (now.point - substep.position(candidate.body));
  touch.at.tangent = to_own * now.tangent;
  touch.at.outward = to_own * now.outward;
  return touch;
}

LinkGeometry geodesic_link(const BodySet& bodies, const WrapCandidate& candidate,
                           const Vector3& point, const Vector3& across, double length) {
  LinkGeometry link;
  link.body = link.carrier = candidate.body;
  link.mounted = bodies[candidate.body].mount >= 0;
  link.lifts = true;
  link.geodesic.emplace().surface = *candidate.surface;
  start_geodesic(link, point, across, length);
  return link;
}

void start_geodesic(LinkGeometry& link, const Vector3& point, const Vector3& across,
                    double length) {
  GeodesicLink& geodesic = *link.geodesic;
  const Vector3 core = geodesic.surface.core(point);
  Vector3 outward = point - core;
  // States of older versions have the centre of a circle there.
  const bool inside = outward.norm() < 0.5 * geodesic.surface.radius &&
                      geodesic.surface.form != SurfaceForm::cone &&
                      geodesic.surface.form != SurfaceForm::ellipsoid;
  if (inside) outward = geodesic.surface.radius * any_perpendicular(across);
  geodesic.entry = geodesic.surface.frame(core + outward, cross(across, outward));
  geodesic.length = length;
  show_geodesic(link);
}

void show_geodesic(LinkGeometry& link) {
  GeodesicLink& geodesic = *link.geodesic;
  const SmoothSurface& surface = geodesic.surface;
  const SurfaceWay way = straightest_way(surface, geodesic.entry, geodesic.length);
  geodesic.exit = way.end;
  geodesic.turned = way.turned;
  const Vector3 across = geodesic.entry.across();
  link.center = surface.core(0.5 * (geodesic.entry.point + geodesic.exit.point));
  link.centered = link.center.isZero(0.0);
  link.normal = surface.form == SurfaceForm::cylinder ? surface.axis : across;
  link.side = dot(link.normal, across) < 0.0 ? -1 : 1;
  link.signed_radius = link.side * surface.bend_radius(geodesic.entry);
}

std::optional<WrapPlane> wrap_plane(const Substep& substep, const WrapCandidate& candidate,
                                    const SpanGeometry& span) {
  const Quaternion orientation = substep.orientation(candidate.body);
  const Vector3 center = substep.point(candidate.body, candidate.center) - span.start;
  Vector3 moment = cross(span.direction, center);
  // The span passes through the centre, so any plane through the span will do.
  if (!(moment.norm() > 0.0)) moment = any_perpendicular(span.direction);
  if (candidate.axes.empty()) {
    return WrapPlane{candidate.center, orientation.conjugate() * moment.normalized()};
  }
  const auto fit = [&](const WrapAxis& axis) {
    return std::abs(moment.dot(orientation * axis.direction));
  };
  const auto best =
      std::max_element(candidate.axes.begin(), candidate.axes.end(),
                       [&](const WrapAxis& a, const WrapAxis& b) { return fit(a) < fit(b); });
  // The point of the span that is nearest to the axis.
  const Vector3 axis = orientation * best->direction;
  const double cosine = dot(axis, span.direction);
  const double sine_squared = 1.0 - cosine * cosine;
  if (!(sine_squared > 1e-12)) return std::nullopt;
  const double along = std::clamp(
      (dot(span.direction, center) - cosine * dot(axis, center)) / sine_squared, 0.0, span.length);
  const double height = dot(axis, along * span.direction - center);
  if (std::abs(height) > best->half_length) return std::nullopt;
  return WrapPlane{candidate.center + height * best->direction, best->direction};
}

std::optional<LinkGeometry> wrap_link(const BodySet& bodies, const WrapCandidate& candidate,
                                      const WrapPlane& plane) {
  RollingLink wrap;
  wrap.body = BodyId{candidate.body};
  wrap.winding = Winding::counter_clockwise;
  wrap.center = plane.center + bodies[candidate.body].center_of_mass;
  wrap.normal = plane.normal;
  Result<LinkGeometry> link = wrap.compile(bodies, "");
  if (!link) return std::nullopt;
  link->centered = link->center.isZero(0.0);
  link->still = link->carrier == bodies.count();
  link->lifts = true;
  return std::move(*link);
}

}  // namespace sheave
