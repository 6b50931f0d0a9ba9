#pragma once
// Reads the tree of a URDF text into the same Model as MJCF, which has all that URDF can say.
//
// A link is a body whose frame is that of the joint to its parent. The root link stands still.

#include "scenes/import/attributes.h"
#include "scenes/import/mjcf/model.h"

namespace sheave::import::urdf {

/// The model of a tree whose root is <robot>; check log.failed(). `folder`: as Options::folder.
[[nodiscard]] mjcf::Model read_model(const xml::Element& root, Log& log,
                                     const std::string& folder = {});

/// Reads the meshes that a model names, each once.
class MeshReader {
 public:
  explicit MeshReader(mjcf::Model& model) : model_(model) {}
  /// Sets the mesh of a geom from a <mesh>; the reason if there is none.
  [[nodiscard]] std::string read(const xml::Element& element, mjcf::Geom& geom, Log& log);

 private:
  [[nodiscard]] MeasuredMesh measured(const std::string& named, const Vector3& scale);

  mjcf::Model& model_;
  std::size_t left_ = most_mesh_bytes;  ///< bytes that their files may have
};

/// The <origin> of an element; the identity if there is none.
[[nodiscard]] mjcf::Frame read_origin(const xml::Element& element, Log& log);
/// Reads mass and shapes of a <link> into the body with this number.
void read_link(const xml::Element& element, int body, mjcf::Model& model, MeshReader& meshes,
               Log& log);
/// Gives bodies that move and carry no mass that of their shapes.
void find_masses_of_shapes(mjcf::Model& model, Log& log);
/// Reads type, axis, limits and dynamics of a <joint> as joints of the body with this number.
void read_joint(const xml::Element& element, int body, mjcf::Model& model, Log& log);
/// Reads the <mimic> of a joint that has been read.
void read_mimic(const xml::Element& element, mjcf::Model& model, Log& log);
/// The child of an element with this tag; null if there is none. A second one is an error.
[[nodiscard]] const xml::Element* child_of(const xml::Element& element, std::string_view tag,
                                           Log& log);

}  // namespace sheave::import::urdf
