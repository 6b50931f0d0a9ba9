#pragma once
// Rows that act along a free coordinate c of a joint, all with its gradient
// (engine/joints/coordinate.h).
//
//   lower stop       C = c - lower >= 0           multiplier in [0, inf)
//   upper stop       C = c - upper <= 0           multiplier in (-inf, 0]
//   spring           C = c - rest                 compliance 1 / stiffness, with the damping
//   damper           C = c - c0                   a row without memory: force = -damping dc/dt
//   dry friction     C = c - c0                   |force| <= friction: it holds what it can. Where several directions share one
//                                                 friction, that is the norm of a vector (engine/friction_rows.h)
//   drive, position  C = c - p(t)                 |force| <= limit
//   drive, speed     C = c - c0 - integral of v   |force| <= limit
//   drive, force     the multiplier has equal bounds: the mean of F over the substep
//   coupling         C = c                        of two coordinates: c = factor c1 + second factor c2
//
// c0 is the coordinate at the start of the substep. A drive that reaches its limit lags behind and
// stalls.

#include <string>
#include <vector>

#include "engine/controls.h"
#include "engine/joints/coordinate.h"
#include "engine/row.h"
#include "engine/substep.h"

namespace sheave {

struct JointCoordinateInfo;

struct JointEffect {
  enum class Kind { lower, upper, spring, damper, friction, position, speed, force, coupling };
  Kind kind = Kind::lower;
  int coordinate = 0;  ///< of the joint
  int second = -1;     ///< another coordinate, if c is a sum of two
  double factor = 1.0;
  double second_factor = 0.0;
  double at = 0.0;                ///< stop or rest [m or rad]
  double compliance = 0.0;        ///< [m/N or rad/(N m)]
  double damping = 0.0;           ///< [N s/m or N m s/rad]
  double limit = Row::unbounded;  ///< of the force [N or N m]
  int shares = 0;                 ///< of friction: Row::shares
  bool shared = false;            ///< of friction: it is one of those
  TimeSignal signal;              ///< of drives
  int control =
      -1;  ///< of a drive: where what has been set for it is to be found (Controls::joint_drives)

  [[nodiscard]] bool is_drive() const {
    return kind == Kind::position || kind == Kind::speed || kind == Kind::force;
  }
  /// Whether it holds the coordinate, from one side or both, whatever acts on it.
  [[nodiscard]] bool holds() const {
    return kind == Kind::lower || kind == Kind::upper || kind == Kind::coupling;
  }
  /// Whether it stores energy when it is deflected.
  [[nodiscard]] bool elastic() const {
    return compliance > 0.0 && kind != Kind::damper && kind != Kind::friction;
  }
};

/// What a drive asks for: what has been set, or else what it is defined with.
class DriveDemand {
 public:
  DriveDemand(const JointEffect& drive, const Controls& controls)
      : drive_(drive),
        set_(drive.control < 0 ? nullptr : controls.joint_drives.find(drive.control)) {}

  [[nodiscard]] double at(double time) const {
    return has_target() ? set_->target.at(time) : drive_.signal.at(time);
  }
  [[nodiscard]] double rate(double time) const {
    return has_target() ? set_->target.rate(time) : drive_.signal.rate(time);
  }
  [[nodiscard]] double integral(double from, double to) const {
    return has_target() ? set_->target.integral(from, to) : drive_.signal.integral(from, to);
  }
  /// The largest force it has [N or N m].
  [[nodiscard]] double limit() const {
    return set_ != nullptr && !std::isnan(set_->limit) ? set_->limit : drive_.limit;
  }

 private:
  [[nodiscard]] bool has_target() const { return set_ != nullptr && set_->has_target; }

  const JointEffect& drive_;
  const DriveControl* set_;
};

/// Appends what `settings` ask for along the coordinate of this number.
void append_effects(const JointCoordinate& settings, int coordinate,
                    std::vector<JointEffect>& effects);

/// Appends damping and dry friction against any motion along `count` coordinates, 2 or 3, from
/// `first` on, of directions that are perpendicular to each other: both depend on how fast it is,
/// not on where it goes.
void append_resistance(double damping, double friction, int first, int count,
                       std::vector<JointEffect>& effects);

/// By how much a coordinate with this value and rate is off what the drive asks for at `time`,
/// while it has this force; 0 if it asks for nothing (JointCoordinateReport::drive_error).
[[nodiscard]] double drive_error(const JointEffect& drive, const DriveDemand& demand, double time,
                                 double force, double value, double rate);

/// Why a joint cannot be locked with `row` of this effect as it is: a rigid stop that is passed, or
/// a drive without limits that asks for another position, would be there with a blow. Empty if
/// nothing. `scale` is the size of the scene [m].
[[nodiscard]] std::string hold_fault(const JointEffect& effect, const JointCoordinateInfo& info,
                                     const Row& row, double scale);

/// Completes `row`, which has the gradient of c, whose value is `now` and was `start` at the start.
void set_effect(const JointEffect& effect, const Substep& substep, double now, double start,
                Row& row);

}  // namespace sheave
