#pragma once
// Camera of a picture, and its placement so that everything is in the frame.

#include <optional>
#include <string>
#include <variant>

#include <Eigen/Geometry>

#include "engine/result.h"
#include "engine/vector.h"

namespace sheave::render {

struct Perspective {
  /// Full vertical opening angle [rad], in (0, pi).
  double vertical_fov = 0.45;
};

struct Orthographic {
  /// Height of the world that fills the picture [m], > 0.
  double height = 1.0;
};

struct Camera {
  Vector3 position{0.0, 0.0, 10.0};  ///< of the eye [m], world
  Vector3 target = Vector3::Zero();  ///< point in the middle of the picture [m]; not the position
  Vector3 up = Vector3::UnitY();  ///< points up in the picture; not parallel to the view direction
  std::variant<Perspective, Orthographic> projection = Perspective{};
};

/// Right, up and backward (towards the eye) unit vectors of the picture, world frame.
struct CameraAxes {
  Vector3 right, up, back;
};

/// Faults in a camera (non-finite numbers, target at the eye, view along up, angle out of range);
/// empty if it can be used.
[[nodiscard]] Errors validate(const Camera& camera);

/// The picture's axes; the camera must be valid.
[[nodiscard]] CameraAxes axes(const Camera& camera);

/// A world point seen in a picture.
struct ScreenPoint {
  double x = 0.0;      ///< [pixels] from the left edge
  double y = 0.0;      ///< [pixels] from the top edge
  double depth = 0.0;  ///< [m] in front of the eye, along the view direction
};

/// Maps world points to pixels of a picture of width x height.
class Projector {
 public:
  Projector(const Camera& camera, int width, int height);
  /// Nothing if the point is at or behind the eye of a perspective camera.
  [[nodiscard]] std::optional<ScreenPoint> project(const Vector3& point) const;
  /// Pixels per metre at a depth [m] > 0 in front of the eye.
  [[nodiscard]] double scale_at(double depth) const;
  [[nodiscard]] double depth_of(const Vector3& point) const;

 private:
  Camera camera_;
  CameraAxes axes_;
  double width_;
  double height_;
  double focal_ = 0.0;  ///< [pixels]: half the height over the tangent of half the angle
};

/// Parts of the picture that the scene leaves free, as fractions of its width or height, each in
/// [0, 0.45].
struct Margins {
  double left = 0.06;
  double right = 0.06;
  double top = 0.06;
  double bottom = 0.06;
};

struct FrameOptions {
  double aspect = 16.0 / 9.0;  ///< width over height of the picture, > 0
  Margins margins;
  /// Kind of projection; an orthographic height is overwritten by the fit.
  std::variant<Perspective, Orthographic> projection = Perspective{};
};

/// The camera that looks along `direction` and shows the whole box, as large as the margins allow.
/// An empty box is treated as the point zero; a box without extent gets one of 1 m. direction and
/// up must be finite and not parallel.
[[nodiscard]] Camera frame_box(const Eigen::AlignedBox3d& box, const Vector3& direction,
                               const Vector3& up, const FrameOptions& options);

/// The default viewing direction. `plane_normal`: for scenes whose motion lies in a plane; the view
/// is then nearly along it, turned a little to show depth. Otherwise a view from above and from the
/// side. Up is against gravity; it must be finite and not zero.
[[nodiscard]] Vector3 default_view_direction(const Vector3& up,
                                             const std::optional<Vector3>& plane_normal);

}  // namespace sheave::render
