#pragma once
// What the drive of a body asks for: what has been set, or else what its table says.

#include "engine/body_set.h"
#include "engine/controls.h"

namespace sheave {

class BodyDrive {
 public:
  /// Of body `index`, which has a drive. Both must outlive this.
  BodyDrive(const BodyProperties& body, const Controls& controls, int index)
      : body_(body), set_(controls.body_drives.find(index)) {}

  /// Its value at `time` [rad/s, rad or N m].
  [[nodiscard]] double at(double time) const {
    return set_ != nullptr ? set_->target.at(time) : body_.drive_table.at(time);
  }
  [[nodiscard]] double rate(double time) const {
    return set_ != nullptr ? set_->target.rate(time) : body_.drive_table.rate(time);
  }
  [[nodiscard]] double integral(double from, double to) const {
    return set_ != nullptr ? set_->target.integral(from, to) : body_.drive_table.integral(from, to);
  }
  /// By how much it turns the body from one time to another [rad]; of drives to a speed or an
  /// angle.
  [[nodiscard]] double turn(double from, double to) const {
    return body_.driven_by() == DriveKind::speed ? integral(from, to) : at(to) - at(from);
  }
  /// The spin that it gives the body at the end of that time, `h` seconds [rad/s]. Of a table's
  /// angle it is the mean if not `at_end`.
  [[nodiscard]] double speed(double from, double to, double h, bool at_end) const {
    if (body_.driven_by() == DriveKind::speed) return at(to);
    return set_ != nullptr || at_end ? rate(to) : (at(to) - at(from)) / h;
  }

 private:
  const BodyProperties& body_;
  const DriveControl* set_;
};

}  // namespace sheave
