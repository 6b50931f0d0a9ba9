#pragma once
// What a drive follows: a table of points and a sine on top of it.

#include "engine/time_table.h"

namespace sheave {

/// table(t) + amplitude sin(2 pi frequency t + phase).
struct TimeSignal {
  TimeTable table;
  double amplitude = 0.0;
  double frequency = 0.0;  ///< [Hz], >= 0
  double phase = 0.0;      ///< [rad]

  [[nodiscard]] double at(double time) const;
  /// Its derivative [per s]; at a corner of the table that of the piece which ends there.
  [[nodiscard]] double rate(double time) const;
  /// Integral from `from` to `to` [s], from <= to; exact.
  [[nodiscard]] double integral(double from, double to) const;
};

}  // namespace sheave
