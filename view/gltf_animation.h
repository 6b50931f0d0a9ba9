#pragma once
// A run as animated glTF 2.0. Each body is a node with its shapes. Cables, strings and springs are
// straight cylinders that are moved, rotated and scaled. The colour of a cable shows its tension:
// its meshes have one colour per stop of the colour map, and weights blend these colours (programs
// that do not support colour weights show slack cable). The up direction is +y, as glTF requires.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cable/cable_report.h"
#include "engine/world.h"
#include "render/view_builder.h"
#include "view/line_tracks.h"

namespace sheave::view {

class GltfAnimation {
 public:
  /// `builder` defines the appearance of the machine and must outlive this; `tension_max` [N] is
  /// the top of the colour map, > 0.
  GltfAnimation(const render::ViewBuilder& builder, double tension_max);

  /// Adds a frame at a time [s], which must be later than all earlier ones. `ropes` has followed the
  /// run to this state.
  void add(double time, const World& world, std::span<const CableReport> cables,
           const render::CutRopes& ropes);

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  /// The file (.glb) with all frames added, at least one; ends the animation.
  [[nodiscard]] std::string finish(const Model& model);

 private:
  struct Pose {
    Vector3 position;
    Quaternion orientation;
  };

  /// A point of a cable fixed to a body.
  struct Knot {
    BodyId body;
    Vector3 position;  ///< [m], frame of the body
  };

  void add_knots(const World& world, std::span<const CableReport> cables);
  void add_cable(std::size_t index, const CableReport& listed, const render::CutRopes& ropes);
  void add_joints(const World& world);

  const render::ViewBuilder& builder_;
  double tension_max_;
  std::vector<double> times_;
  std::vector<std::vector<Pose>> poses_;  ///< by body, then frame
  std::vector<Knot> knots_;
  LineTracks lines_;
  std::vector<std::optional<std::size_t>> broken_;  ///< by joint: the first frame without it
};

}  // namespace sheave::view
