#pragma once
// Content of a picture as a plain value, without GL and without a simulation. Producers
// (view_builder.h) fill it, renderer.h draws it. All positions are in the world frame [m] unless a
// comment says otherwise.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "engine/vector.h"
#include "render/color.h"
#include "render/color_map.h"

namespace sheave::render {

/// A box centred at the origin of its frame; size: full edge lengths [m], each > 0.
struct BoxShape {
  Vector3 size = Vector3::Ones();
};

/// A ball; radius [m] > 0.
struct SphereShape {
  double radius = 0.5;
};

/// A cylinder about its local z axis, centred; radius [m] > 0, length along z [m] > 0.
struct CylinderShape {
  double radius = 0.5;
  double length = 1.0;
};

/// A cylinder of the given length [m] >= 0 about local z with a half ball of radius [m] > 0 at each
/// end.
struct CapsuleShape {
  double radius = 0.5;
  double length = 1.0;
};

/// A grooved wheel with hub and spokes about its local z axis, centred. The spoke on local +x is
/// painted in the accent colour, so that turning shows.
struct SheaveShape {
  /// Distance from the axis to the centre line of a cable in the groove [m], > 0.
  double radius = 0.5;
  /// Thickness along z [m], > 0.
  double length = 0.1;
  /// Radius of the cable that lies in the groove [m], in [0, radius).
  double cable_radius = 0.02;
  /// Width of the bottom of the groove along z [m], >= 0: room for several windings side by side.
  double groove_width = 0.0;
  /// Number of spokes; 0 draws a solid disc.
  int spokes = 5;
};

/// Triangles with outward normals (counter-clockwise seen from outside), shaded flat.
struct TriangleMesh {
  /// Corners in the frame of the solid [m], finite.
  std::vector<Vector3> vertices;
  /// Three indices into vertices per triangle.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A mesh shape is shared between frames: the renderer uploads it once. Must not be null.
struct MeshShape {
  std::shared_ptr<const TriangleMesh> mesh;
};

using Shape =
    std::variant<BoxShape, SphereShape, CylinderShape, CapsuleShape, SheaveShape, MeshShape>;

struct Solid {
  Shape shape;
  /// World position of the origin of the shape's frame [m].
  Vector3 position = Vector3::Zero();
  /// Rotation from the shape's frame to the world; unit length.
  Quaternion orientation = Quaternion::Identity();
  Color color = rgb(0x8aa0b8);
  /// Second colour, for the marked spoke of a sheave.
  Color accent = rgb(0x2c3a4c);
};

struct TubePoint {
  Vector3 position = Vector3::Zero();
  Color color;
};

/// A cable or another round line through at least two points; closed repeats no point.
struct Tube {
  std::vector<TubePoint> points;
  /// [m], > 0.
  double radius = 0.01;
  /// Joins the last point to the first.
  bool closed = false;
};

/// Text beside a point of the world. The renderer moves overlapping labels apart and then draws a
/// thin leader to the anchor.
struct Label {
  Vector3 anchor = Vector3::Zero();
  /// UTF-8; one line.
  std::string text;
  /// World direction in which the text should stand off the anchor; zero leaves the choice to the
  /// layout.
  Vector3 direction = Vector3::Zero();
  /// Range by which the anchor may be moved to find room, in both directions [m], e.g. along a
  /// cable.
  Vector3 slide = Vector3::Zero();
  Color color = rgb(0x1b2430);
};

/// An infinite plane that receives shadows and fades with distance.
struct Plane {
  Vector3 point = Vector3::Zero();
  /// Unit length; the plane is seen only from this side.
  Vector3 normal = Vector3::UnitY();
  Color color = rgb(0xf1f3f6);
  /// Distance of the lines of a soft grid [m]; 0: no grid.
  double grid_spacing = 0.0;
};

/// A colour bar. Requires min < max, both finite.
struct Legend {
  std::string quantity = "tension";
  /// Written after the quantity in brackets.
  std::string unit = "N";
  double min = 0.0;
  double max = 1.0;
  ColorMap map = ColorMap::tension;
  /// Name of slack_color below the bar; empty leaves it out.
  std::string slack = "slack";
};

struct DrawList {
  std::vector<Solid> solids;
  std::vector<Tube> tubes;
  std::vector<Label> labels;
  /// Texts with an arrow to their anchor.
  std::vector<Label> arrows;
  std::vector<Plane> planes;
  std::optional<Legend> legend;
  /// Upper left corner, UTF-8; empty strings are left out. Broken into lines where it is too long.
  std::string title;
  /// Lower left corner, likewise.
  std::string caption;
  /// Simulated time [s], written below the title.
  std::optional<double> time;
  /// End of the run [s], > 0, written beside the time, with a line of the time below.
  std::optional<double> duration{};
  /// Lower right corner: the directions of x, y and z.
  bool axes = false;
};

/// The smallest world-aligned box around all solids and tubes; empty if there are none.
Eigen::AlignedBox3d bounds(const DrawList& list);

/// The same for one solid.
Eigen::AlignedBox3d bounds(const Solid& solid);

}  // namespace sheave::render
