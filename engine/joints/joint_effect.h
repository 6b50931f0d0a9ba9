#pragma once
// Rows that act along a free coordinate c of a joint. All have the gradient of c
// (engine/joints/coordinate.h).
//
//   lower stop       C = c - lower >= 0           multiplier in [0, inf)
//   upper stop       C = c - upper <= 0           multiplier in (-inf, 0]
//   spring           C = c - rest                 compliance 1 / stiffness, with the damping
//   damper           C = c - c0                   a row without memory: force = -damping dc/dt
//   dry friction     C = c - c0                   |force| <= friction
//   drive, position  C = c - p(t)                 |force| <= limit
//   drive, speed     C = c - c0 - integral of v   |force| <= limit
//   drive, force     the multiplier has equal bounds: the mean of F over the substep
//   coupling         C = c                        c = factor c1 + second factor c2
//
// c0 is the coordinate at the start of the substep. Where several directions share one friction,
// its bound limits the norm of a vector (engine/friction_rows.h). A drive that reaches its limit
// lags behind its target and stalls.

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
  int coordinate = 0;  ///< index of the coordinate in the joint
  int second = -1;     ///< index of another coordinate, if c is a sum of two; else -1
  double factor = 1.0;
  double second_factor = 0.0;
  double at = 0.0;                ///< coordinate of a stop or of a spring at rest [m or rad]
  double compliance = 0.0;        ///< [m/N or rad/(N m)]
  double damping = 0.0;           ///< [N s/m or N m s/rad]
  double limit = Row::unbounded;  ///< largest force [N or N m]
  int shares = 0;                 ///< friction: Row::shares
  bool shared = false;            ///< friction: one of several rows that share a bound
  TimeSignal signal;              ///< target of a drive
  int control = -1;  ///< index of a drive's control in Controls::joint_drives; -1: none

  [[nodiscard]] bool is_drive() const {
    return kind == Kind::position || kind == Kind::speed || kind == Kind::force;
  }
  /// Whether this is a constraint on the coordinate, unilateral or bilateral.
  [[nodiscard]] bool holds() const {
    return kind == Kind::lower || kind == Kind::upper || kind == Kind::coupling;
  }
  /// Whether a deflection stores energy.
  [[nodiscard]] bool elastic() const {
    return compliance > 0.0 && kind != Kind::damper && kind != Kind::friction;
  }
};

/// The target of a drive: its control if one is set, else its definition.
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
  /// The largest force [N or N m].
  [[nodiscard]] double limit() const {
    return set_ != nullptr && !std::isnan(set_->limit) ? set_->limit : drive_.limit;
  }

 private:
  [[nodiscard]] bool has_target() const { return set_ != nullptr && set_->has_target; }

  const JointEffect& drive_;
  const DriveControl* set_;
};

/// Appends the effects of `settings` along the coordinate with this index.
void append_effects(const JointCoordinate& settings, int coordinate,
                    std::vector<JointEffect>& effects);

/// Appends damping and dry friction along `count` coordinates, 2 or 3, from `first` on, whose
/// directions are perpendicular to each other. Both depend on the speed, not on the direction of
/// the motion.
void append_resistance(double damping, double friction, int first, int count,
                       std::vector<JointEffect>& effects);

/// Deviation from the drive's target at `time`, for a coordinate with this value and rate and a
/// drive with this force; 0 if there is no target (JointCoordinateReport::drive_error).
[[nodiscard]] double drive_error(const JointEffect& drive, const DriveDemand& demand, double time,
                                 double force, double value, double rate);

/// The reason why a joint with `row` of this effect cannot be locked; empty if it can. A rigid stop
/// that is overrun, or a drive without a limit that is off its position, would move the bodies
/// suddenly. `scale` is the size of the scene [m].
[[nodiscard]] std::string hold_fault(const JointEffect& effect, const JointCoordinateInfo& info,
                                     const Row& row, double scale);

/// Completes `row`, which has the gradient of c. The value of c is `now`, and was `start` at the
/// start of the substep.
void set_effect(const JointEffect& effect, const Substep& substep, double now, double start,
                Row& row);

}  // namespace sheave
