// Fitting a box exactly: write the camera's eye as e and a corner as c in the picture's axes (x
// right, y up, z towards the eye), with depth w = e_z - c_z and t the tangent of half the opening
// angle. The corner is inside the part [l, r] of the picture's width if  l t w <= c_x - e_x <= r t
// w.  Both bounds are linear in e_x and e_z; the tightest corners on either side give the smallest
// e_z and the e_x between them. The same holds for y, and the larger e_z of the two decides.
#include "render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sheave::render {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool finite(const Vector3& v) { return v.allFinite(); }

CameraAxes axes_along(const Vector3& direction, const Vector3& up) {
  const Vector3 back = -direction.normalized();
  Vector3 right = up.cross(back);
  // A view along `up` has no unique right; any perpendicular serves.
  right = right.norm() > 1e-9 * up.norm() ? Vector3(right.normalized()) : any_perpendicular(back);
  return {right, back.cross(right), back};
}

/// Bounds that one axis of the picture sets for the eye's coordinate and distance.
struct AxisFit {
  double low_limit =
      -infinity;  ///< max of c - r t (-c_z): the eye must be right of it plus r t e_z
  double high_limit = infinity;
  double low = -1.0, high = 1.0;  ///< allowed part of the picture, times t

  void add(double c, double z) {
    low_limit = std::max(low_limit, c + high * z);
    high_limit = std::min(high_limit, c + low * z);
  }
  /// Smallest z of the eye for which a place exists.
  [[nodiscard]] double nearest_eye() const { return (low_limit - high_limit) / (high - low); }
  [[nodiscard]] double centre(double eye_z) const {
    return 0.5 * (low_limit - high * eye_z + high_limit - low * eye_z);
  }
};

std::array<Vector3, 8> corners_in(const CameraAxes& a, const Eigen::AlignedBox3d& box) {
  std::array<Vector3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3 c = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    corners[static_cast<std::size_t>(i)] = {a.right.dot(c), a.up.dot(c), a.back.dot(c)};
  }
  return corners;
}

/// The part of [-1, 1] of one axis that the margins leave.
std::pair<double, double> allowed(double low_margin, double high_margin) {
  const double low = std::clamp(low_margin, 0.0, 0.45);
  const double high = std::clamp(high_margin, 0.0, 0.45);
  return {-1.0 + 2.0 * low, 1.0 - 2.0 * high};
}

/// Fits an orthographic picture. Distance has no effect here, only width and height: the middle of
/// the allowed part of the picture falls on the middle of the box.
Camera frame_orthographic(const std::array<Vector3, 8>& corners, const CameraAxes& a,
                          const FrameOptions& options) {
  Vector3 low = corners[0];
  Vector3 high = corners[0];
  for (const Vector3& c : corners) {
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  const auto [left, right] = allowed(options.margins.left, options.margins.right);
  const auto [bottom, top] = allowed(options.margins.bottom, options.margins.top);
  const double half_height = std::max((high.y() - low.y()) / (top - bottom),
                                      (high.x() - low.x()) / ((right - left) * options.aspect));
  const double x = 0.5 * (low.x() + high.x()) - 0.5 * (left + right) * half_height * options.aspect;
  const double y = 0.5 * (low.y() + high.y()) - 0.5 * (bottom + top) * half_height;
  const Vector3 target = a.right * x + a.up * y + a.back * (0.5 * (low.z() + high.z()));
  const double distance = (high.z() - low.z()) + 4.0 * half_height;
  return {target + a.back * distance, target, a.up, Orthographic{2.0 * half_height}};
}

Camera frame_perspective(const std::array<Vector3, 8>& corners, const CameraAxes& a,
                         const FrameOptions& options, const Perspective& perspective) {
  const double t = std::tan(0.5 * perspective.vertical_fov);
  const auto [left, right] = allowed(options.margins.left, options.margins.right);
  const auto [bottom, top] = allowed(options.margins.bottom, options.margins.top);
  AxisFit x{.low = left * t * options.aspect, .high = right * t * options.aspect};
  AxisFit y{.low = bottom * t, .high = top * t};
  double nearest = -infinity;
  double middle = 0.0;
  for (const Vector3& c : corners) {
    x.add(c.x(), c.z());
    y.add(c.y(), c.z());
    nearest = std::max(nearest, c.z());
    middle += c.z() / 8.0;
  }
  // The eye stays in front of the whole box even where the box is very thin.
  const double size = nearest - middle;
  const double eye_z = std::max({x.nearest_eye(), y.nearest_eye(), nearest + 0.01 * size});
  const Vector3 eye = a.right * x.centre(eye_z) + a.up * y.centre(eye_z) + a.back * eye_z;
  return {eye, eye - a.back * (eye_z - middle), a.up, perspective};
}

}  // namespace

Errors validate(const Camera& camera) {
  Errors errors;
  if (!finite(camera.position) || !finite(camera.target) || !finite(camera.up)) {
    errors.push_back({"/camera", "camera: position, target and up must be finite numbers"});
    return errors;
  }
  const Vector3 view = camera.target - camera.position;
  if (!(view.norm() > 0.0)) {
    errors.push_back({"/camera/target", "camera: target must not be at the position of the eye"});
  } else if (!(view.normalized().cross(camera.up).norm() > 1e-9 * camera.up.norm())) {
    errors.push_back({"/camera/up", "camera: up must not be zero or along the view direction"});
  }
  if (const auto* p = std::get_if<Perspective>(&camera.projection)) {
    if (!(p->vertical_fov > 0.0 && p->vertical_fov < pi)) {
      errors.push_back({"/camera/vertical_fov", "camera: vertical_fov is " +
                                                    std::to_string(p->vertical_fov) +
                                                    " rad; it must lie between 0 and pi"});
    }
  } else if (const auto* o = std::get_if<Orthographic>(&camera.projection)) {
    if (!(o->height > 0.0 && o->height < infinity)) {
      errors.push_back({"/camera/height", "camera: height is " + std::to_string(o->height) +
                                              " m; it must be positive and finite"});
    }
  }
  return errors;
}

CameraAxes axes(const Camera& camera) {
  return axes_along(camera.target - camera.position, camera.up);
}

Projector::Projector(const Camera& camera, int width, int height)
    : camera_(camera), axes_(axes(camera)), width_(width), height_(height) {
  if (const auto* p = std::get_if<Perspective>(&camera.projection)) {
    focal_ = 0.5 * height_ / std::tan(0.5 * p->vertical_fov);
  }
}

double Projector::depth_of(const Vector3& point) const {
  return -axes_.back.dot(point - camera_.position);
}

double Projector::scale_at(double depth) const {
  if (const auto* o = std::get_if<Orthographic>(&camera_.projection)) return height_ / o->height;
  return focal_ / depth;
}

std::optional<ScreenPoint> Projector::project(const Vector3& point) const {
  const Vector3 d = point - camera_.position;
  const double depth = -axes_.back.dot(d);
  if (std::holds_alternative<Perspective>(camera_.projection) && !(depth > 0.0))
    return std::nullopt;
  const double scale = scale_at(depth);
  return ScreenPoint{0.5 * width_ + axes_.right.dot(d) * scale,
                     0.5 * height_ - axes_.up.dot(d) * scale, depth};
}

Camera frame_box(const Eigen::AlignedBox3d& box, const Vector3& direction, const Vector3& up,
                 const FrameOptions& options) {
  Eigen::AlignedBox3d shown = box;
  if (shown.isEmpty()) shown.extend(Eigen::Vector3d::Zero());
  if (!(shown.diagonal().norm() > 0.0)) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);
    shown = {Eigen::Vector3d(shown.center() - half), Eigen::Vector3d(shown.center() + half)};
  }
  const CameraAxes a = axes_along(direction, up);
  const std::array<Vector3, 8> corners = corners_in(a, shown);
  if (const auto* p = std::get_if<Perspective>(&options.projection)) {
    return frame_perspective(corners, a, options, *p);
  }
  return frame_orthographic(corners, a, options);
}

Vector3 default_view_direction(const Vector3& up, const std::optional<Vector3>& plane_normal) {
  const Vector3 u = up.normalized();
  double from_side = 0.6;    // [rad] turned about up, to the right of the front
  double from_above = 0.35;  // [rad]
  Vector3 front = std::abs(u.z()) < 0.9 ? Vector3::UnitZ() : Vector3(-Vector3::UnitY());
  if (plane_normal && plane_normal->norm() > 0.0) {
    front = plane_normal->normalized();
    from_side = 0.22;
    from_above = 0.12;
  }
  front -= u * u.dot(front);
  // If gravity is normal to the plane of the motion, the camera looks straight down.
  if (front.norm() < 1e-6) return -u;
  front.normalize();
  const Vector3 side = u.cross(front);
  const Vector3 level = front * std::cos(from_side) + side * std::sin(from_side);
  return -(level * std::cos(from_above) + u * std::sin(from_above));
}

}  // namespace sheave::render
