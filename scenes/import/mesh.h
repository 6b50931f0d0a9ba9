#pragma once
// Triangle meshes of STL and OBJ files: their content, and the mass of the solid inside.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/result.h"
#include "engine/vector.h"

namespace sheave::import {

/// Most triangles and points of a mesh.
inline constexpr std::size_t most_triangles = 1'000'000;
/// Most bytes of its file: a million triangles in words take some 250.
inline constexpr std::size_t most_mesh_bytes = std::size_t{256} << 20U;

/// A surface of triangles.
struct TriangleMesh {
  std::vector<Vector3> points;                          ///< no two are equal [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
};

/// The solid inside a closed surface, for the density 1.
struct MeshSolid {
  double volume = 0.0;                ///< [m3], > 0
  Vector3 center = Vector3::Zero();   ///< of mass [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre, axes of the mesh [m5]
};

/// Reads an STL file, binary or in words. An error names the line or the byte. Equal points become
/// one, and triangles without area are left out.
[[nodiscard]] Result<TriangleMesh> read_stl(std::string_view bytes);
/// Reads the points and faces of an OBJ file; polygons become triangles about their first corner.
[[nodiscard]] Result<TriangleMesh> read_obj(std::string_view text);

/// The integrals over the solid, exact but for rounding. An error if the surface is not closed (an
/// edge has no counterpart of the opposite direction), or its volume is 0 or below: inside out.
[[nodiscard]] Result<MeshSolid> solid_of(const TriangleMesh& mesh);

}  // namespace sheave::import
