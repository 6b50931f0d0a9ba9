#pragma once
// Springs, stops, friction and drives along a free coordinate of a joint: the angle of a hinge, the
// travel of a slider.
//
// A joint type has a member of type JointCoordinate per free coordinate and adds
// coordinate_fields() to its table.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/field.h"
#include "engine/result.h"
#include "engine/time_signal.h"

namespace sheave {

/// The quantity that the drive of a coordinate prescribes.
enum class CoordinateDrive { none, position, speed, force };
inline constexpr std::array<std::string_view, 4> translation_drive_names{"none", "position",
                                                                         "speed", "force"};
inline constexpr std::array<std::string_view, 4> rotation_drive_names{"none", "angle", "speed",
                                                                      "torque"};
enum class CoordinateKind { translation, rotation };

/// Settings of one coordinate. "Force" is a torque and "m" is rad if the coordinate is an angle.
/// All settings may act together.
struct JointCoordinate {
  std::optional<double> lower;    ///< stop: the coordinate stays at or above this value [m]
  std::optional<double> upper;    ///< stop: the coordinate stays at or below this value [m]
  double limit_compliance = 0.0;  ///< of both stops [m/N], >= 0
  double stiffness = 0.0;         ///< of a spring towards `rest` [N/m], >= 0
  double rest = 0.0;              ///< coordinate at which the spring is relaxed [m]
  double damping = 0.0;           ///< force per speed against the motion [N s/m], >= 0
  /// Dry friction, the largest force at which the coordinate sticks [N], >= 0
  double friction = 0.0;
  CoordinateDrive drive = CoordinateDrive::none;
  std::vector<double> drive_times;   ///< [s], increasing; as many as values, or none
  std::vector<double> drive_values;  ///< [m, m/s or N]
  Interpolation drive_interpolation = Interpolation::linear;  ///< between the values
  double drive_amplitude = 0.0;       ///< amplitude of a sine added to the values [m, m/s or N]
  double drive_frequency = 0.0;       ///< frequency of the sine [Hz], >= 0
  double drive_phase = 0.0;           ///< phase of the sine at time 0 [rad]
  std::optional<double> drive_limit;  ///< largest force of the drive [N], >= 0
  double drive_compliance = 0.0;      ///< position drives: deflection per force [m/N], >= 0

  [[nodiscard]] TimeSignal signal() const {
    return {TimeTable::of(drive_times, drive_values, drive_interpolation), drive_amplitude,
            drive_frequency, drive_phase};
  }
  /// Whether any force can act along the coordinate.
  [[nodiscard]] bool acts() const;
};

/// Appends the errors beyond the ranges of the fields. `path` is that of the joint, `prefix` begins
/// the fields' names, `joint` is the joint's name.
void check_coordinate(const JointCoordinate& coordinate, const std::string& joint,
                      const std::string& path, const std::string& prefix, Errors& errors);

namespace detail {

struct CoordinateUnits {
  std::string_view value, compliance, stiffness, damping, force, drive;
};
inline constexpr CoordinateUnits translation_units{"m", "m/N", "N/m", "N s/m", "N", "m, m/s or N"};
inline constexpr CoordinateUnits rotation_units{"rad",       "rad/(N m)", "N m/rad",
                                                "N m s/rad", "N m",       "rad, rad/s or N m"};

template <class Class, JointCoordinate Class::*Coordinate>
struct CoordinateSlots {
  template <auto Member>
  static FieldSlot of(void* object) {
    return &((static_cast<Class*>(object)->*Coordinate).*Member);
  }
  template <auto Member>
  static FieldSlot choice(void* object) {
    using Enumeration = decltype(detail::member_of(Member));
    return ChoiceSlot{&(static_cast<Class*>(object)->*Coordinate),
                      [](const void* o) {
                        return static_cast<int>(static_cast<const JointCoordinate*>(o)->*Member);
                      },
                      [](void* o, int index) {
                        static_cast<JointCoordinate*>(o)->*Member = static_cast<Enumeration>(index);
                      }};
  }
};

/// Names of a coordinate's fields.
[[nodiscard]] inline std::array<std::string, 16> coordinate_names(const std::string& prefix) {
  std::array<std::string, 16> names{
      "lower",       "upper",        "limit_compliance", "stiffness",
      "rest",        "damping",      "friction",         "drive",
      "drive_times", "drive_values", "drive_amplitude",  "drive_frequency",
      "drive_phase", "drive_limit",  "drive_compliance", "drive_interpolation"};
  for (std::string& text : names) text.insert(0, prefix);
  return names;
}

}  // namespace detail

/// The fields of the coordinate `Coordinate` of the joint type `Class`. Their names begin with
/// `prefix`, which must be the same in all calls for one coordinate. `what` names the coordinate in
/// the documentation, e.g. "the angle".
template <class Class, JointCoordinate Class::*Coordinate>
[[nodiscard]] std::vector<Field> coordinate_fields(CoordinateKind kind, const std::string& prefix,
                                                   const std::string& what) {
  using C = JointCoordinate;
  // Fields hold views of their texts, so the texts must live as long as the program.
  static const std::array<std::string, 16> name = detail::coordinate_names(prefix);
  static const std::array<std::string, 3> meaning{
      "stops " + what + " from below (default: no stop)",
      "stops " + what + " from above (default: no stop)", "of a spring along " + what};
  const bool turns = kind == CoordinateKind::rotation;
  const detail::CoordinateUnits unit = turns ? detail::rotation_units : detail::translation_units;
  const std::span<const std::string_view> drives =
      turns ? std::span(rotation_drive_names) : std::span(translation_drive_names);
  const auto row = [](const std::string& key, std::string_view of, Range range,
                      std::string_view text, FieldSlot (*slot)(void*)) {
    return Field{key, of, range, optional, text, {}, slot};
  };
  using Slots = detail::CoordinateSlots<Class, Coordinate>;
  return {
      row(name[0], unit.value, any_number(), meaning[0], &Slots::template of<&C::lower>),
      row(name[1], unit.value, any_number(), meaning[1], &Slots::template of<&C::upper>),
      row(name[2], unit.compliance, at_least(0.0), "of the stops; 0 (default) is rigid",
          &Slots::template of<&C::limit_compliance>),
      row(name[3], unit.stiffness, at_least(0.0), meaning[2], &Slots::template of<&C::stiffness>),
      row(name[4], unit.value, any_number(), "coordinate at which the spring is relaxed",
          &Slots::template of<&C::rest>),
      row(name[5], unit.damping, at_least(0.0), "viscous friction",
          &Slots::template of<&C::damping>),
      row(name[6], unit.force, at_least(0.0), "dry friction, of bearings or guides",
          &Slots::template of<&C::friction>),
      Field{name[7],
            "",
            {},
            optional,
            "quantity that the drive's values prescribe",
            drives,
            &Slots::template choice<&C::drive>},
      row(name[8], "s", any_number(), "increasing times of the values; none for a constant",
          &Slots::template of<&C::drive_times>),
      row(name[9], unit.drive, any_number(), "values of the drive, one per time",
          &Slots::template of<&C::drive_values>),
      Field{name[15],
            "",
            {},
            optional,
            interpolation_meaning,
            interpolation_names,
            &Slots::template choice<&C::drive_interpolation>},
      row(name[10], unit.drive, any_number(), "amplitude of a sine added to the values",
          &Slots::template of<&C::drive_amplitude>),
      row(name[11], "Hz", at_least(0.0), "of the sine", &Slots::template of<&C::drive_frequency>),
      row(name[12], "rad", any_number(), "of the sine at time 0",
          &Slots::template of<&C::drive_phase>),
      row(name[13], unit.force, at_least(0.0),
          "largest force or torque of the drive (default: no limit); 0 is an open brake",
          &Slots::template of<&C::drive_limit>),
      row(name[14], unit.compliance, at_least(0.0),
          "deflection per force of a drive to a position; 0 (default) is rigid",
          &Slots::template of<&C::drive_compliance>),
  };
}

/// All rows of `tables`, one after the other.
[[nodiscard]] std::vector<Field> joined(std::initializer_list<std::vector<Field>> tables);

}  // namespace sheave
