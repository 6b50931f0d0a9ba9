// Lumping a mounted rotor into its carrier. The rotor's mass acts at its centre on the axle, and
// its inertia across the axle turns with the carrier. The inertia about the axle does not, because
// the rotor's spin is a coordinate of its own. With rotor mass m at offset c from the carrier's
// centre of mass and inertia I_r (symmetric about the axle a, J = a.I_r a):
//   mass += m,   inertia += m (c.c E - c c^T) + I_r - J a a^T.

#include "engine/body_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "engine/body_check.h"
#include "engine/body_mass.h"
#include "engine/index.h"
#include "engine/math/portable.h"
#include "engine/model.h"

namespace sheave {
namespace {

/// Unit axis in the world frame at time 0.
Vector3 world_axis(const BodyDef& body) {
  if (body.axis) return body.axis->normalized();
  if (body.mobility == Mobility::rotor) return body.orientation.normalized() * Vector3::UnitZ();
  return Vector3::UnitZ();
}

BodyProperties compile_body(const BodyDef& body) {
  BodyProperties result;
  result.mobility = body.mobility;
  result.start_orientation = body.orientation.normalized();
  if (!yields(body.mobility)) return result;
  const MassProperties own = defined_mass_properties(body);
  result.drive = body.drive;
  result.drive_table = body.drive_table();
  result.mass = own.mass;
  result.inertia = own.inertia;
  result.axis = world_axis(body);
  // The axle of a rotor passes through the origin of its frame. check_bodies() has verified that
  // the centre of mass lies on the axle; its position along the axle does not matter.
  if (body.mobility != Mobility::rotor) result.center_of_mass = own.center_of_mass;
  return result;
}

/// Adds the mass and inertia of rotor `i` to its carrier.
void lump_mounted_rotor(std::vector<BodyProperties>& bodies, const std::vector<BodyDef>& defs,
                        int i) {
  BodyProperties& rotor = bodies[at(i)];
  const BodyDef& def = defs[at(i)];
  const int mount = def.mount->index;
  BodyProperties& carrier = bodies[at(mount)];
  const BodyDef& carrier_def = defs[at(mount)];
  const Quaternion carrier_inverse = carrier_def.orientation.normalized().conjugate();
  const Vector3 spin_axis = def.orientation.normalized().conjugate() * rotor.axis;
  const double spin_inertia = spin_axis.dot(rotor.inertia * spin_axis);
  rotor.mount = mount;
  std::swap(rotor.drive, rotor.mounted_drive);
  if (rotor.mounted_drive == DriveKind::angle) {
    const double start = rotor.drive_table.at(0.0);
    for (double& value : rotor.drive_table.values) value -= start;
  }
  rotor.axis_inertia = def.spin_inertia.value_or(spin_inertia);
  rotor.axis = carrier_inverse * rotor.axis;
  rotor.start_orientation = carrier_inverse * def.orientation.normalized();
  // In the body frame until BodySet::create() subtracts the centre of mass
  rotor.mount_position = carrier_inverse * (def.position - carrier_def.position);
  carrier.mounted_rotors.push_back(i);
  if (!yields(carrier.mobility)) return;
  const Matrix3 rotation = rotor.start_orientation.toRotationMatrix();
  const Matrix3 across = rotation * rotor.inertia * rotation.transpose() -
                         spin_inertia * rotor.axis * rotor.axis.transpose();
  const double total = carrier.mass + rotor.mass;
  const Vector3 center =
      (carrier.mass * carrier.center_of_mass + rotor.mass * rotor.mount_position) / total;
  carrier.inertia += across + point_inertia(carrier.mass, carrier.center_of_mass - center) +
                     point_inertia(rotor.mass, rotor.mount_position - center);
  carrier.mass = total;
  carrier.center_of_mass = center;
}

/// The principal axis whose moment differs from two equal ones; none if all three are equal.
std::optional<Vector3> find_symmetry_axis(const Matrix3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(inertia);
  const Vector3& moments = principal.eigenvalues();  // increasing
  const double equal = 1e-12 * moments[2];
  const bool lower = moments[1] - moments[0] <= equal;
  const bool upper = moments[2] - moments[1] <= equal;
  if (lower == upper) return std::nullopt;
  return Vector3(principal.eigenvectors().col(lower ? 2 : 0)).normalized();
}

/// Computes the constants that depend on mounted rotors; call it after all are lumped in.
void finish_body(BodyProperties& body, const BodyDef& def) {
  const Vector3 own_axis = def.orientation.normalized().conjugate() * body.axis;
  if (body.mobility == Mobility::free) {
    body.inverse_inertia = body.inertia.inverse();
    const double mean = body.inertia.trace() / 3.0;
    body.isotropic =
        (body.inertia - mean * Matrix3::Identity()).cwiseAbs().maxCoeff() <= 1e-12 * mean;
    body.symmetry_axis = find_symmetry_axis(body.inertia);
  }
  if (body.mobility == Mobility::planar || (body.mobility == Mobility::rotor && body.mount < 0)) {
    body.axis_inertia = def.spin_inertia.value_or(own_axis.dot(body.inertia * own_axis));
  }
}

/// Whether the definition of a kinematic body gives it a motion.
bool moves_by_itself(const BodyDef& body) {
  return !is_zero(body.velocity) || !is_zero(body.angular_velocity) || !is_zero(body.oscillation);
}

struct Ball {
  Vector3 center;
  double radius = 0.0;
};

/// The distance from a point to the far side of the ball that is farthest away, and that ball.
std::pair<double, const Ball*> farthest(const Vector3& from, const std::vector<Ball>& balls) {
  std::pair<double, const Ball*> most{0.0, nullptr};
  for (const Ball& ball : balls) {
    const double distance = (ball.center - from).norm() + ball.radius;
    if (most.second == nullptr || distance > most.first) most = {distance, &ball};
  }
  return most;
}

/// About the greatest distance within the scene: from the part farthest from the middle to the part
/// farthest from that one. The value does not change when the scene is turned. A bounding box would
/// change with the orientation, and with it the solvers' tolerances and results.
double scene_scale(const std::vector<BodyDef>& bodies) {
  std::vector<Ball> balls;
  Vector3 middle = Vector3::Zero();
  double largest = 0.0;
  for (const BodyDef& body : bodies) {
    middle += body.position / static_cast<double>(bodies.size());
    balls.push_back({body.position});
    for (const PlacedShape& placed : body.shapes) {
      const double radius = placed.shape->half_extent().norm();
      balls.push_back({body.position + body.orientation * placed.position, radius});
      largest = std::max(largest, 2.0 * radius);
    }
  }
  const Ball* end = farthest(middle, balls).second;
  if (end == nullptr) return 1.0;
  const double scale = std::max(farthest(end->center, balls).first + end->radius, largest);
  return scale > 0.0 ? scale : 1.0;
}

/// Distance from the body's origin to its farthest point; without shapes the radius of gyration;
/// without a mass, `scale`.
double size_of_body(const BodyProperties& body, const BodyDef& def, double scale) {
  double size = 0.0;
  for (const PlacedShape& placed : def.shapes) {
    size = std::max(size, placed.position.norm() + placed.shape->half_extent().norm());
  }
  if (size == 0.0 && body.mass > 0.0) {
    size = std::sqrt(std::max(body.inertia.trace() / 3.0, body.axis_inertia) / body.mass);
  }
  return size > 0.0 ? std::min(size, scale) : scale;
}

}  // namespace

Result<BodySet> BodySet::create(const Model& model) {
  Errors errors = check_bodies(model);
  if (!errors.empty()) return errors;
  BodySet set;
  set.definitions_ = model.bodies;
  set.gravity_ = model.gravity;
  set.properties_.reserve(model.bodies.size() + 1);
  for (const BodyDef& body : model.bodies) set.properties_.push_back(compile_body(body));
  for (int i = 0; i < set.count(); ++i) {
    if (model.bodies[at(i)].mount) lump_mounted_rotor(set.properties_, model.bodies, i);
  }
  for (int i = 0; i < set.count(); ++i) {
    BodyProperties& body = set.properties_[at(i)];
    if (body.mount >= 0) body.mount_position -= set.properties_[at(body.mount)].center_of_mass;
    finish_body(body, model.bodies[at(i)]);
  }
  set.scale_ = scene_scale(model.bodies);
  for (int i = 0; i < set.count(); ++i) {
    BodyProperties& body = set.properties_[at(i)];
    body.size = size_of_body(body, model.bodies[at(i)], set.scale_);
  }
  set.properties_.emplace_back();  // the world
  set.coordinates_ = Coordinates(set.properties_);
  return set;
}

const std::string& BodySet::name(int index) const {
  static const std::string world = "world";
  return index == count() ? world : definition(index).name;
}

State BodySet::initial_state() const {
  State state;
  state.bodies.reserve(at(count()));
  for (int i = 0; i < count(); ++i) {
    const BodyDef& def = definition(i);
    BodyState body;
    if ((*this)[i].mobility == Mobility::kinematic) {
      state.bodies.push_back(kinematic_state(i, 0.0));
      continue;
    }
    body.orientation = def.orientation.normalized();
    const Vector3 offset = body.orientation * (*this)[i].center_of_mass;
    body.position = def.position + offset;
    body.velocity = def.velocity + def.angular_velocity.cross(offset);
    body.angular_velocity = def.angular_velocity;
    state.bodies.push_back(body);
  }
  for (int i = 0; i < count(); ++i) {
    // A mounted rotor moves with its carrier; only the spin about the axle is its own.
    const int mount = (*this)[i].mount;
    if (mount < 0) continue;
    const BodyState& carrier = state.bodies[at(mount)];
    BodyState& rotor = state.bodies[at(i)];
    const Vector3 axis = carrier.orientation * (*this)[i].axis;
    const Vector3 offset = carrier.orientation * (*this)[i].mount_position;
    rotor.position = carrier.position + offset;
    rotor.velocity = carrier.velocity + carrier.angular_velocity.cross(offset);
    rotor.angular_velocity = carrier.angular_velocity +
                             axis * axis.dot(rotor.angular_velocity - carrier.angular_velocity);
  }
  return state;
}

BodyFrame BodySet::frame(int index, const BodyFrames& frames) const {
  if (index == count()) return {};
  if (frames != nullptr && at(index) < frames->size()) return (*frames)[at(index)];
  return {definition(index).position, initial_orientation(index)};
}

State BodySet::state_in(const BodyFrames& frames) const {
  State state = initial_state();
  if (frames == nullptr) return state;
  for (int i = 0; i < count() && at(i) < frames->size(); ++i) {
    const BodyFrame& frame = (*frames)[at(i)];
    BodyState& body = state.bodies[at(i)];
    body.orientation = frame.orientation;
    body.position = frame.position + frame.orientation * (*this)[i].center_of_mass;
  }
  return state;
}

Quaternion BodySet::initial_orientation(int index) const {
  if (index == count()) return Quaternion::Identity();
  return definition(index).orientation.normalized();
}

Vector3 BodySet::initial_point(int index, const Vector3& local) const {
  if (index == count()) return local;
  return definition(index).position + initial_orientation(index) * local;
}

bool BodySet::stays_in_plane(int index, const Vector3& normal) const {
  constexpr double tolerance = 1e-12;  // rounding of a normalised vector
  const BodyProperties& body = (*this)[index];
  const auto parallel = [&](const Vector3& v) { return v.cross(normal).norm() <= tolerance; };
  switch (body.mobility) {
    case Mobility::fixed:
      return true;
    case Mobility::planar:
      return parallel(body.axis);
    case Mobility::slider:
      return std::abs(body.axis.dot(normal)) <= tolerance;
    case Mobility::rotor:
      if (body.mount >= 0) {
        return stays_in_plane(body.mount, normal) &&
               parallel(initial_orientation(body.mount) * body.axis);
      }
      return parallel(body.axis);
    case Mobility::kinematic: {
      const BodyDef& def = definition(index);
      if (def.axis) return parallel(def.axis->normalized());
      // World::set_motion() may move it in any direction.
      if (!moves_by_itself(def)) return false;
      return def.velocity.dot(normal) == 0.0 && def.oscillation.dot(normal) == 0.0 &&
             def.angular_velocity.cross(normal).norm() == 0.0;
    }
    case Mobility::free:
    case Mobility::knot:
      return false;
  }
  return false;
}

BodyState BodySet::kinematic_state(int index, double time) const {
  const BodyDef& def = definition(index);
  const double rate = 2.0 * pi * def.oscillation_frequency;
  const double phase = rate * time + def.oscillation_phase;
  BodyState state;
  state.position = def.position + time * def.velocity +
                   (portable::sin(phase) - portable::sin(def.oscillation_phase)) * def.oscillation;
  state.velocity = def.velocity + rate * portable::cos(phase) * def.oscillation;
  state.angular_velocity = def.angular_velocity;
  state.orientation = rotation_by(time * def.angular_velocity) * def.orientation.normalized();
  return state;
}

}  // namespace sheave
