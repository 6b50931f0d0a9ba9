#pragma once
// Builds a glTF 2.0 file step by step. Knows the file format, but nothing about machines.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/vector.h"
#include "render/color.h"
#include "render/mesh.h"

namespace sheave::view {

/// Position, rotation and scale of a node relative to its parent.
struct NodePlace {
  Vector3 translation = Vector3::Zero();
  Quaternion rotation = Quaternion::Identity();
  Vector3 scale = Vector3::Ones();
};

/// The animated property of a node.
enum class NodePath { translation, rotation, scale, weights };

class GltfBuilder {
 public:
  GltfBuilder();
  ~GltfBuilder();
  GltfBuilder(const GltfBuilder&) = delete;
  GltfBuilder& operator=(const GltfBuilder&) = delete;

  /// Index of a material; equal colours share one material.
  int material(const render::Color& color);
  /// A mesh with the paints of its vertices; -1 if it has no triangles.
  int mesh(const std::string& name, const render::Mesh& mesh, int material,
           const render::Color& accent);
  /// A mesh in the colour `base`, blended with the colours `blends` by the weights of its nodes.
  int blended_mesh(const std::string& name, const render::Mesh& mesh, const render::Color& base,
                   const std::vector<render::Color>& blends);

  /// A node. parent -1: no parent. mesh -1: no mesh.
  int node(const std::string& name, int parent, int mesh, const NodePlace& place);
  /// Sets constant colour weights of a node.
  void set_weights(int node, const std::vector<double>& weights);

  /// Sets the times of all animations [s], ascending.
  void set_times(const std::vector<double>& times);
  /// Adds an animation track for one or more nodes and returns its index. `values` has the numbers
  /// of all frames in order: 3, 4 (x, y, z, w) or the number of weights per frame. `steps`: each
  /// value holds until the next one.
  int track(NodePath path, const std::vector<double>& values, bool steps = false);
  void animate(int node, NodePath path, int track);

  /// The file (.glb).
  [[nodiscard]] std::string bytes();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sheave::view
