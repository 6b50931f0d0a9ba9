// The drives along the coordinates of joints.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

/// Names a coordinate.
class JointControl : public Control {
 public:
  std::string joint;
  std::string coordinate;

 protected:
  template <class Set>
  [[nodiscard]] Errors with_coordinate(const Names& names, const Set& set) const {
    const Result<JointHandle> handle = names.joint(joint);
    if (!handle) return handle.errors();
    const Result<int> index = names.coordinate(*handle, coordinate);
    return index ? at_pointer(set(*handle, *index), "") : index.errors();
  }
  static constexpr std::string_view joint_meaning = "name of the joint";
  static constexpr std::string_view coordinate_meaning =
      "which one, by its name (`angle`, `travel`, ...), where the joint has several; default: the "
      "first";
};

class SetJointDrive final : public JointControl {
 public:
  double value = 0.0;
  std::optional<double> over;
  std::optional<double> rate;

  static constexpr std::string_view type_name = "joint_drive";
  static constexpr std::string_view type_meaning =
      "target of the drive along a coordinate of a joint, in the unit of its kind";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetJointDrive::joint, SetJointDrive>("joint", "", {}, required, joint_meaning),
        field<&SetJointDrive::coordinate, SetJointDrive>("coordinate", "", {}, optional,
                                                         coordinate_meaning),
        field<&SetJointDrive::value>("value", "m, m/s, N, rad, rad/s or N m", any_number(),
                                     required, "position, speed or force"),
        field<&SetJointDrive::over>("over", "s", at_least(0.0), optional,
                                    "time to reach it, > 0 for a position; "
                                    "default: a step, of a force: at once"),
        field<&SetJointDrive::rate>("rate", "m/s or rad/s", any_number(), optional,
                                    "of a position: speed at which it arrives and continues; "
                                    "default: it goes steadily, and stops there"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    DriveTarget wanted(value);
    wanted.over = over;
    wanted.rate = rate;
    return with_coordinate(names, [&](JointHandle handle, int index) {
      return world.set_drive(handle, wanted, index);
    });
  }
};

class SetJointDriveLimit final : public JointControl {
 public:
  double value = 0.0;

  static constexpr std::string_view type_name = "joint_drive_limit";
  static constexpr std::string_view type_meaning =
      "limit of the force or torque of the drive along a coordinate of a joint";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetJointDriveLimit::joint, SetJointDriveLimit>("joint", "", {}, required,
                                                              joint_meaning),
        field<&SetJointDriveLimit::coordinate, SetJointDriveLimit>("coordinate", "", {}, optional,
                                                                   coordinate_meaning),
        field<&SetJointDriveLimit::value>("value", "N or N m", above(0.0), required, "the limit"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return with_coordinate(names, [&](JointHandle handle, int index) {
      return world.set_drive_limit(handle, value, index);
    });
  }
};

class ClearJointDrive final : public JointControl {
 public:
  static constexpr std::string_view type_name = "joint_drive";
  static constexpr std::string_view type_meaning =
      "target and limit of the drive along a coordinate of a joint";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearJointDrive::joint, ClearJointDrive>("joint", "", {}, required, joint_meaning),
        field<&ClearJointDrive::coordinate, ClearJointDrive>("coordinate", "", {}, optional,
                                                             coordinate_meaning),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return with_coordinate(
        names, [&](JointHandle handle, int index) { return world.clear_drive(handle, index); });
  }
};

}  // namespace

TypeEntry<Control> set_joint_drive() { return control_entry<SetJointDrive>(); }
TypeEntry<Control> set_joint_drive_limit() { return control_entry<SetJointDriveLimit>(); }
TypeEntry<Control> clear_joint_drive() { return control_entry<ClearJointDrive>(); }

}  // namespace sheave::live
