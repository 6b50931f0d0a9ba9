#pragma once
// The most worn sections of the ropes of a run, by formulas of the user.

#include <optional>
#include <string>
#include <vector>

#include "cable/step_warnings.h"
#include "measure/rope_history.h"

namespace sheave::command {

/// The section of one cable with the largest damage.
struct RopeWear {
  std::string cable;
  double from = 0.0;  ///< unstretched position, from the cable's first end [m]
  double to = 0.0;    ///< [m]
  int simple_bends = 0;
  int reverse_bends = 0;
  double damage = 0.0;  ///< share of the life; NaN: a formula has no value
  /// How often the run can be repeated, 1 / damage; infinite without damage.
  double repetitions = 0.0;
};

/// One entry for each cable with sections. Of equally worn sections the first one; a damage
/// without a value is the largest.
[[nodiscard]] std::vector<RopeWear> most_worn(const std::vector<measure::CableHistory>& cables);

/// Warnings about cables whose life the run does not tell.
[[nodiscard]] std::vector<Warning> wear_warnings(const std::vector<measure::CableHistory>& cables);

/// A table for people.
[[nodiscard]] std::string wear_text(const std::vector<RopeWear>& ropes);

}  // namespace sheave::command
