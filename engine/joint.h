#pragma once
// What every joint type must provide. Adding one: a file in engine/joints/ and a line in
// engine/joint_registry.cpp.

#include <memory>
#include <string>

#include "engine/body_id.h"
#include "engine/constraint_batch.h"
#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

class BodySet;

/// Settings of one joint between two bodies; derived types add their own.
class JointDef {
 public:
  virtual ~JointDef() = default;

  std::string name;  ///< unique among the joints of the model
  BodyId body_a;     ///< default: the world
  BodyId body_b;     ///< required, differs from body_a

  /// name, body_a and body_b.
  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "hinge"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this, as its own type
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

/// All joint types, in the order of the documentation; batches run in this order.
[[nodiscard]] std::span<const TypeEntry<JointDef>> joint_types();

}  // namespace sheave
