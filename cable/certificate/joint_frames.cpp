#include "cable/certificate/joint_frames.h"

#include <limits>

#include "engine/joints/ball.h"
#include "engine/joints/coupling.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"

namespace sheave::certify {
namespace {

/// Calls `visit` with the joint as its derived type.
template <class Visit>
void visit_joint(const JointDef& joint, const Visit& visit) {
  const std::string_view type = joint.type();
  if (type == BallJoint::type_name) visit(static_cast<const BallJoint&>(joint));
  if (type == CouplingJoint::type_name) visit(static_cast<const CouplingJoint&>(joint));
  if (type == CylindricalJoint::type_name) visit(static_cast<const CylindricalJoint&>(joint));
  if (type == DistanceJoint::type_name) visit(static_cast<const DistanceJoint&>(joint));
  if (type == FixedJoint::type_name) visit(static_cast<const FixedJoint&>(joint));
  if (type == GearJoint::type_name) visit(static_cast<const GearJoint&>(joint));
  if (type == HingeJoint::type_name) visit(static_cast<const HingeJoint&>(joint));
  if (type == PlaneJoint::type_name) visit(static_cast<const PlaneJoint&>(joint));
  if (type == RackJoint::type_name) visit(static_cast<const RackJoint&>(joint));
  if (type == SliderJoint::type_name) visit(static_cast<const SliderJoint&>(joint));
  if (type == UniversalJoint::type_name) visit(static_cast<const UniversalJoint&>(joint));
}

class FrameMaker {
 public:
  FrameMaker(const BodySet& bodies, JointFrame& frame) : bodies_(bodies), frame_(frame) {}

  void operator()(const BallJoint& joint) const {
    frame_.kind.meets = true;
    anchor(joint.anchor);
    frame_.axis_a = frame_.axis_b = joint.axis.value_or(Vector3::UnitZ()).normalized();
    frame_.compliance = joint.compliance;
  }
  void operator()(const HingeJoint& joint) const {
    frame_.kind.meets = frame_.kind.parallel = true;
    common(joint, joint.axis);
    const auto keeps = [&](int body) { return bodies_.stays_in_plane(body, frame_.axis_a); };
    // The mobilities of both bodies keep the axes parallel.
    if (keeps(frame_.body_a) && keeps(frame_.body_b)) frame_.kind.parallel = false;
  }
  void operator()(const SliderJoint& joint) const {
    frame_.kind.on_axis = frame_.kind.no_turn = true;
    common(joint, joint.axis);
  }
  void operator()(const CylindricalJoint& joint) const {
    frame_.kind.on_axis = frame_.kind.parallel = true;
    common(joint, joint.axis);
  }
  void operator()(const PlaneJoint& joint) const {
    frame_.kind.in_plane = frame_.kind.parallel = true;
    common(joint, joint.normal);
  }
  void operator()(const UniversalJoint& joint) const {
    frame_.kind.meets = frame_.kind.right_angle = true;
    common(joint, joint.axis_a);
    // Makes the axes exactly perpendicular; the settings may be rounded.
    const Vector3 across = frame_.axis_a.cross(joint.axis_b).normalized();
    frame_.axis_b = across.cross(frame_.axis_a);
  }
  void operator()(const FixedJoint& joint) const {
    frame_.kind.meets = frame_.kind.no_turn = true;
    anchor(joint.anchor);
    frame_.compliance = joint.compliance;
    frame_.angular_compliance = joint.angular_compliance;
  }
  void operator()(const DistanceJoint& joint) const {
    frame_.kind.distance = true;
    frame_.own_anchor_a = own(frame_.body_a, joint.anchor_a);
    frame_.own_anchor_b = own(frame_.body_b, joint.anchor_b);
    frame_.length = joint.length.value_or((joint.anchor_a - joint.anchor_b).norm());
    constexpr double any = std::numeric_limits<double>::infinity();
    const bool none = joint.limit == DistanceLimit::none;
    frame_.lower = none || joint.limit == DistanceLimit::at_most ? -any : 0.0;
    frame_.upper = none || joint.limit == DistanceLimit::at_least ? any : 0.0;
    frame_.compliance = joint.compliance;
    frame_.damping = joint.damping;
  }
  void operator()(const GearJoint& joint) const {
    frame_.kind.coupling = true;
    frame_.carrier = bodies_.index(joint.carrier);
    frame_.axis_a = joint.axis_a.normalized();
    frame_.axis_b = joint.axis_b.normalized();
    frame_.ratio = joint.ratio;
  }
  void operator()(const RackJoint& joint) const {
    frame_.kind.coupling = true;
    frame_.carrier = bodies_.index(joint.carrier);
    anchor(joint.anchor);
    frame_.axis_a = joint.axis.normalized();
    frame_.axis_b = joint.direction.normalized();
    frame_.ratio = joint.radius;
  }
  void operator()(const CouplingJoint& joint) const {
    frame_.kind.coupling = frame_.kind.of_joints = true;
    frame_.compliance = joint.compliance;
  }

 private:
  [[nodiscard]] Vector3 own(int body, const Vector3& point) const {
    const BodyFrame frame = bodies_.frame(body, frame_.defined_in);
    return frame.orientation.conjugate() * (point - frame.position) - bodies_[body].center_of_mass;
  }
  void anchor(const Vector3& point) const {
    frame_.own_anchor_a = own(frame_.body_a, point);
    frame_.own_anchor_b = own(frame_.body_b, point);
  }
  template <class Joint>
  void common(const Joint& joint, const Vector3& axis) const {
    anchor(joint.anchor);
    frame_.axis_a = frame_.axis_b = axis.normalized();
    frame_.compliance = joint.compliance;
    frame_.angular_compliance = joint.angular_compliance;
  }

  const BodySet& bodies_;
  JointFrame& frame_;
};

struct CoordinateLister {
  std::vector<CoordinateSettings>& list;

  void operator()(const BallJoint& joint) const {
    if (joint.axis) list = {{&joint.twist, 0}, {nullptr, 0}};
  }
  void operator()(const HingeJoint& joint) const { list = {{&joint.angle, 2}}; }
  void operator()(const SliderJoint& joint) const { list = {{&joint.travel, 1}}; }
  void operator()(const CylindricalJoint& joint) const {
    list = {{&joint.travel, 1}, {&joint.angle, 2}};
  }
  void operator()(const PlaneJoint& joint) const { list = {{&joint.angle, 2}}; }
  void operator()(const UniversalJoint& joint) const {
    list = {{&joint.angle_a, 0}, {&joint.angle_b, 0}};
  }
  void operator()(const DistanceJoint& joint) const {
    list = {{&joint.extension, joint.limit == DistanceLimit::none ? 3 : 0}};
  }
  void operator()(const FixedJoint& /*joint*/) const {}
  void operator()(const GearJoint& /*joint*/) const {}
  void operator()(const RackJoint& /*joint*/) const {}
  void operator()(const CouplingJoint& joint) const {
    list = {{joint.held ? nullptr : &joint.travel, 4}};
  }
};

}  // namespace

JointFrame frame_of(const BodySet& bodies, const JointEvidence& joint) {
  JointFrame frame;
  frame.body_a = bodies.index(joint.definition->body_a);
  frame.body_b = bodies.index(joint.definition->body_b);
  frame.defined_in = joint.definition->defined_in;
  visit_joint(*joint.definition, FrameMaker(bodies, frame));
  (frame.kind.coupling ? frame.mesh : frame.length) += joint.hold.offset;
  frame.own_anchor_a += joint.hold.shift;
  frame.relocked = joint.hold.turn;
  return frame;
}

std::vector<CoordinateSettings> coordinates_of(const JointDef& joint) {
  std::vector<CoordinateSettings> list;
  visit_joint(joint, CoordinateLister{list});
  return list;
}

}  // namespace sheave::certify
