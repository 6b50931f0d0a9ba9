#pragma once
// Builds a glTF 2.0 file piece by piece; knows its format and nothing of machines.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/vector.h"
#include "render/color.h"
#include "render/mesh.h"

namespace sheave::view {

/// Place, turn and size of a node within its parent.
struct NodePlace {
  Vector3 translation = Vector3::Zero();
  Quaternion rotation = Quaternion::Identity();
  Vector3 scale = Vector3::Ones();
};

/// What of a node moves.
enum class NodePath { translation, rotation, scale, weights };

class GltfBuilder {
 public:
  GltfBuilder();
  ~GltfBuilder();
  GltfBuilder(const GltfBuilder&) = delete;
  GltfBuilder& operator=(const GltfBuilder&) = delete;

  /// Index of a material; equal colours share one.
  int material(const render::Color& color);
  /// A mesh with the paints of its corners; -1 if it has no triangles.
  int mesh(const std::string& name, const render::Mesh& mesh, int material,
           const render::Color& accent);
  /// A mesh whose colour is `base` and, by weights of its nodes, those of `blends`.
  int blended_mesh(const std::string& name, const render::Mesh& mesh, const render::Color& base,
                   const std::vector<render::Color>& blends);

  /// A node; parent -1: at the top. mesh -1: none.
  int node(const std::string& name, int parent, int mesh, const NodePlace& place);
  /// Weights of the colours of a node that does not change them.
  void set_weights(int node, const std::vector<double>& weights);

  /// The moments of all animation [s], increasing.
  void set_times(const std::vector<double>& times);
  /// Numbers of all moments one after another, for one or more nodes: 3, 4 (x, y, z, w) or as many
  /// as there are weights for each. `steps`: holds each until the next.
  int track(NodePath path, const std::vector<double>& values, bool steps = false);
  void animate(int node, NodePath path, int track);

  /// The file (.glb).
  [[nodiscard]] std::string bytes();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sheave::view
