#pragma once
// Reads the mesh of a file, and measures it.

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/import/mesh.h"

namespace sheave::import {

/// Reads an STL or OBJ file, by the end of its name. `left`: bytes that the meshes of the model may
/// still have, which it lowers. The error is without the name of the file.
[[nodiscard]] Result<TriangleMesh> read_mesh_file(const std::filesystem::path& path,
                                                  std::size_t& left);

/// A mesh as a scene can have it.
struct MeasuredMesh {
  std::string fault;             ///< why nothing is known of it; empty: it is known
  std::string no_mass;           ///< why it has no solid; empty: it has one
  MeshSolid solid;               ///< in the frame of the mesh
  std::vector<Vector3> corners;  ///< of its convex hull [m]; empty: none, or too many
};
[[nodiscard]] MeasuredMesh measure_mesh(const TriangleMesh& mesh);
/// Stretches the mesh along its axes; a mirrored one keeps its outside.
void scale_mesh(const Vector3& scale, TriangleMesh& mesh);

}  // namespace sheave::import
