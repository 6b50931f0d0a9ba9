#pragma once
// Positions relative to a body, and rotations in degrees, in the text of a scene. The loader
// converts them to world frames and quaternions; a loaded scene has only these.

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/body.h"
#include "engine/joint.h"
#include "scenes/field_reader.h"

namespace sheave {

/// A rotation about an axis, in place of a quaternion.
struct RotationDef {
  Vector3 axis{0.0, 0.0, 1.0};  ///< any length except 0
  double degrees = 0.0;         ///< counter-clockwise, seen from the tip of the axis

  static std::span<const Field> field_table();
};

/// The body in whose frame a body's position, orientation and axis are given.
struct BodyPlacementDef {
  std::optional<BodyId> relative_to;

  static std::span<const Field> field_table();
};

/// The body in whose frame a joint's points and directions are given.
struct JointPlacementDef {
  std::optional<BodyId> relative_to;

  static std::span<const Field> field_table();
};

/// The format of RotationDef.
[[nodiscard]] const ObjectFormat& rotation_format();

/// The quaternion of an object's member "rotation". Nothing if the object has none, or if it has a
/// fault, which is reported.
[[nodiscard]] std::optional<Quaternion> read_rotation(const json::Document& document,
                                                      FieldReader& reader, json::NodeId object);

/// Resolves the relative placements of the bodies and joints of one document.
class PlacementResolver {
 public:
  PlacementResolver(const json::Document& document, FieldReader& reader)
      : document_(document), reader_(reader) {}

  /// Computes the world poses of all bodies, which must be in the order of their numbers. Bodies
  /// that are relative to each other in a cycle are reported.
  void place_bodies(std::span<const json::NodeId> nodes,
                    std::span<const std::optional<BodyId>> relative_to,
                    std::vector<BodyDef>& bodies);
  /// Rotates and moves the points (fields in m) and directions in the text of a joint.
  static void place_joint(const json::Document& document, json::NodeId node, const BodyDef& base,
                          std::span<const Field> fields, void* settings);

 private:
  const json::Document& document_;
  FieldReader& reader_;
};

}  // namespace sheave
