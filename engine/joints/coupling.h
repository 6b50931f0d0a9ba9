#pragma once

#include "engine/joint.h"
#include "engine/joint_references.h"
#include "engine/joints/coordinate.h"

namespace sheave {

/// Couples the coordinates of one to four other joints. Its own coordinate is the travel
///
///   s = radius (sum of factor_i y_i  +  curve_0 y^2 + curve_1 y^3 + ...),
///
/// where y_i is the angle [rad] of a coordinate, or its travel / radius, and y is that of the last
/// one. A force F [N] along s acts on each coordinate with F ds/dq: a belt or tendon over drums of
/// the joints, of these factors in radii. The settings of the travel act along s.
class CouplingJoint final : public JointDef, public JointReferences {
 public:
  static constexpr std::size_t most_joints = 4;
  static constexpr std::size_t most_powers = 8;

  std::vector<std::string>
      joints;  ///< names of the coupled joints, 1 to 4, each with hinge, slider,
               ///< cylindrical, plane or universal as its type
  /// Names of their coordinates ("angle", "travel", ...); none if each joint has only one.
  std::vector<std::string> joint_coordinates;
  /// Of the coordinates, as many as joints; not 0, but the last one beside a curve [1].
  std::vector<double> factors;
  std::vector<double> curve;  ///< of the powers 2, 3, ... of the last coordinate, up to 8 [1]
  double radius = 1.0;        ///< travel per angle [m/rad], > 0
  bool held = true;           ///< whether s keeps the value 0
  double compliance = 0.0;    ///< of a travel that is held [m/N], >= 0
  JointCoordinate travel;     ///< s, which is 0 at time 0 [m]

  static constexpr std::string_view type_name = "coupling";
  static constexpr std::string_view type_meaning =
      "couples coordinates of other joints: a fixed tendon, fingers that bend together, an inertia "
      "behind a gear";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const JointCoordinateInfo> coordinates() const override;
  [[nodiscard]] Errors validate(const BodySet& bodies, const std::string& path) const override;
  [[nodiscard]] Errors check_references(const Model& model, const BodySet& bodies,
                                        const std::string& path) const override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> make_batch(
      const BodySet& bodies, std::span<const JointDef* const> definitions) const override;
};

/// A coordinate of another joint: the joint's place in Model::joints, -1 if there is none, and the
/// coordinate's place in JointDef::coordinates(), -1 if there is none.
struct CoupledCoordinate {
  int joint = -1;
  int coordinate = -1;
};
/// The coordinate number `index` of the coupling.
[[nodiscard]] CoupledCoordinate coupled_coordinate(
    const CouplingJoint& coupling, std::size_t index,
    std::span<const std::shared_ptr<const JointDef>> joints);

}  // namespace sheave
