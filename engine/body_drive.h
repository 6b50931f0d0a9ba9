#pragma once
// The target of a body's drive: the control if one is set, else the drive's table.

#include "engine/body_set.h"
#include "engine/controls.h"

namespace sheave {

class BodyDrive {
 public:
  /// The drive of body `index`, which must have one. `body` and `controls` must outlive this
  /// object.
  BodyDrive(const BodyProperties& body, const Controls& controls, int index)
      : body_(body), set_(controls.body_drives.find(index)) {}

  /// The target at `time` [rad/s, rad or N m].
  [[nodiscard]] double at(double time) const {
    return set_ != nullptr ? set_->target.at(time) : body_.drive_table.at(time);
  }
  [[nodiscard]] double rate(double time) const {
    return set_ != nullptr ? set_->target.rate(time) : body_.drive_table.rate(time);
  }
  [[nodiscard]] double integral(double from, double to) const {
    return set_ != nullptr ? set_->target.integral(from, to) : body_.drive_table.integral(from, to);
  }
  /// The turn that the drive prescribes between two times [rad]; only for speed and angle drives.
  [[nodiscard]] double turn(double from, double to) const {
    return body_.driven_by() == DriveKind::speed ? integral(from, to) : at(to) - at(from);
  }
  /// The spin that the drive prescribes at the end `to` of a substep of `h` seconds [rad/s]. For a
  /// table of angles it is the mean over the substep unless `at_end`.
  [[nodiscard]] double speed(double from, double to, double h, bool at_end) const {
    if (body_.driven_by() == DriveKind::speed) return at(to);
    return set_ != nullptr || at_end ? rate(to) : (at(to) - at(from)) / h;
  }

 private:
  const BodyProperties& body_;
  const DriveControl* set_;
};

}  // namespace sheave
