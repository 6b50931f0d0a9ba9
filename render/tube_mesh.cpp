#include "render/tube_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sheave::render {
namespace {

std::array<float, 3> to_float(const Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Paint to_paint(const Color& c) {
  const auto byte = [](float x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0F, 1.0F) * 255.0F));
  };
  return {byte(c.r), byte(c.g), byte(c.b), 0};
}

/// The points without those that coincide with their predecessor, because such points have no
/// direction.
std::vector<TubePoint> distinct_points(const Tube& tube) {
  std::vector<TubePoint> points;
  double scale = 0.0;
  for (const TubePoint& p : tube.points) scale = std::max(scale, p.position.cwiseAbs().maxCoeff());
  const double nearest = std::max(1e-3 * tube.radius, 1e-12 * scale);
  for (const TubePoint& p : tube.points) {
    if (points.empty() || (p.position - points.back().position).norm() > nearest)
      points.push_back(p);
  }
  if (tube.closed && points.size() > 2) points.push_back(points.front());
  return points;
}

/// Direction of the line at each point; the bisector at corners.
std::vector<Vector3> tangents_of(const std::vector<TubePoint>& points, bool closed) {
  std::vector<Vector3> tangents;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    Vector3 before = Vector3::Zero();
    Vector3 after = Vector3::Zero();
    if (i > 0) before = (points[i].position - points[i - 1].position).normalized();
    if (i + 1 < n) after = (points[i + 1].position - points[i].position).normalized();
    if (closed && i == 0) before = (points[0].position - points[n - 2].position).normalized();
    if (closed && i + 1 == n) after = (points[1].position - points[0].position).normalized();
    const Vector3 sum = before + after;
    // At a full reversal the bisector vanishes; the incoming direction replaces it.
    tangents.push_back(sum.norm() > 1e-6 ? Vector3(sum.normalized()) : before);
  }
  return tangents;
}

/// Adds one ring of vertices; `slope` leans the normals along the tangent (for the ends).
struct Sweep {
  Mesh& mesh;
  int sides;

  void ring(const Vector3& centre, const Vector3& u, const Vector3& v, double radius,
            const Vector3& lean, double share, const Paint& paint) const {
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * pi * s / sides;
      const Vector3 out = u * std::cos(angle) + v * std::sin(angle);
      const Vector3 normal = out * std::sqrt(std::max(0.0, 1.0 - share * share)) + lean * share;
      const std::array<float, 3> n = to_float(normal);
      mesh.vertices.push_back({to_float(centre + out * radius), n, n, paint});
    }
  }
  /// Joins the last two rings.
  void join() const {
    const auto count = static_cast<std::uint32_t>(sides);
    const auto second = static_cast<std::uint32_t>(mesh.vertices.size()) - count;
    const std::uint32_t first = second - count;
    for (std::uint32_t s = 0; s < count; ++s) {
      const std::uint32_t next = (s + 1) % count;
      mesh.triangles.insert(mesh.triangles.end(), {first + s, first + next, second + next,
                                                   first + s, second + next, second + s});
    }
  }
  /// Adds a half ball as a few rings from a point (at the start) or to a point (at the end).
  void cap(const Vector3& centre, const Vector3& u, const Vector3& v, double radius,
           const Vector3& outward, bool at_start, const Paint& paint) const {
    constexpr int steps = 3;
    for (int k = 0; k < steps; ++k) {
      const int step = at_start ? steps - k : k + 1;
      const double latitude = 0.5 * pi * step / steps;
      const double share = std::sin(latitude);
      ring(centre + outward * (radius * share), u, v, radius * std::cos(latitude), outward, share,
           paint);
      if (!at_start || k > 0) join();
    }
  }
};

}  // namespace

void append_tube(const Tube& tube, const Vector3& origin, int sides, Mesh& mesh) {
  const std::vector<TubePoint> points = distinct_points(tube);
  if (points.size() < 2) return;
  const std::vector<Vector3> tangents = tangents_of(points, tube.closed);
  const Sweep sweep{mesh, sides};
  Vector3 u = any_perpendicular(tangents.front());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3& tangent = tangents[i];
    // Carrying the frame along without twist keeps the facets of neighbouring rings aligned.
    u -= tangent * tangent.dot(u);
    u = u.norm() > 1e-6 ? Vector3(u.normalized()) : any_perpendicular(tangent);
    const Vector3 v = tangent.cross(u);
    const Vector3 centre = points[i].position - origin;
    const Paint paint = to_paint(points[i].color);
    const bool first = i == 0;
    const bool last = i + 1 == points.size();
    if (first && !tube.closed) sweep.cap(centre, u, v, tube.radius, -tangent, true, paint);
    sweep.ring(centre, u, v, tube.radius, tangent, 0.0, paint);
    if (!first || !tube.closed) sweep.join();
    if (last && !tube.closed) sweep.cap(centre, u, v, tube.radius, tangent, false, paint);
  }
}

}  // namespace sheave::render
