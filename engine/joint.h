#pragma once
// What every joint type must provide. Adding one: a file in engine/joints/ and a line in
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
  /// What the pose of the bodies tells of it.
  enum class Measure {
    pose,     ///< its value
    turns,    ///< its value up to whole turns, which are counted
    changes,  ///< how fast it changes, and no value (a rotation about a direction that moves)
  };
  std::string_view name;  ///< "angle", "travel", ...
  bool angle = false;     ///< its units have rad for m
  Measure measure = angle ? Measure::turns : Measure::pose;
};

/// Settings of one joint between two bodies; derived types add their own.
class JointDef {
 public:
  virtual ~JointDef() = default;

  std::string name;  ///< unique among the joints of the model
  BodyId body_a;     ///< default: the world
  BodyId body_b;     ///< required, differs from body_a
  /// The joint breaks at the end of the substep in which its mean force or torque on body_b, about
  /// its anchor, exceeds these; it then does nothing any more.
  std::optional<double> breaking_force;   ///< [N], > 0
  std::optional<double> breaking_torque;  ///< [N m], > 0
  /// Where bodies were when anchors and axes were told. LiveWorld::edit() sets it for a joint that
  /// comes into a running world.
  BodyFrames defined_in;

  /// What all joints have.
  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "hinge"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this, as its own type
  /// The coordinates that reports tell, in their order.
  [[nodiscard]] virtual std::span<const JointCoordinateInfo> coordinates() const = 0;
  /// The body that carries what it joins, beside these two; the world of types that have none.
  [[nodiscard]] virtual BodyId carrier_body() const { return BodyId::world(); }
  /// Faults beyond the ranges of the field tables; `path` is prepended to theirs.
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
