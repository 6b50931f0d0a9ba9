#pragma once
// Appearance of the bodies of a model: drawable shapes, cylinders that are sheaves, and colours.

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "cable/cable_report.h"
#include "engine/world.h"
#include "render/draw_list.h"

namespace sheave::render {

/// The drawable form of a shape, in its own frame. An unknown type is drawn as its bounding box.
[[nodiscard]] Shape drawable(const sheave::Shape& shape);

/// Colours of bodies that are neither fixed nor wheels. Cool and muted: the warm colours belong to
/// the cables. The colours differ in lightness or along the axis from blue to yellow, which
/// colour-blind eyes see.
inline constexpr std::array<Color, 8> load_colors = {rgb(0x4f79a8), rgb(0xa9cbe3), rgb(0x3f8a7d),
                                                     rgb(0xb5d3a8), rgb(0xd8c27c), rgb(0x85763c),
                                                     rgb(0x54477c), rgb(0xa293bd)};

/// The colour for a body of this name, independent of the other bodies. The words left, right, front,
/// rear, back, upper, lower, top, bottom, port and starboard do not count, so pairs have one colour.
[[nodiscard]] Color load_color(std::string_view name);

/// Something fixed to a body.
struct BodyPart {
  BodyId body;  ///< the world: the part does not move
  Shape shape;
  Vector3 position = Vector3::Zero();               ///< of the shape's origin [m], body frame
  Quaternion orientation = Quaternion::Identity();  ///< shape's frame to body frame
  Color color;
};

/// A straight bar fixed to a body, such as a cheek of a block.
struct BodyBar {
  BodyId body;
  Vector3 start = Vector3::Zero();  ///< [m], body frame
  Vector3 end = Vector3::Zero();    ///< [m], body frame
  double radius = 0.01;             ///< [m]
  Color color;
};

/// The drawn parts of the bodies of one world, independent of its state.
struct BodyView {
  std::vector<BodyPart> parts;
  std::vector<BodyBar> bars;
  /// Room for windings [m] of every link of every cable, in order.
  std::vector<std::vector<double>> winding_room;
};

/// Decides the appearance of a world's bodies, from its state at time 0 and its cables then (world
/// and reports must be of the same state). A cylinder on which a cable rolls becomes a sheave whose
/// groove fits a cable of the given radius [m]; a wheel without a shape gets one.
[[nodiscard]] BodyView make_body_view(const World& world, std::span<const CableReport> cables,
                                      double cable_radius);

/// A radius for the cables [m] that shows well in a picture of a box of this diagonal [m], > 0, and
/// does not dwarf the smallest wheel.
[[nodiscard]] double suitable_cable_radius(double diagonal, std::span<const CableReport> cables);

}  // namespace sheave::render
