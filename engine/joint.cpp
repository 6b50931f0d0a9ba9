#include "engine/joint.h"

#include <array>

#include "engine/body_set.h"

namespace sheave {

std::span<const Field> JointDef::common_field_table() {
  static const std::array table{
      field<&JointDef::name>("name", "", {}, required, "unique name among the joints"),
      field<&JointDef::body_a>("body_a", "", {}, optional, "default: the world"),
      field<&JointDef::body_b>("body_b", "", {}, required, "differs from body_a"),
      field<&JointDef::breaking_force>("breaking_force", "N", above(0.0), optional,
                                       "a larger force breaks the joint (default: none does)"),
      field<&JointDef::breaking_torque>("breaking_torque", "N m", above(0.0), optional,
                                        "a larger torque breaks the joint (default: none does)"),
  };
  return table;
}

Errors JointDef::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors;
  if (body_a == body_b) {
    errors.push_back({path + "/body_b", "joint \"" + name + "\" joins \"" +
                                            bodies.name(bodies.index(body_a)) +
                                            "\" to itself; it needs two different bodies"});
  }
  return errors;
}

void check_direction(const Vector3& axis, const std::string& joint, const std::string& path,
                     Errors& errors) {
  if (axis.norm() > 1e-12) return;
  errors.push_back(
      {path, "joint \"" + joint + "\": the axis must have a direction; its length is 0"});
}

}  // namespace sheave
