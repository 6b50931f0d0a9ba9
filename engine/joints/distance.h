#pragma once

#include <optional>

#include "engine/joint.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// The distances that a distance joint permits.
enum class DistanceLimit { exactly, at_most, at_least, none };
inline constexpr std::array<std::string_view, 4> distance_limit_names{"exactly", "at-most",
                                                                      "at-least", "none"};

/// Keeps two points of two bodies at a distance: a massless rod, a string or a bumper. With the
/// limit `none` the joint is only the carrier of forces along the line between the points: a
/// dashpot, an actuator.
class DistanceJoint final : public JointDef {
 public:
  Vector3 anchor_a = Vector3::Zero();  ///< on body a, world frame at time 0 [m]
  Vector3 anchor_b = Vector3::Zero();  ///< on body b, world frame at time 0 [m]
  std::optional<double> length;        ///< [m], > 0; default: the distance at time 0
  DistanceLimit limit = DistanceLimit::exactly;
  double compliance = 0.0;  ///< [m/N], >= 0
  double damping = 0.0;     ///< [N s/m], >= 0; only with compliance or with the limit `none`
  /// Change of the distance since time 0 [m]. Its spring and damping are `compliance` and `damping`
  /// above.
  JointCoordinate extension;

  static constexpr std::string_view type_name = "distance";
  static constexpr std::string_view type_meaning =
      "keeps two points at a distance: a rod, a string or a bumper, rigid or elastic; or an "
      "actuator";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> joints) const override;
};

}  // namespace sheave
