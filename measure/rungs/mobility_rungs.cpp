#include "measure/rungs/mobility_rungs.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cable/links/wheel_link.h"
#include "engine/body_mass.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/time_table.h"

namespace sheave::measure {
namespace {

Vector3 axle_of(const BodyDef& rotor) {
  if (rotor.axis) return rotor.axis->normalized();
  return rotor.orientation.normalized() * Vector3::UnitZ();
}

/// Moments of inertia, about the body's axes, of a mounted rotor as a separate body; nothing if no
/// physical body has them.
std::optional<Vector3> moments_of_mounted(const BodyDef& rotor) {
  if (rotor.shapes.empty() && !rotor.inertia) return std::nullopt;
  const MassProperties own_mass = defined_mass_properties(rotor);
  const double volume = std::max(combine(rotor.shapes, 1.0).mass, 0.0);
  if (own_mass.center_of_mass.norm() > 1e-12 * std::cbrt(volume)) return std::nullopt;
  const Vector3 moments = own_mass.inertia.diagonal();
  const Vector3 axle = rotor.orientation.normalized().conjugate() * axle_of(rotor);
  int along = 0;
  // Only a moment about one of the body's own axes can be replaced.
  if (axle.cwiseAbs().maxCoeff(&along) < 1.0 - 1e-12) return std::nullopt;
  Vector3 own = moments;
  own[along] = *rotor.spin_inertia;
  const double others = moments.sum() - moments[along];
  return own[along] <= others ? std::optional(own) : std::nullopt;
}

void set_drive(const BodyDef& rotor, JointCoordinate& angle) {
  if (rotor.drive == DriveKind::none) return;
  angle.drive = rotor.drive == DriveKind::speed    ? CoordinateDrive::speed
                : rotor.drive == DriveKind::torque ? CoordinateDrive::force
                                                   : CoordinateDrive::position;
  angle.drive_times = rotor.drive_times;
  angle.drive_values = rotor.drive_values;
  angle.drive_interpolation = rotor.drive_interpolation;
  if (rotor.drive != DriveKind::angle) return;
  // A hinge's angle is 0 at time 0; for a rotor only the change of its angle counts.
  const double start = rotor.drive_table().at(0.0);
  for (double& value : angle.drive_values) value -= start;
}

/// Velocities of a mounted rotor, which its definition does not contain.
void move_with(const BodyDef& carrier, const Vector3& axle, BodyDef& body) {
  Vector3 velocity = carrier.velocity;
  if (carrier.mobility == Mobility::kinematic) {
    velocity += 2.0 * pi * carrier.oscillation_frequency * std::cos(carrier.oscillation_phase) *
                carrier.oscillation;
  }
  const Vector3& turning = carrier.angular_velocity;
  body.velocity = velocity + turning.cross(body.position - carrier.position);
  body.angular_velocity = turning + axle * axle.dot(body.angular_velocity - turning);
}

/// A name that no joint of the scene has.
std::string new_joint_name(const Scene& scene, const std::string& wanted) {
  std::string name = wanted;
  const auto taken = [&] {
    return std::any_of(scene.model.joints.begin(), scene.model.joints.end(),
                       [&](const auto& joint) { return joint->name == name; });
  };
  for (int i = 2; taken(); ++i) name = wanted + "-" + std::to_string(i);
  return name;
}

bool hinge_rotor(Scene& scene, std::size_t index) {
  BodyDef& body = scene.model.bodies[index];
  if (body.mobility != Mobility::rotor || body.spin_inertia == 0.0) return false;
  const Vector3 axle = axle_of(body);
  if (body.spin_inertia && body.mount) {
    const std::optional<Vector3> moments = moments_of_mounted(body);
    if (!moments) return false;
    body.inertia = moments;
  } else if (body.spin_inertia) {
    body.inertia = Vector3::Constant(*body.spin_inertia);
  }
  if (body.spin_inertia) body.products_of_inertia.setZero();
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = new_joint_name(scene, body.name.substr(0, 100) + "-axle");
  hinge->body_b = BodyId{static_cast<int>(index)};
  hinge->anchor = body.position;
  hinge->axis = axle;
  if (body.mount) {
    hinge->body_a = *body.mount;
    move_with(scene.model.bodies[static_cast<std::size_t>(body.mount->index)], axle, body);
  }
  set_drive(body, hinge->angle);
  body.mobility = Mobility::free;
  body.spin_inertia.reset();
  body.axis.reset();
  body.mount.reset();
  body.drive = DriveKind::none;
  body.drive_times.clear();
  body.drive_values.clear();
  body.drive_interpolation = Interpolation::linear;
  scene.model.joints.push_back(std::move(hinge));
  return true;
}

Vector3 cable_plane(const Scene& scene) {
  for (const CableDef& cable : scene.cables) {
    for (const auto& link : cable.links) {
      const auto* const wheel = dynamic_cast<const WheelLink*>(link.get());
      if (wheel == nullptr || wheel->body.index < 0) continue;
      const BodyDef& body = scene.model.bodies[static_cast<std::size_t>(wheel->body.index)];
      Vector3 normal = wheel->normal.value_or(Vector3::UnitZ());
      if (!wheel->normal && !body.shapes.empty()) normal = body.shapes.front().orientation * normal;
      return (body.orientation.normalized() * normal).normalized();
    }
  }
  return Vector3::UnitZ();
}

}  // namespace

int hinge_rotors(Scene& scene) {
  int count = 0;
  // Carriers are not rotors, so their velocities do not change in this loop.
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i)
    count += hinge_rotor(scene, i) ? 1 : 0;
  return count;
}

int join_sliders(Scene& scene) {
  int count = 0;
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    BodyDef& body = scene.model.bodies[i];
    if (body.mobility != Mobility::slider) continue;
    auto rail = std::make_shared<SliderJoint>();
    rail->name = new_joint_name(scene, body.name.substr(0, 100) + "-rail");
    rail->body_b = BodyId{static_cast<int>(i)};
    rail->anchor = body.position;
    rail->axis = body.axis.value_or(Vector3::UnitY());
    if ((body.shapes.empty() || body.center_of_mass) && !body.inertia)
      body.inertia = Vector3::Constant(body.mass.value_or(1.0));
    body.mobility = Mobility::free;
    body.axis.reset();
    scene.model.joints.push_back(std::move(rail));
    ++count;
  }
  return count;
}

int confine_to_plane(Scene& scene) {
  const Vector3 normal = cable_plane(scene);
  int count = 0;
  for (BodyDef& body : scene.model.bodies) {
    if (body.mobility != Mobility::free) continue;
    body.mobility = Mobility::planar;
    body.axis = normal;
    ++count;
  }
  return count;
}

int free_from_plane(Scene& scene) {
  int count = 0;
  for (BodyDef& body : scene.model.bodies) {
    if (body.mobility != Mobility::planar) continue;
    body.mobility = Mobility::free;
    body.axis.reset();
    ++count;
  }
  return count;
}

}  // namespace sheave::measure
