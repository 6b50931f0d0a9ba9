// The mass matrix by composite bodies: two velocities share the inertia of all bodies that both of
// them move, the bodies behind the later one. All screws are about the origin of the world.

#include "scenes/import/mjcf/joint_motion.h"

#include "engine/index.h"

namespace sheave::import::mjcf {
namespace {

/// Mass, first moment and moment of inertia about the world's origin, world axes.
struct Composite {
  double mass = 0.0;
  Vector3 moment = Vector3::Zero();   // mass times centre
  Matrix3 inertia = Matrix3::Zero();  // about the origin

  void add(const Composite& other) {
    mass += other.mass;
    moment += other.moment;
    inertia += other.inertia;
  }
  /// Momentum of a motion.
  [[nodiscard]] Screw operator*(const Screw& motion) const {
    return {mass * motion.linear + motion.angular.cross(moment),
            inertia * motion.angular + moment.cross(motion.linear)};
  }
};

Composite composite_of(const Inertial& own, const Frame& frame) {
  const Inertial there = own.seen_from(frame);
  Composite made;
  made.mass = there.mass;
  made.moment = there.mass * there.center;
  made.inertia = there.inertia + there.mass * (there.center.squaredNorm() * Matrix3::Identity() -
                                               there.center * there.center.transpose());
  return made;
}

Screw operator+(const Screw& a, const Screw& b) {
  return {a.linear + b.linear, a.angular + b.angular};
}

/// The change of the motion `b` that is fixed to a body of the motion `a`.
Screw cross(const Screw& a, const Screw& b) {
  return {a.angular.cross(b.linear) + a.linear.cross(b.angular), a.angular.cross(b.angular)};
}

Screw turn_screw(const Vector3& axis, const Vector3& anchor) { return {anchor.cross(axis), axis}; }

}  // namespace

JointMotion::JointMotion(const Model& model, const Pose& pose) : model_(model), pose_(pose) {
  screws_.resize(at(model.velocity_count));
  bodies_.resize(at(model.velocity_count));
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    const JointPose& place = pose.joints[j];
    const Matrix3 axes = pose.bodies[at(joint.body)].frame.orientation.toRotationMatrix();
    Screw* const own = &screws_[at(joint.qvel)];
    for (int k = 0; k < joint.velocity_count(); ++k) bodies_[at(joint.qvel + k)] = joint.body;
    switch (joint.type) {
      case JointType::hinge:
        own[0] = turn_screw(place.axis, place.anchor);
        break;
      case JointType::slide:
        own[0] = {place.axis, Vector3::Zero()};
        break;
      case JointType::ball:
        for (int k = 0; k < 3; ++k) own[k] = turn_screw(axes.col(k), place.anchor);
        break;
      case JointType::free:
        for (int k = 0; k < 3; ++k) {
          own[k] = {Vector3::Unit(k), Vector3::Zero()};
          own[k + 3] = turn_screw(axes.col(k), pose.bodies[at(joint.body)].frame.position);
        }
        break;
    }
  }
}

JointMatrix JointMotion::mass_matrix() const {
  std::vector<Composite> behind(model_.bodies.size());
  for (std::size_t i = model_.bodies.size() - 1; i >= 1; --i) {
    const Body& body = model_.bodies[i];
    behind[i].add(composite_of(body.inertial, pose_.bodies[i].frame));
    behind[at(body.parent)].add(behind[i]);
  }
  const auto count = static_cast<Eigen::Index>(screws_.size());
  JointMatrix mass = JointMatrix::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto own = static_cast<std::size_t>(i);
    const Screw momentum = behind[at(bodies_[own])] * screws_[own];
    // Velocities stand behind those of the bodies that carry them.
    for (int body = bodies_[own]; body != 0; body = model_.bodies[at(body)].parent) {
      for (const int joint : model_.bodies[at(body)].joints) {
        const Joint& other = model_.joints[at(joint)];
        for (int k = 0; k < other.velocity_count() && other.qvel + k <= i; ++k) {
          const Eigen::Index place = other.qvel + k;
          mass(i, place) = mass(place, i) = momentum.dot(screws_[at(other.qvel + k)]);
        }
      }
    }
  }
  for (const Joint& joint : model_.joints) {
    for (int k = 0; k < joint.velocity_count(); ++k) {
      mass(joint.qvel + k, joint.qvel + k) += joint.armature;
    }
  }
  return mass;
}

JointVector JointMotion::arms(const TendonPull& tendon) const { return along(tendon.pulls); }

// The axes of a joint move with the body before it, so the screws of its velocities change by the
// cross product with the motion of that body. The world's axes of a free joint do not move.
JointVector JointMotion::bias(const JointVector& velocities) const {
  std::vector<Screw> motions(model_.bodies.size());
  std::vector<Screw> changes(model_.bodies.size());
  std::vector<Screw> forces(model_.bodies.size());
  for (std::size_t i = 1; i < model_.bodies.size(); ++i) {
    const Body& body = model_.bodies[i];
    Screw& motion = motions[i] = motions[at(body.parent)];
    Screw& change = changes[i] = changes[at(body.parent)];
    for (const int j : body.joints) {
      const Joint& joint = model_.joints[at(j)];
      const int count = joint.velocity_count();
      const int linear = joint.type == JointType::free ? 3 : 0;
      motion = motion + part(velocities, joint.qvel, joint.qvel + linear);
      const Screw own = part(velocities, joint.qvel + linear, joint.qvel + count);
      change = change + cross(motion, own);
      motion = motion + own;
    }
    const Composite mass = composite_of(body.inertial, pose_.bodies[i].frame);
    const Screw momentum = mass * motion;
    forces[i] = mass * change;
    forces[i].linear += motion.angular.cross(momentum.linear);
    forces[i].angular +=
        motion.angular.cross(momentum.angular) + motion.linear.cross(momentum.linear);
  }
  return along(std::move(forces));
}

Screw JointMotion::part(const JointVector& velocities, int first, int end) const {
  Screw sum;
  for (int k = first; k < end; ++k) {
    sum =
        sum + Screw{velocities[k] * screws_[at(k)].linear, velocities[k] * screws_[at(k)].angular};
  }
  return sum;
}

JointVector JointMotion::along(std::vector<Screw> behind) const {
  for (std::size_t i = behind.size() - 1; i >= 1; --i) {
    Screw& outer = behind[at(model_.bodies[i].parent)];
    outer.linear += behind[i].linear;
    outer.angular += behind[i].angular;
  }
  JointVector arms(static_cast<Eigen::Index>(screws_.size()));
  for (std::size_t i = 0; i < screws_.size(); ++i) {
    arms[static_cast<Eigen::Index>(i)] = behind[at(bodies_[i])].dot(screws_[i]);
  }
  return arms;
}

void advance(const Model& model, const JointVector& velocities, double time,
             std::vector<double>& positions) {
  const auto turn = [&](double* quaternion, int first) {
    const Vector3 way = time * velocities.segment<3>(first);
    const double angle = way.norm();
    if (!(angle > 0.0)) return;
    const Quaternion now(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
    const Quaternion next = (now * turn_about(way, angle)).normalized();
    quaternion[0] = next.w();
    for (int k = 0; k < 3; ++k) quaternion[k + 1] = next.vec()[k];
  };
  for (const Joint& joint : model.joints) {
    double* const q = &positions[at(joint.qpos)];
    if (joint.type == JointType::ball) {
      turn(q, joint.qvel);
      continue;
    }
    const int linear = joint.type == JointType::free ? 3 : 1;
    for (int k = 0; k < linear; ++k) q[k] += time * velocities[joint.qvel + k];
    if (joint.type == JointType::free) turn(q + 3, joint.qvel + 3);
  }
}

}  // namespace sheave::import::mjcf
