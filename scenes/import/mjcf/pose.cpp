// Joints of one body act one after the other, each in the frame that those before it have left: a
// slide moves the body along its axis, a hinge or a ball turns the body about its anchor.

#include "scenes/import/mjcf/pose.h"

namespace sheave::import::mjcf {
namespace {

/// Moves a body by one joint after the other.
class Mover {
 public:
  Mover(std::span<const double> positions, std::span<const double> velocities, BodyPose& body)
      : positions_(positions), velocities_(velocities), body_(body) {}

  JointPose move(const Joint& joint) {
    JointPose at;
    at.anchor = body_.frame.point(joint.position);
    at.axis = body_.frame.orientation * joint.axis;
    switch (joint.type) {
      case JointType::free:
        fly(joint);
        break;
      case JointType::slide:
        slide(joint, at);
        break;
      case JointType::hinge: {
        const double angle = position(joint, 0) - joint.reference;
        turn(joint, at, turn_about(joint.axis, angle));
        swing(at, velocity(joint, 0) * at.axis);
        break;
      }
      case JointType::ball: {
        turn(joint, at, quaternion(joint, 0));
        const Vector3 own(velocity(joint, 0), velocity(joint, 1), velocity(joint, 2));
        swing(at, body_.frame.orientation * own);
        break;
      }
    }
    return at;
  }

 private:
  [[nodiscard]] double position(const Joint& joint, int i) const {
    return positions_[static_cast<std::size_t>(joint.qpos + i)];
  }
  [[nodiscard]] double velocity(const Joint& joint, int i) const {
    return velocities_.empty() ? 0.0 : velocities_[static_cast<std::size_t>(joint.qvel + i)];
  }
  [[nodiscard]] Quaternion quaternion(const Joint& joint, int first) const {
    Quaternion q(position(joint, first), position(joint, first + 1), position(joint, first + 2),
                 position(joint, first + 3));
    return q.norm() > 1e-15 ? Quaternion(q.normalized()) : Quaternion(Quaternion::Identity());
  }

  void fly(const Joint& joint) {
    body_.frame.position = {position(joint, 0), position(joint, 1), position(joint, 2)};
    body_.frame.orientation = quaternion(joint, 3);
    body_.velocity = {velocity(joint, 0), velocity(joint, 1), velocity(joint, 2)};
    body_.angular_velocity = body_.frame.orientation *
                             Vector3(velocity(joint, 3), velocity(joint, 4), velocity(joint, 5));
  }

  void slide(const Joint& joint, const JointPose& at) {
    const Vector3 way = (position(joint, 0) - joint.reference) * at.axis;
    body_.frame.position += way;
    body_.velocity += body_.angular_velocity.cross(way) + velocity(joint, 0) * at.axis;
  }

  void turn(const Joint& joint, const JointPose& at, const Quaternion& own) {
    const Vector3 before = body_.frame.position;
    body_.frame.orientation = (body_.frame.orientation * own).normalized();
    body_.frame.position = at.anchor - body_.frame.orientation * joint.position;
    body_.velocity += body_.angular_velocity.cross(body_.frame.position - before);
  }

  /// Adds an angular velocity about the anchor.
  void swing(const JointPose& at, const Vector3& rate) {
    body_.angular_velocity += rate;
    body_.velocity += rate.cross(body_.frame.position - at.anchor);
  }

  std::span<const double> positions_;
  std::span<const double> velocities_;
  BodyPose& body_;
};

}  // namespace

std::vector<double> reference_positions(const Model& model) {
  std::vector<double> positions(static_cast<std::size_t>(model.position_count));
  for (const Joint& joint : model.joints) {
    double* const q = &positions[static_cast<std::size_t>(joint.qpos)];
    if (joint.type == JointType::free) {
      const Frame& frame = model.bodies[static_cast<std::size_t>(joint.body)].frame;
      const Quaternion& o = frame.orientation;
      for (int i = 0; i < 3; ++i) q[i] = frame.position[i];
      q[3] = o.w();
      q[4] = o.x();
      q[5] = o.y();
      q[6] = o.z();
    } else if (joint.type == JointType::ball) {
      q[0] = 1.0;
    } else {
      q[0] = joint.reference;
    }
  }
  return positions;
}

Pose pose_of(const Model& model, std::vector<double> positions,
             std::span<const double> velocities) {
  Pose pose;
  pose.bodies.resize(model.bodies.size());
  pose.joints.resize(model.joints.size());
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    const BodyPose& parent = pose.bodies[static_cast<std::size_t>(body.parent)];
    BodyPose& own = pose.bodies[i];
    own.frame = parent.frame * body.frame;
    own.frame.orientation.normalize();
    own.angular_velocity = parent.angular_velocity;
    own.velocity =
        parent.velocity + parent.angular_velocity.cross(own.frame.position - parent.frame.position);
    Mover mover(positions, velocities, own);
    for (const int joint : body.joints) {
      const auto j = static_cast<std::size_t>(joint);
      pose.joints[j] = mover.move(model.joints[j]);
    }
  }
  pose.positions = std::move(positions);
  return pose;
}

}  // namespace sheave::import::mjcf
