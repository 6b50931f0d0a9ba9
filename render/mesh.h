#pragma once
// Triangles ready for a vertex buffer, and the tools that shapes are built with.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave::render {

/// One corner of a triangle, in the frame of the solid (or relative to the picture's origin for
/// tubes).
struct MeshVertex {
  std::array<float, 3> position{};  ///< [m]
  std::array<float, 3> normal{};    ///< unit, for shading; differs between the sides of an edge
  /// unit, one per position: direction in which the silhouette is offset
  std::array<float, 3> outline{};
  /// r, g, b: sRGB tint that multiplies the solid's colour; a: fraction of the accent colour.
  std::array<std::uint8_t, 4> paint{255, 255, 255, 0};
};

struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
  std::vector<std::uint32_t> lines;  ///< two indices each: edges where the surface bends sharply
};

using Paint = std::array<std::uint8_t, 4>;
inline constexpr Paint plain_paint{255, 255, 255, 0};
inline constexpr Paint accent_paint{255, 255, 255, 255};

/// A point of the cross-section of a body of revolution, with the outward normal there.
struct ProfilePoint {
  double radius = 0.0;         ///< distance from the z axis [m]
  double z = 0.0;              ///< [m]
  double normal_radius = 0.0;  ///< components of the unit normal
  double normal_z = 0.0;
};

/// Collects triangles and orients each by its corners' normals.
class MeshBuilder {
 public:
  void set_paint(const Paint& paint) { paint_ = paint; }
  std::uint32_t add_vertex(const Vector3& position, const Vector3& normal);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// A flat polygon with corners in order round it.
  void add_polygon(std::span<const Vector3> corners, const Vector3& normal);
  /// Turns a smooth line of cross-section about the z axis.
  void add_revolution(std::span<const ProfilePoint> profile, int segments);
  /// The straight line from (r0, z0) to (r1, z1) turned about z; the outside lies to the right of
  /// it when r points right and z up.
  void add_cone(double r0, double z0, double r1, double z1, int segments);
  /// Fills in outline directions and sharp edges.
  [[nodiscard]] Mesh finish();

 private:
  Mesh mesh_;
  Paint paint_ = plain_paint;
};

}  // namespace sheave::render
