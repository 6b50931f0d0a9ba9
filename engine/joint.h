#pragma once
// The interface of all joint types. A new type needs a file in engine/joints/ and a line in
// engine/joint_registry.cpp.

#include <memory>
#include <optional>
#include <string>

#include "engine/body_frames.h"
#include "engine/body_id.h"
#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

class BodySet;
class ConstraintBatch;

/// A free coordinate of a joint type.
struct JointCoordinateInfo {
  /// How much of a coordinate follows from the pose of the bodies.
  enum class Measure {
    pose,     ///< its value
    turns,    ///< its value modulo whole turns, which are counted
    changes,  ///< only its rate (a rotation about a direction that moves)
  };
  std::string_view name;  ///< "angle", "travel", ...
  bool angle = false;     ///< units have rad in place of m
  Measure measure = angle ? Measure::turns : Measure::pose;
};

/// Settings of one joint between two bodies; derived types add their own.
class JointDef {
 public:
  virtual ~JointDef() = default;

  std::string name;  ///< unique among the joints of the model
  BodyId body_a;     ///< default: the world
  BodyId body_b;     ///< required, differs from body_a
  /// The joint breaks at the end of the substep in which the mean of its force, or of its torque
  /// about the anchor, on body_b exceeds these limits. A broken joint constrains nothing.
  std::optional<double> breaking_force;   ///< [N], > 0
  std::optional<double> breaking_torque;  ///< [N m], > 0
  /// The poses of the bodies to which anchors and axes refer. LiveWorld::edit() sets them for a
  /// joint that is added to a running world.
  BodyFrames defined_in;

  /// The settings that all joint types have.
  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "hinge"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this object, as its derived type
  /// The coordinates of the type, in the order in which reports list them.
  [[nodiscard]] virtual std::span<const JointCoordinateInfo> coordinates() const = 0;
  /// A third body, which carries the two that are joined (the housing of a gear); the world for
  /// types without one.
  [[nodiscard]] virtual BodyId carrier_body() const { return BodyId::world(); }
  /// Errors beyond the ranges of the field tables, with paths below `path`.
  [[nodiscard]] virtual Errors validate(const BodySet& bodies, const std::string& path) const;
  /// One batch for all `joints`, which are of this type.
  [[nodiscard]] virtual std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const = 0;

 protected:
  JointDef() = default;
  JointDef(const JointDef&) = default;
  JointDef& operator=(const JointDef&) = default;
};

/// Appends an error if `axis`, at `path`, of the joint with this name has no direction.
void check_direction(const Vector3& axis, const std::string& joint, const std::string& path,
                     Errors& errors);

/// All joint types, in the order of the documentation; batches run in this order.
[[nodiscard]] std::span<const TypeEntry<JointDef>> joint_types();

}  // namespace sheave
