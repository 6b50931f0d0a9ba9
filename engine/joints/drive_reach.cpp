#include "engine/joints/drive_reach.h"

#include <algorithm>

#include "engine/body_set.h"
#include "engine/field_check.h"

namespace sheave {
namespace {

/// Rounding error of a right angle printed with six decimals.
constexpr double printed = 1e-5;

/// The axes about which a body can turn: none, one or all.
struct Turns {
  bool any = false;
  bool one = false;
  Vector3 axis = Vector3::Zero();
};

Turns turns_of(const BodySet& bodies, int body, const BodyFrames& frames) {
  const BodyProperties& properties = bodies[body];
  Turns turns;
  switch (properties.mobility) {
    case Mobility::fixed:
    case Mobility::slider:
    case Mobility::knot:
      break;
    // World::set_motion() may turn a kinematic body about any axis.
    case Mobility::kinematic:
    case Mobility::free:
      turns.any = true;
      break;
    case Mobility::planar:
      turns = {false, true, properties.axis};
      break;
    case Mobility::rotor:
      turns = {false, true, properties.axis};
      if (properties.mount < 0) break;
      turns.axis = bodies.frame(properties.mount, frames).orientation * properties.axis;
      const Turns carrier = turns_of(bodies, properties.mount, frames);
      // A body with two axes of rotation can be led about any axis.
      turns.any = carrier.any || (carrier.one && carrier.axis.cross(turns.axis).norm() > printed);
      break;
  }
  return turns;
}

/// Whether the bodies can turn relative to each other about the axis and about no other.
bool spans(const Turns& a, const Turns& b, const Vector3& axis) {
  if (a.any || b.any) return true;
  const auto along = [&](const Turns& t) { return t.one && t.axis.cross(axis).norm() <= printed; };
  if (along(a) || along(b)) return true;
  if (!a.one || !b.one) return false;
  const Vector3 across = a.axis.cross(b.axis);
  return across.norm() > printed && std::abs(across.normalized().dot(axis)) <= printed;
}

bool leans(const Turns& turns, const Vector3& axis) {
  return turns.any || (turns.one && std::abs(turns.axis.dot(axis)) > printed);
}

/// Whether two bodies that each turn about one axis can together turn about any.
bool meet(const Turns& a, const Turns& b) {
  return a.one && b.one && a.axis.cross(b.axis).norm() > printed;
}

std::string text_of(const Vector3& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

std::string ability(const BodySet& bodies, int body, const Turns& turns) {
  return "\"" + bodies.name(body) + "\" " +
         (turns.one ? "turns about " + text_of(turns.axis) + " alone" : "cannot turn");
}

}  // namespace

void check_reach(const JointCoordinate& angle, const JointDef& joint, const Vector3& axis,
                 Turning turning, const BodySet& bodies, const std::string& path, Errors& errors) {
  const bool prescribes =
      angle.drive == CoordinateDrive::speed || angle.drive == CoordinateDrive::position;
  if (!prescribes || angle.drive_limit || angle.drive_compliance > 0.0) return;
  // A drive with constant target 0 prescribes no motion.
  const bool moves = angle.drive_amplitude != 0.0 ||
                     std::any_of(angle.drive_values.begin(), angle.drive_values.end(),
                                 [](double value) { return value != 0.0; });
  if (!moves) return;
  if (!(axis.norm() > 1e-12)) return;  // check_direction() reports that error
  const Vector3 direction = axis.normalized();
  const int index_a = bodies.index(joint.body_a);
  const int index_b = bodies.index(joint.body_b);
  const Turns a = turns_of(bodies, index_a, joint.defined_in);
  const Turns b = turns_of(bodies, index_b, joint.defined_in);
  const bool reached = turning == Turning::about_one_axis
                           ? spans(a, b, direction)
                           : leans(a, direction) || leans(b, direction) || meet(a, b);
  if (reached) return;
  errors.push_back(
      {path, "joint \"" + joint.name + "\": its drive turns bodies about " + text_of(direction) +
                 ", but " + ability(bodies, index_a, a) + " and " + ability(bodies, index_b, b) +
                 "; join bodies that can, or give a drive_limit, at which the drive stalls"});
}

}  // namespace sheave
