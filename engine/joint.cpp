#include "engine/joint.h"

#include <array>

#include "engine/body_set.h"

namespace sheave {

std::span<const Field> JointDef::common_field_table() {
  static const std::array table{
      field<&JointDef::name>("name", "", {}, required, "unique name among the joints"),
      field<&JointDef::body_a>("body_a", "", {}, optional, "default: the world"),
      field<&JointDef::body_b>("body_b", "", {}, required, "differs from body_a"),
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

}  // namespace sheave
