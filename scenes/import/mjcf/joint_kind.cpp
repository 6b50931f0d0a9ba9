#include "scenes/import/mjcf/joint_kind.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"

namespace sheave::import::mjcf {
namespace {

constexpr double right = 1e-9;  // of directions and of distances in sizes of the body

bool perpendicular(const Joint& a, const Joint& b) { return std::abs(a.axis.dot(b.axis)) < right; }

/// The joints of one body, and their effects.
class KindFinder {
 public:
  KindFinder(const Model& model, int body)
      : model_(model), numbers_(model.bodies[at(body)].joints) {}

  [[nodiscard]] JointKind find() const {
    const auto hinges = count(JointType::hinge);
    const auto slides = count(JointType::slide);
    if (count(JointType::free) == 1) return JointKind::free;
    if (count(JointType::ball) > 0) return numbers_.size() == 1 ? JointKind::ball : JointKind::none;
    if (hinges == 1 && slides == 0) return JointKind::hinge;
    if (hinges == 0 && slides == 1) return JointKind::slider;
    bool fits = false;
    JointKind kind = JointKind::none;
    if (hinges == 2 && slides == 0) {
      kind = JointKind::universal;
      fits = is_universal();
    } else if (hinges == 1 && slides == 1) {
      kind = JointKind::cylindrical;
      fits = joint(0).axis.cross(joint(1).axis).norm() <= right;
    } else if (hinges == 1 && slides == 2) {
      kind = JointKind::plane;
      fits = is_plane();
    } else if (hinges == 3 && slides == 0) {
      kind = JointKind::three_hinges;
      fits = is_ball();
    }
    return fits ? kind : JointKind::none;
  }

 private:
  [[nodiscard]] const Joint& joint(std::size_t i) const { return model_.joints[at(numbers_[i])]; }
  [[nodiscard]] long count(JointType type) const {
    return std::count_if(numbers_.begin(), numbers_.end(),
                         [&](int j) { return model_.joints[at(j)].type == type; });
  }
  [[nodiscard]] bool all_perpendicular() const {
    return perpendicular(joint(0), joint(1)) && perpendicular(joint(0), joint(2)) &&
           perpendicular(joint(1), joint(2));
  }

  /// Whether an actuator, a fixed tendon or an equality needs the coordinate of a joint.
  [[nodiscard]] bool is_named(int number) const {
    const auto by_actuator = [&](const Actuator& one) { return one.joint == number; };
    const auto by_equality = [&](const Equality& one) {
      return one.type == EqualityType::joint && (one.joint1 == number || one.joint2 == number);
    };
    const auto by_tendon = [&](const Tendon& one) {
      return std::any_of(one.joints.begin(), one.joints.end(), [&](const TendonJoint& part) {
        return part.joint == number && part.factor != 0.0;
      });
    };
    return std::any_of(model_.actuators.begin(), model_.actuators.end(), by_actuator) ||
           std::any_of(model_.equalities.begin(), model_.equalities.end(), by_equality) ||
           std::any_of(model_.tendons.begin(), model_.tendons.end(), by_tendon);
  }

  [[nodiscard]] bool is_universal() const {
    return perpendicular(joint(0), joint(1)) && meeting_point(joint(0), joint(1));
  }

  [[nodiscard]] bool is_plane() const {
    double damping = -1.0;
    for (const int number : numbers_) {
      const Joint& slide = model_.joints[at(number)];
      if (slide.type != JointType::slide) continue;
      const bool equal = damping < 0.0 || damping == slide.damping;
      damping = slide.damping;
      if (!equal || slide.range || slide.stiffness > 0.0 || slide.friction > 0.0 ||
          slide.armature > 0.0 || is_named(number)) {
        return false;
      }
    }
    return all_perpendicular();
  }

  [[nodiscard]] bool is_ball() const {
    for (const int number : numbers_) {
      if (!model_.joints[at(number)].is_plain() || is_named(number)) return false;
    }
    const auto first = meeting_point(joint(0), joint(1));
    const auto second = meeting_point(joint(1), joint(2));
    return all_perpendicular() && first && second && (*first - *second).norm() <= right;
  }

  const Model& model_;
  const std::vector<int>& numbers_;
};

}  // namespace

std::optional<Vector3> meeting_point(const Joint& a, const Joint& b) {
  const Vector3 way = b.position - a.position;
  const Vector3 across = a.axis.cross(b.axis);
  if (!(across.norm() > right)) return {};
  const double size = 1.0 + way.norm();
  if (std::abs(across.dot(way)) > right * size * across.norm()) return {};
  // The point a + t u that lies on the other axis.
  const double t = way.cross(b.axis).dot(across) / across.squaredNorm();
  return a.position + t * a.axis;
}

JointKind joint_kind(const Model& model, int body) { return KindFinder(model, body).find(); }

}  // namespace sheave::import::mjcf
