// Forces at points of bodies.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

constexpr std::array<std::string_view, 2> frame_names{"world", "body"};

class SetForce final : public Control {
 public:
  std::string body;
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  std::optional<Vector3> point;
  ForceFrame frame = ForceFrame::world;

  static constexpr std::string_view type_name = "force";
  static constexpr std::string_view type_meaning =
      "a force at a point of a body, and a torque, in addition to those of its definition; it acts "
      "until it is set again or cleared";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetForce::body>("body", "", {}, required, "name of the body"),
        field<&SetForce::force>("force", "N", any_number(), optional, "the force"),
        field<&SetForce::torque>("torque", "N m", any_number(), optional,
                                 "torque, in addition to that of the force"),
        field<&SetForce::point>("point", "m", any_number(), optional,
                                "where the force acts, in the body's frame, moving with it; "
                                "default: the centre of mass"),
        choice_field<&SetForce::frame>("frame", frame_names, optional,
                                       "frame of the components of `force` and `torque`"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    return at_pointer(world.set_force(*handle, {force, torque, point, frame}), "");
  }
};

class ClearForce final : public Control {
 public:
  std::string body;

  static constexpr std::string_view type_name = "force";
  static constexpr std::string_view type_meaning = "the force and torque on a body";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearForce::body>("body", "", {}, required, "name of the body"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    return handle ? at_pointer(world.clear_force(*handle), "") : handle.errors();
  }
};

}  // namespace

TypeEntry<Control> set_force() { return control_entry<SetForce>(); }
TypeEntry<Control> clear_force() { return control_entry<ClearForce>(); }

}  // namespace sheave::live
