// Actuators on joints and fixed tendons as drives. The force along the coordinate q, of the joint
// or the length of the tendon, is
//   gear (gain control + bias0 + bias1 gear q + bias2 gear q'),
// a spring of stiffness -bias1 gear^2 and a damper of -bias2 gear^2 beside a constant force. With a
// spring it is a drive to the position at which the force is 0, else a drive of force.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/scene.h"

namespace sheave::import::mjcf {
namespace {

Drive drive_of(const Writer& writer, const Actuator& actuator, double control) {
  const double gear = actuator.gear;
  const double stiffness = -actuator.bias[1] * gear * gear;
  const double force = gear * (actuator.gain * control + actuator.bias[0]);
  Drive drive;
  drive.damping = -actuator.bias[2] * gear * gear;
  drive.to_position = stiffness > 0.0;
  drive.value = force;
  if (drive.to_position) {
    drive.value = force / stiffness;
    drive.compliance = 1.0 / stiffness;
  }
  if (!actuator.force_range) return drive;
  const std::array<double, 2> range = *actuator.force_range;
  const bool symmetric = range[0] == -range[1];
  if (!drive.to_position) {
    const double least = std::min(gear * range[0], gear * range[1]);
    const double most = std::max(gear * range[0], gear * range[1]);
    drive.value = std::clamp(drive.value, least, most);
    writer.log.changed(*actuator.element, drive.damping > 0.0
                                              ? "forcerange bounds the force of time 0 alone, and "
                                                "not that of the damper"
                                              : "forcerange bounds the force of time 0 alone");
  } else if (symmetric) {
    drive.limit = std::abs(gear) * range[1];
    // clamp(k (q0 - q) - d q') is no sum of a bounded spring and a damper.
    if (drive.damping > 0.0) {
      writer.log.changed(
          *actuator.element,
          fmt::format("forcerange bounds the spring alone, and not the damper of {}, "
                      "so the force differs where the bound acts",
                      number_text(drive.damping, 6)));
    }
  } else {
    writer.log.changed(*actuator.element, "not taken: a forcerange that is not symmetric");
  }
  return drive;
}

/// Adds the drive of an actuator to those that act on the same coordinate of the `part`.
void add_drive(const Writer& writer, std::size_t number, const char* part,
               std::optional<Drive>& own) {
  const Actuator& actuator = writer.model.actuators[number];
  const Drive drive = drive_of(writer, actuator, writer.controls[number]);
  if (own && (own->to_position || drive.to_position)) {
    writer.log.skipped(*actuator.element,
                       fmt::format("the {} has a drive of another actuator already", part));
    return;
  }
  if (own) {
    own->value += drive.value;
    own->damping += drive.damping;
  } else {
    own = drive;
  }
  const std::string value = number_text(drive.value, 6);
  if (drive.to_position) {
    writer.log.same(*actuator.element,
                    fmt::format("a drive to the coordinate {} of the {}, compliance {}", value,
                                part, number_text(drive.compliance, 6)));
  } else {
    writer.log.same(*actuator.element,
                    fmt::format("a drive of the force or torque {}: {} per control", value,
                                number_text(actuator.gear * actuator.gain, 6)));
  }
}

}  // namespace

void find_drives(Writer& writer) {
  const Model& model = writer.model;
  writer.drives.resize(model.joints.size());
  writer.tendon_drives.resize(model.tendons.size());
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const bool fixed = actuator.tendon >= 0 && !model.tendons[at(actuator.tendon)].joints.empty();
    if (fixed && actuator.muscle) {
      writer.log.skipped(*actuator.element,
                         "a muscle lies along a spatial tendon; on a fixed one it has no "
                         "counterpart");
    } else if (fixed) {
      add_drive(writer, i, "tendon", writer.tendon_drives[at(actuator.tendon)]);
    }
    if (actuator.joint < 0) continue;
    const Joint& joint = model.joints[at(actuator.joint)];
    if (joint.type == JointType::ball || joint.type == JointType::free) {
      writer.log.skipped(*actuator.element, "on a ball or free joint it has no counterpart");
      continue;
    }
    add_drive(writer, i, "joint", writer.drives[at(actuator.joint)]);
  }
}

}  // namespace sheave::import::mjcf
