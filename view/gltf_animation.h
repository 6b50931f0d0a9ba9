#pragma once
// A run as animated glTF 2.0: a node for each body with its shapes, cables, strings and springs as
// straight cylinders that are placed, turned and stretched. Colours of cables are their tensions:
// their meshes have a colour per stop of the colour map, which weights blend (programs that leave
// out weights of colours show slack cable). Up is +y, as glTF has it.

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
  /// `builder` says how the machine looks and must outlive this; `tension_max` [N] is the top of
  /// the colour map, > 0.
  GltfAnimation(const render::ViewBuilder& builder, double tension_max);

  /// A moment of the animation [s], later than all before.
  void add(double time, const World& world, std::span<const CableReport> cables);

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  /// The file (.glb) of the moments so far, at least one; ends the animation.
  [[nodiscard]] std::string finish(const Model& model);

 private:
  struct Pose {
    Vector3 position;
    Quaternion orientation;
  };

  /// A point of a cable that is fixed to a body.
  struct Knot {
    BodyId body;
    Vector3 position;  ///< [m], frame of the body
  };

  void add_knots(const World& world, std::span<const CableReport> cables);
  void add_cable(std::size_t index, const CableReport& listed);
  void add_joints(const World& world);

  const render::ViewBuilder& builder_;
  double tension_max_;
  std::vector<double> times_;
  std::vector<std::vector<Pose>> poses_;  ///< by body, then moment
  std::vector<Knot> knots_;
  LineTracks lines_;
  std::vector<std::optional<std::size_t>> broken_;  ///< by joint: the first moment without it
};

}  // namespace sheave::view
