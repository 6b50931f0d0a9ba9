#include "cable/wrap_candidate.h"

#include <algorithm>
#include <cmath>

#include "cable/links/rolling.h"

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

}  // namespace

WrapCandidate wrap_candidate(const BodySet& bodies, int body) {
  const std::vector<PlacedShape>& shapes = bodies.definition(body).shapes;
  const PlacedShape* wheel = first_wheel(shapes);
  WrapCandidate candidate;
  candidate.body = body;
  // The centroid lies within the hull; the origin of a polyhedron need not.
  const Vector3 center = wheel != nullptr ? wheel->position : combine(shapes, 1.0).center_of_mass;
  candidate.center = center - bodies[body].center_of_mass;
  for (const PlacedShape& placed : shapes) {
    candidate.reach = std::max(
        candidate.reach, (placed.position - center).norm() + placed.shape->half_extent().norm());
  }
  const PlacedShape& form = wheel != nullptr ? *wheel : shapes.front();
  const std::string_view type = form.shape->type();
  const bool rotor = bodies[body].mobility == Mobility::rotor;
  candidate.ball = type == "sphere" && shapes.size() == 1 && !rotor;
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

WrapSide wrap_side(const Substep& substep, const WrapCandidate& candidate,
                   const SpanGeometry& span) {
  const Vector3 center = substep.point(candidate.body, candidate.center) - span.start;
  WrapSide side;
  side.moment = cross(span.direction, center);
  side.along = dot(span.direction, center);
  side.between = side.along > 0.0 && side.along < span.length;
  side.distance = (center - std::clamp(side.along, 0.0, span.length) * span.direction).norm();
  return side;
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
