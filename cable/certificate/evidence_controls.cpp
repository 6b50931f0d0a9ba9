// Controls (engine/controls.h) as the certificate applies them.

#include <cmath>

#include "cable/cable_system.h"
#include "cable/certificate/evidence.h"

namespace sheave::certify {

Vector3 Evidence::load_force(int body, End when) const {
  const ForceControl* set = start.controls.forces.find(body);
  const Vector3& constant = bodies.definition(body).force;
  return set == nullptr
             ? constant
             : Vector3(constant + set->force_in_world(moments[at(when)].orientation(body)));
}

Vector3 Evidence::load_torque(int body, End when) const {
  const ForceControl* set = start.controls.forces.find(body);
  const Vector3& constant = bodies.definition(body).torque;
  return set == nullptr
             ? constant
             : Vector3(constant + set->torque_in_world(moments[at(when)].orientation(body)));
}

void Evidence::follow_controls() {
  if (!start.controls.cables.any()) return;
  controlled_ = *simulation.cable_definitions;
  for (std::size_t c = 0; c < controlled_.size(); ++c) {
    const CableControl* set = start.controls.cables.find(static_cast<int>(c));
    if (set == nullptr) continue;
    if (!std::isnan(set->compliance)) controlled_[c].compliance = set->compliance;
    if (!std::isnan(set->wrap_friction)) controlled_[c].wrap_friction = set->wrap_friction;
  }
}

}  // namespace sheave::certify
