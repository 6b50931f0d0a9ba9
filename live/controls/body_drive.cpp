// The drives of rotors.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

/// Sets drives of one kind.
template <class Own>
class SetBodyDrive : public Control {
 public:
  std::string body;
  double value = 0.0;
  std::optional<double> over;

  [[nodiscard]] std::string_view type() const override { return Own::type_name; }
  [[nodiscard]] const void* settings() const override { return static_cast<const Own*>(this); }

 protected:
  [[nodiscard]] DriveTarget target() const {
    DriveTarget wanted(value);
    wanted.over = over;
    return wanted;
  }
  [[nodiscard]] Errors give(LiveWorld& world, const Names& names, const DriveTarget& wanted,
                            Errors (LiveWorld::*set)(BodyHandle, const DriveTarget&)) const {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    return at_pointer((world.*set)(*handle, wanted), "");
  }
  static constexpr std::string_view body_meaning = "name of the rotor";
  static constexpr std::string_view over_meaning = "time to reach it; default: a step";
};

class SetSpeed final : public SetBodyDrive<SetSpeed> {
 public:
  static constexpr std::string_view type_name = "speed";
  static constexpr std::string_view type_meaning = "target of a rotor's drive to a speed";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetSpeed::body, SetSpeed>("body", "", {}, required, body_meaning),
        field<&SetSpeed::value, SetSpeed>("value", "rad/s", any_number(), required, "speed"),
        field<&SetSpeed::over, SetSpeed>("over", "s", at_least(0.0), optional, over_meaning),
    };
    return table;
  }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return give(world, names, target(), &LiveWorld::set_speed);
  }
};

class SetAngle final : public SetBodyDrive<SetAngle> {
 public:
  std::optional<double> rate;

  static constexpr std::string_view type_name = "angle";
  static constexpr std::string_view type_meaning = "target of a rotor's drive to an angle";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetAngle::body, SetAngle>("body", "", {}, required, body_meaning),
        field<&SetAngle::value, SetAngle>("value", "rad", any_number(), required,
                                          "angle turned since time 0"),
        field<&SetAngle::over, SetAngle>("over", "s", above(0.0), optional, over_meaning),
        field<&SetAngle::rate>(
            "rate", "rad/s", any_number(), optional,
            "speed at which it arrives and continues; default: it goes steadily, and "
            "stops there"),
    };
    return table;
  }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    DriveTarget wanted = target();
    wanted.rate = rate;
    return give(world, names, wanted, &LiveWorld::set_angle);
  }
};

class SetTorque final : public SetBodyDrive<SetTorque> {
 public:
  static constexpr std::string_view type_name = "torque";
  static constexpr std::string_view type_meaning = "torque of a rotor's drive";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetTorque::body, SetTorque>("body", "", {}, required, body_meaning),
        field<&SetTorque::value, SetTorque>("value", "N m", any_number(), required, "torque"),
        field<&SetTorque::over, SetTorque>("over", "s", at_least(0.0), optional,
                                           "time to reach it; default: at once"),
    };
    return table;
  }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return give(world, names, target(), &LiveWorld::set_torque);
  }
};

class ClearDrive final : public Control {
 public:
  std::string body;

  static constexpr std::string_view type_name = "drive";
  static constexpr std::string_view type_meaning = "a rotor's drive, of any kind";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearDrive::body>("body", "", {}, required, "name of the rotor"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    return handle ? at_pointer(world.clear_drive(*handle), "") : handle.errors();
  }
};

}  // namespace

TypeEntry<Control> set_speed() { return control_entry<SetSpeed>(); }
TypeEntry<Control> set_angle() { return control_entry<SetAngle>(); }
TypeEntry<Control> set_torque() { return control_entry<SetTorque>(); }
TypeEntry<Control> clear_drive() { return control_entry<ClearDrive>(); }

}  // namespace sheave::live
