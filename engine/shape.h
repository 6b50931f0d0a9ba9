#pragma once
// The interface of all shapes: mass properties, extent, and points of contact with flat ground.

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "engine/field.h"
#include "engine/result.h"
#include "engine/shapes/section.h"
#include "engine/shapes/solid.h"
#include "engine/vector.h"

namespace sheave {

/// Mass distribution of a solid.
struct MassProperties {
  double mass = 0.0;                         ///< [kg]; the volume [m3] for a shape at density 1
  Vector3 center_of_mass = Vector3::Zero();  ///< [m], in the frame of the shape or body
  Matrix3 inertia = Matrix3::Zero();         ///< [kg m2], about the centre of mass, same axes
};

/// A solid form in its own frame. A new shape needs a file in engine/shapes/ and a line in
/// engine/shape_registry.cpp.
class Shape {
 public:
  virtual ~Shape() = default;
  /// Key of the type in the registry, e.g. "box".
  [[nodiscard]] virtual std::string_view type() const = 0;
  /// This object as the type that its field table describes.
  [[nodiscard]] virtual const void* settings() const = 0;
  /// Errors beyond the ranges of the field table, with paths below `path`.
  [[nodiscard]] virtual Errors validate(const std::string& path) const;
  /// Exact mass properties at density 1 kg/m3.
  [[nodiscard]] virtual MassProperties unit_density() const = 0;
  /// Radius [m] of a wheel about the shape's z axis on which a cable can roll; NaN for other
  /// shapes.
  [[nodiscard]] virtual double wheel_radius() const {
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Whether the shape is finite. An unbounded shape has no mass and no extent, and carries no
  /// cable.
  [[nodiscard]] virtual bool bounded() const { return true; }
  /// Appends the points [m] that decide contact with a plane whose inward (downward) unit normal in
  /// the shape's frame is `down`: all corners, or the lowest points of a curved surface.
  virtual void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const = 0;
  /// Appends points [m] in the plane whose convex hull is the hull of the shape's section with it;
  /// curved sections as polygons (engine/shapes/section.h). Nothing if the plane misses the shape.
  virtual void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const = 0;
  /// The form for contacts between bodies.
  [[nodiscard]] virtual ConvexSolid solid() const = 0;
  /// Half edges [m] of a box about the shape's origin that contains the shape; for framing a
  /// picture and for the length scale of a scene.
  [[nodiscard]] virtual Vector3 half_extent() const = 0;

 protected:
  Shape() = default;
  Shape(const Shape&) = default;
  Shape& operator=(const Shape&) = default;
};

/// A shape placed in a body's frame.
struct PlacedShape {
  std::shared_ptr<const Shape> shape;
  Vector3 position = Vector3::Zero();               ///< [m], body frame
  Quaternion orientation = Quaternion::Identity();  ///< shape frame to body frame
  /// [kg/m3], > 0; replaces the density of the body for this shape
  std::optional<double> density{};

  static std::span<const Field> field_table();  ///< all but the shape itself
};

/// All shape types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<Shape>> shape_types();

/// Mass properties in the body frame of `shapes` together at the given density [kg/m3].
[[nodiscard]] MassProperties combine(std::span<const PlacedShape> shapes, double density);

/// Inertia [kg m2] of a point mass [kg] at `offset` [m] about the origin (parallel-axis term).
[[nodiscard]] Matrix3 point_inertia(double mass, const Vector3& offset);

}  // namespace sheave
