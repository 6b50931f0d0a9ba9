// Gravity.

#include <array>

#include "live/control.h"

namespace sheave::live {
namespace {

class SetGravity final : public Control {
 public:
  Vector3 value = Vector3::Zero();

  static constexpr std::string_view type_name = "gravity";
  static constexpr std::string_view type_meaning = "the acceleration of free fall";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetGravity::value>("value", "m/s2", any_number(), required, "the acceleration"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& /*names*/) const override {
    return at_pointer(world.set_gravity(value), "/value");
  }
};

class ClearGravity final : public Control {
 public:
  static constexpr std::string_view type_name = "gravity";
  static constexpr std::string_view type_meaning = "the acceleration of free fall";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& /*names*/) const override {
    world.clear_gravity();
    return {};
  }
};

}  // namespace

TypeEntry<Control> set_gravity() { return control_entry<SetGravity>(); }
TypeEntry<Control> clear_gravity() { return control_entry<ClearGravity>(); }

}  // namespace sheave::live
