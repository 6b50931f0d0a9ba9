// Sizes. A pin must be visible beside the bodies it joins and hide neither of them. Its radius is
// 0.6 of the half thickness of the thinner body, within limits set by the size of the scene, and it
// stands out on both sides by its radius.

#include "render/joint_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/math/turn_between.h"

namespace sheave::render {
namespace {

constexpr Color steel = rgb(0xc9ced6);
constexpr Color rail_color = rgb(0xa3adb9);

/// A part of a line, by the line's parameter [m].
struct Interval {
  double first = 0.0;
  double last = 0.0;
  void join(const Interval& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

/// A point and a direction, given in the world at time 0, in the frame of a body.
struct BodyLine {
  Vector3 point;
  Vector3 direction;
};

/// The part of the line inside the box with these half edges; nothing if the line passes the box
/// by.
std::optional<Interval> clip(const BodyLine& line, const Vector3& half) {
  Interval inside{-std::numeric_limits<double>::infinity(),
                  std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 3; ++i) {
    const double d = line.direction[i];
    if (std::abs(d) < 1e-9) {
      if (std::abs(line.point[i]) > half[i]) return std::nullopt;
      continue;
    }
    const double one = (-half[i] - line.point[i]) / d;
    const double other = (half[i] - line.point[i]) / d;
    inside.first = std::max(inside.first, std::min(one, other));
    inside.last = std::min(inside.last, std::max(one, other));
  }
  if (inside.first > inside.last) return std::nullopt;
  return inside;
}

/// The smallest half edge across `direction`.
double half_thickness(const Vector3& half, const Vector3& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(direction[i]) < 0.7) least = std::min(least, half[i]);
  }
  return least;
}

class JointViewBuilder {
 public:
  JointViewBuilder(const World& world, double unit, std::span<const JointTravel> travels)
      : bodies_(world.bodies()) {
    view_.unit = unit;
    const auto& joints = world.model().joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      piece_ = {};
      piece_.joint = static_cast<int>(i);
      defined_in_ = joints[i]->defined_in;
      travel_ = i < travels.size() ? travels[i] : JointTravel{};
      add(*joints[i]);
      if (piece_.parts.empty() && piece_.bars.empty() && piece_.lines.empty()) continue;
      view_.pieces.push_back(std::move(piece_));
    }
  }
  JointView take() { return std::move(view_); }

 private:
  void add(const JointDef& joint) {
    if (const auto* j = dynamic_cast<const DistanceJoint*>(&joint)) return add_line(*j);
    if (const auto* j = dynamic_cast<const HingeJoint*>(&joint)) return add_pin(*j);
    if (const auto* j = dynamic_cast<const BallJoint*>(&joint)) return add_ball(*j);
    if (const auto* j = dynamic_cast<const UniversalJoint*>(&joint)) return add_cross(*j);
    if (const auto* j = dynamic_cast<const SliderJoint*>(&joint)) return add_rail(*j);
    if (const auto* j = dynamic_cast<const CylindricalJoint*>(&joint)) return add_rail(*j);
  }

  [[nodiscard]] Vector3 local_point(BodyId body, const Vector3& point) const {
    const BodyFrame frame = bodies_.frame(bodies_.index(body), defined_in_);
    return frame.orientation.conjugate() * (point - frame.position);
  }
  [[nodiscard]] Vector3 local_direction(BodyId body, const Vector3& direction) const {
    const BodyFrame frame = bodies_.frame(bodies_.index(body), defined_in_);
    return frame.orientation.conjugate() * direction;
  }
  [[nodiscard]] bool is_fixed(BodyId body) const {
    return body.is_world() || bodies_.definition(bodies_.index(body)).mobility == Mobility::fixed;
  }
  /// Calls `see` for every shape with its half edges and the line in the shape's frame.
  template <class See>
  void for_shapes(BodyId body, const Vector3& point, const Vector3& direction, See see) const {
    if (body.is_world()) return;
    const Vector3 at = local_point(body, point);
    const Vector3 along = local_direction(body, direction);
    for (const PlacedShape& placed : bodies_.definition(bodies_.index(body)).shapes) {
      const Quaternion turn = placed.orientation.conjugate();
      see(placed.shape->half_extent(), BodyLine{turn * (at - placed.position), turn * along});
    }
  }

  /// The extent of a pin along `axis` through `anchor`, and its radius.
  struct PinSize {
    Interval reach;
    double radius = 0.0;
  };
  [[nodiscard]] PinSize pin_size(const JointDef& joint, const Vector3& anchor,
                                 const Vector3& axis) const {
    const double largest = 2.5 * view_.unit;
    PinSize size{{0.0, 0.0}, largest};
    for (const BodyId body : {joint.body_a, joint.body_b}) {
      for_shapes(body, anchor, axis, [&](const Vector3& half, const BodyLine& line) {
        const std::optional<Interval> inside = clip(line, half);
        // A shape far from the anchor has nothing to do with this joint.
        if (!inside || inside->first > 4.0 * largest || inside->last < -4.0 * largest) return;
        size.reach.join(*inside);
        size.radius = std::min(size.radius, 0.6 * half_thickness(half, line.direction));
      });
    }
    size.radius = std::max(size.radius, 0.8 * view_.unit);
    size.reach.join({-size.radius, size.radius});
    return size;
  }
  void add_cylinder(BodyId body, const Vector3& middle, const Vector3& axis, double radius,
                    double length) {
    const Vector3 own = local_direction(body, axis);
    const Quaternion turn = turn_between(Vector3::UnitZ(), own);
    piece_.parts.push_back(
        {body, CylinderShape{radius, length}, local_point(body, middle), turn, steel});
  }

  void add_pin(const HingeJoint& joint) {
    const Vector3 axis = joint.axis.normalized();
    const PinSize size = pin_size(joint, joint.anchor, axis);
    const Vector3 middle = joint.anchor + 0.5 * (size.reach.first + size.reach.last) * axis;
    const double length = size.reach.last - size.reach.first + 2.0 * size.radius;
    add_cylinder(joint.body_b, middle, axis, size.radius, length);
  }

  void add_ball(const BallJoint& joint) {
    // The ball is a little larger than the thinner of the two bodies if that body is slender, like
    // a link of a chain.
    const double largest = 3.0 * view_.unit;
    double radius = largest;
    for (const BodyId body : {joint.body_a, joint.body_b}) {
      for_shapes(body, joint.anchor, Vector3::Zero(),
                 [&](const Vector3& half, const BodyLine& line) {
                   const Vector3 beyond = line.point.cwiseAbs() - half;
                   if (beyond.maxCoeff() > largest) return;
                   radius = std::min(radius, 1.25 * half.minCoeff());
                 });
    }
    piece_.parts.push_back({joint.body_b, SphereShape{std::max(radius, view_.unit)},
                            local_point(joint.body_b, joint.anchor), Quaternion::Identity(),
                            steel});
  }

  void add_cross(const UniversalJoint& joint) {
    const Vector3 axis_a = joint.axis_a.normalized();
    const Vector3 axis_b = joint.axis_b.normalized();
    const double radius = std::min(pin_size(joint, joint.anchor, axis_a).radius,
                                   pin_size(joint, joint.anchor, axis_b).radius);
    add_cylinder(joint.body_a, joint.anchor, axis_a, radius, 7.0 * radius);
    add_cylinder(joint.body_b, joint.anchor, axis_b, radius, 7.0 * radius);
  }

  /// The interval that the shapes of a body (the boxes round them) cover along the axis through the
  /// anchor.
  [[nodiscard]] std::optional<Interval> extent(BodyId body, const Vector3& anchor,
                                               const Vector3& axis) const {
    std::optional<Interval> all;
    for_shapes(body, anchor, axis, [&](const Vector3& half, const BodyLine& line) {
      const double middle = -line.point.dot(line.direction);
      const double reach = line.direction.cwiseAbs().dot(half);
      if (!all) all = Interval{middle - reach, middle + reach};
      all->join({middle - reach, middle + reach});
    });
    return all;
  }

  /// The interval between the stops; without stops, the travel of the body and a margin. Nothing if
  /// the body did not move or its travel is not known. size: size of the body [m].
  [[nodiscard]] std::optional<Interval> travel_range(const JointCoordinate& travel,
                                                     double size) const {
    const bool moved = travel_.upper - travel_.lower > 0.01 * size;
    if ((!travel.lower || !travel.upper) && !moved) return std::nullopt;
    const double more = 4.0 * view_.unit;
    return Interval{travel.lower ? *travel.lower : travel_.lower - more,
                    travel.upper ? *travel.upper : travel_.upper + more};
  }

  template <class Joint>
  void add_rail(const Joint& joint) {
    const Vector3 axis = joint.axis.normalized();
    // The body that moves less carries the rail. body_b moves along the axis relative to body_a;
    // body_a moves the other way relative to body_b.
    const bool on_b = is_fixed(joint.body_b) && !is_fixed(joint.body_a);
    const BodyId carrier = on_b ? joint.body_b : joint.body_a;
    const BodyId rider = on_b ? joint.body_a : joint.body_b;
    const double sense = on_b ? -1.0 : 1.0;
    const double least = 4.0 * view_.unit;
    const Interval body = extent(rider, joint.anchor, axis).value_or(Interval{-least, least});
    Interval rail = body;
    if (const auto range = travel_range(joint.travel, body.last - body.first)) {
      for (const double stop : {range->first, range->last})
        rail.join({body.first + sense * stop, body.last + sense * stop});
    } else if (const auto ground = extent(carrier, joint.anchor, axis)) {
      rail.join(*ground);
    } else {
      const double more = body.last - body.first;
      rail.join({body.first - more, body.last + more});
    }
    piece_.bars.push_back({carrier, local_point(carrier, joint.anchor + rail.first * axis),
                           local_point(carrier, joint.anchor + rail.last * axis), 0.8 * view_.unit,
                           rail_color});
  }

  void add_line(const DistanceJoint& joint) {
    using Kind = JointLine::Kind;
    JointLine line;
    line.body_a = joint.body_a;
    line.body_b = joint.body_b;
    switch (joint.limit) {
      case DistanceLimit::exactly:
        line.kind = joint.compliance > 0.0 ? Kind::spring : Kind::rod;
        break;
      case DistanceLimit::at_most:
        line.kind = Kind::string;
        break;
      case DistanceLimit::at_least:
        line.kind = Kind::bumper;
        break;
      case DistanceLimit::none:
        line.kind = Kind::telescope;
        break;
    }
    const Vector3 apart = joint.anchor_b - joint.anchor_a;
    line.start = local_point(joint.body_a, joint.anchor_a);
    line.end = local_point(joint.body_b, joint.anchor_b);
    const Vector3 along = apart.norm() > 0.0 ? apart : Vector3(Vector3::UnitY());
    line.side = local_direction(joint.body_a, any_perpendicular(along.normalized()));
    line.length = joint.length.value_or(apart.norm());
    piece_.lines.push_back(line);
  }

  const BodySet& bodies_;
  JointView view_;
  JointView::Piece piece_;
  JointTravel travel_;     // travel of the joint of piece_
  BodyFrames defined_in_;  // frames in which the joint of piece_ is defined
};

}  // namespace

JointView make_joint_view(const World& world, double unit, std::span<const JointTravel> travels) {
  return JointViewBuilder(world, unit, travels).take();
}

}  // namespace sheave::render
