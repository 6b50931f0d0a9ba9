// The motions of kinematic bodies.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

class SetMotion final : public Control {
 public:
  std::string body;
  Vector3 position = Vector3::Zero();
  Quaternion orientation{0.0, 0.0, 0.0, 0.0};  // all zeros: unchanged
  std::optional<Vector3> velocity;
  std::optional<Vector3> angular_velocity;
  std::optional<double> over;

  static constexpr std::string_view type_name = "motion";
  static constexpr std::string_view type_meaning = "target of the motion of a kinematic body";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetMotion::body>("body", "", {}, required, "name of the kinematic body"),
        field<&SetMotion::position>("position", "m", any_number(), required,
                                    "target position of its origin"),
        field<&SetMotion::orientation>(
            "orientation", "", {}, optional,
            "target orientation, by the shorter turn; default: the present one"),
        field<&SetMotion::velocity>(
            "velocity", "m/s", any_number(), optional,
            "velocity at the target, by a smooth path; default: it goes straight and stops there"),
        field<&SetMotion::angular_velocity>("angular_velocity", "rad/s", any_number(), optional,
                                            "likewise; needs `velocity`"),
        field<&SetMotion::over>("over", "s", above(0.0), optional, "duration; default: a step"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    MotionTarget target;
    target.position = position;
    if (!orientation.coeffs().isZero(0.0)) target.orientation = orientation;
    target.velocity = velocity;
    target.angular_velocity = angular_velocity;
    target.over = over;
    return at_pointer(world.set_motion(*handle, target), "");
  }
};

class ClearMotion final : public Control {
 public:
  std::string body;
  std::optional<double> over;

  static constexpr std::string_view type_name = "motion";
  static constexpr std::string_view type_meaning =
      "the motion of a kinematic body, which returns to that of its definition";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearMotion::body>("body", "", {}, required, "name of the kinematic body"),
        field<&ClearMotion::over>("over", "s", above(0.0), optional, "duration; default: a step"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    return handle ? at_pointer(world.clear_motion(*handle, over), "") : handle.errors();
  }
};

}  // namespace

TypeEntry<Control> set_motion() { return control_entry<SetMotion>(); }
TypeEntry<Control> clear_motion() { return control_entry<ClearMotion>(); }

}  // namespace sheave::live
