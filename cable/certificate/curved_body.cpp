// Geodesics on cones, tori and ellipsoids, checked without a search and without integration.
//
// On a body of revolution a geodesic keeps its moment about the axis (Clairaut), and on an ellipsoid
// |D x|^2 (t.D t) with D = diag(1 / a^2) (Joachimsthal). Differences of the reported points show
// whether the path between the ends is a geodesic of the reported length.

#include "cable/certificate/curved_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cable/certificate/checks.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/torus.h"

namespace sheave::certify {
namespace {

std::optional<CurvedBody> body_of(const Shape& shape) {
  CurvedBody body;
  if (const auto* cone = dynamic_cast<const Cone*>(&shape)) {
    body.kind = CurvedBody::Kind::cone;
    body.sizes = {cone->radius, cone->top_radius, cone->length};
  } else if (const auto* torus = dynamic_cast<const Torus*>(&shape)) {
    body.kind = CurvedBody::Kind::torus;
    body.sizes = {torus->radius, torus->tube_radius, torus->tube_radius};
  } else if (const auto* ellipsoid = dynamic_cast<const Ellipsoid*>(&shape)) {
    body.sizes = ellipsoid->half_axes;
  } else {
    return std::nullopt;
  }
  return body;
}

bool may_be_geodesic(const LinkReport& link) {
  return (link.type == "surface" || link.type == "wrap") && !link.path.empty() && !link.surface;
}

double off_moment_of(const CurvedBody& body, const LinkReport& link, const Vector3& in,
                     const Vector3& out) {
  const Vector3 entry = link.entry - body.center;
  const Vector3 exit = link.exit - body.center;
  if (body.kind != CurvedBody::Kind::ellipsoid) {
    return std::abs(body.axes.col(2).dot(exit.cross(out) - entry.cross(in)));
  }
  const auto number = [&](const Vector3& point, const Vector3& tangent) {
    return body.gradient(point).squaredNorm() * body.gradient(tangent).dot(tangent);
  };
  const double change = std::abs(number(entry, in) / number(exit, out) - 1.0);
  return body.sizes.minCoeff() / body.sharpness() * change;
}

/// Differences of the path.
struct PathRates {
  Vector3 rate;
  Vector3 bend;
};
template <std::size_t reach>
PathRates path_rates(const std::vector<Vector3>& path, std::size_t i, double spacing,
                     const std::array<double, reach>& first,
                     const std::array<double, reach + 1>& second) {
  PathRates rates{Vector3::Zero(), second[0] * path[i]};
  for (std::size_t k = 1; k <= reach; ++k) {
    rates.rate += first[k - 1] * (path[i + k] - path[i - k]);
    rates.bend += second[k] * (path[i + k] + path[i - k]);
  }
  return {rates.rate / spacing, rates.bend / (spacing * spacing)};
}

/// How far the points of the path are from a geodesic of the reported length at equal distances: on
/// the surface, with the speed 1, and with no acceleration along the surface [m]. The difference
/// between the orders 6 and 8 is the error of the lower one, and more than that of the higher.
double off_path(const CurvedBody& body, const LinkReport& link) {
  constexpr std::size_t reach = 4;
  const std::vector<Vector3>& path = link.path;
  const double length = link.stored_length + link.stored_stretch;
  if (path.size() < 2 * reach + 1 || !(length > 0.0)) return 0.0;
  const auto steps = static_cast<double>(path.size() - 1);
  const double spacing = length / steps;
  double off = std::max((path.front() - link.entry).norm(), (path.back() - link.exit).norm());
  for (std::size_t i = reach; i + reach < path.size(); ++i) {
    const PathRates low = path_rates<3>(path, i, spacing, {3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0},
                                        {-49.0 / 18.0, 3.0 / 2.0, -3.0 / 20.0, 1.0 / 90.0});
    const PathRates high =
        path_rates<reach>(path, i, spacing, {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0},
                          {-205.0 / 72.0, 8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0});
    const Outward at = body.outward_at(path[i]);
    const auto sideways = [&](const PathRates& rates) -> Vector3 {
      return rates.bend - rates.bend.dot(at.normal) * at.normal;
    };
    const double truncated = (sideways(high) - sideways(low)).norm();
    // Rounding of the points counts n^2 times in the bend.
    const double noise = 1e-15 * steps * steps * (path[i].norm() + length);
    const double bend = 0.125 * length * length * (sideways(high).norm() - truncated) - noise;
    const double speed =
        length * (std::abs(high.rate.norm() - 1.0) - (high.rate - low.rate).norm()) - noise;
    off = std::max({off, at.off, bend, speed});
  }
  return off;
}

}  // namespace

Vector3 CurvedBody::gradient(const Vector3& vector) const {
  const Vector3 squares = sizes.cwiseProduct(sizes);
  return axes * Vector3((axes.transpose() * vector).cwiseQuotient(squares));
}

double CurvedBody::sharpness() const {
  if (kind != Kind::ellipsoid) return 1.0;
  const double ratio = sizes.maxCoeff() / sizes.minCoeff();
  return ratio * ratio;
}

Outward CurvedBody::outward_at(const Vector3& point) const {
  const Vector3 arm = point - center;
  if (kind == Kind::ellipsoid) {
    const Vector3 slope = gradient(arm);
    const double size = slope.norm();
    return {slope / size, 0.5 * std::abs(slope.dot(arm) - 1.0) / size};
  }
  const Vector3 axis = axes.col(2);
  const double height = axis.dot(arm);
  const Vector3 level = arm - height * axis;
  const double out = level.norm();
  if (kind == Kind::torus) {
    const Vector3 spoke = arm - sizes[0] / out * level;
    return {spoke.normalized(), std::abs(spoke.norm() - sizes[1])};
  }
  const double growth = (sizes[1] - sizes[0]) / sizes[2];
  const Vector3 normal = level / out - growth * axis;
  const double radius = 0.5 * (sizes[0] + sizes[1]) + growth * height;
  return {normal.normalized(), std::abs(out - radius) / normal.norm()};
}

std::optional<CurvedBody> curved_body(const Evidence& evidence, const LinkReport& link) {
  if (!may_be_geodesic(link) || link.body.is_world()) return std::nullopt;
  const int index = link.body.index;
  const BodyState& state = evidence.end.bodies[at(index)];
  std::optional<CurvedBody> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const PlacedShape& placed : evidence.bodies.definition(index).shapes) {
    std::optional<CurvedBody> body = body_of(*placed.shape);
    if (!body) continue;
    const Vector3 own = placed.position - evidence.bodies[index].center_of_mass;
    body->center = state.position + state.orientation * own;
    body->axes = (state.orientation * placed.orientation.normalized()).toRotationMatrix();
    const double off = body->outward_at(link.entry).off;
    if (off >= least) continue;
    least = off;
    nearest = body;
  }
  return nearest;
}

double off_curved_body(const CurvedBody& body, const LinkReport& link, const Vector3& in,
                       const Vector3& out) {
  const Outward entry = body.outward_at(link.entry);
  const Outward exit = body.outward_at(link.exit);
  const double size = body.sizes.minCoeff() > 0.0 ? body.sizes.minCoeff() : body.sizes.maxCoeff();
  return std::max({entry.off, exit.off, size * std::abs(entry.normal.dot(in)),
                   size * std::abs(exit.normal.dot(out)), off_moment_of(body, link, in, out),
                   off_path(body, link)});
}

bool lies_on_curved_body(const Evidence& evidence, const LinkReport& link) {
  return curved_body(evidence, link).has_value();
}

}  // namespace sheave::certify
