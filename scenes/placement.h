#pragma once
// Places in a scene's text that are told relative to a body, and turns that are told in degrees.
// The loader makes world frames and quaternions of them; a scene that is loaded knows no others.

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/body.h"
#include "engine/joint.h"
#include "scenes/field_reader.h"

namespace sheave {

/// A turn about an axis, in place of a quaternion.
struct RotationDef {
  Vector3 axis{0.0, 0.0, 1.0};  ///< any length but 0
  double degrees = 0.0;         ///< counter-clockwise seen against the axis

  static std::span<const Field> field_table();
};

/// Whose frame a body's position, orientation and axis are told in.
struct BodyPlacementDef {
  std::optional<BodyId> relative_to;

  static std::span<const Field> field_table();
};

/// Whose frame a joint's points and directions are told in.
struct JointPlacementDef {
  std::optional<BodyId> relative_to;

  static std::span<const Field> field_table();
};

/// The format of RotationDef.
[[nodiscard]] const ObjectFormat& rotation_format();

/// The quaternion of an object's member "rotation", if it has one; nothing also if that is at fault,
/// which is reported.
[[nodiscard]] std::optional<Quaternion> read_rotation(const json::Document& document,
                                                      FieldReader& reader, json::NodeId object);

/// Resolves what bodies and joints of one document are relative to.
class PlacementResolver {
 public:
  PlacementResolver(const json::Document& document, FieldReader& reader)
      : document_(document), reader_(reader) {}

  /// Gives all bodies, which must be in the order of their numbers, their places in the world.
  /// Bodies that are relative to each other in a circle are reported.
  void place_bodies(std::span<const json::NodeId> nodes,
                    std::span<const std::optional<BodyId>> relative_to,
                    std::vector<BodyDef>& bodies);
  /// Turns and moves the points (fields in m) and directions that the text gives a joint.
  static void place_joint(const json::Document& document, json::NodeId node, const BodyDef& base,
                          std::span<const Field> fields, void* settings);

 private:
  const json::Document& document_;
  FieldReader& reader_;
};

}  // namespace sheave
