#pragma once
// Matrices of a picture: from positions relative to an origin near the scene to clip coordinates.
// The relative positions make single precision sufficient at any distance of the scene from the
// world's origin.

#include <Eigen/Geometry>

#include "render/camera.h"
#include "render/draw_list.h"

namespace sheave::render {

struct View {
  Vector3 origin = Vector3::Zero();  ///< [m], world; all other members are relative to it
  Eigen::Matrix4f view_projection;
  Eigen::Vector3f eye;            ///< [m]
  Eigen::Vector3f eye_direction;  ///< unit, towards the eye; zero for perspective
  /// Depth by which edges are lifted off surfaces, as a fraction of the distance to the eye.
  float nudge = 1e-3F;
  Eigen::Vector3f up;          ///< unit, of the picture
  double radius = 1.0;         ///< radius of a ball round everything that is drawn [m]
  double ground_radius = 1.0;  ///< radius at which planes have faded into the background [m]
};

struct Light {
  Eigen::Vector3f to_light;       ///< unit
  Eigen::Matrix4f shadow_matrix;  ///< to clip coordinates of the shadow map
  double texel = 0.0;             ///< size of a texel of the shadow map in the world [m]
};

/// `contents` is the box round all solids and tubes.
[[nodiscard]] View make_view(const Camera& camera, int width, int height,
                             const Eigen::AlignedBox3d& contents);

/// A light from above, behind the viewer's left shoulder. `up`: the direction from which the light
/// comes, the normal of the ground.
[[nodiscard]] Light make_light(const Camera& camera, const Vector3& up, const View& view,
                               const Eigen::AlignedBox3d& contents, int shadow_side);

}  // namespace sheave::render
