#pragma once
// The target of a joint's drive as a function of time: a table of points plus a sine.

#include "engine/time_table.h"

namespace sheave {

/// table(t) + amplitude sin(2 pi frequency t + phase).
struct TimeSignal {
  TimeTable table;
  double amplitude = 0.0;
  double frequency = 0.0;  ///< [Hz], >= 0
  double phase = 0.0;      ///< [rad]

  [[nodiscard]] double at(double time) const;
  /// The derivative [per s]; at a corner of the table the one of the piece that ends there.
  [[nodiscard]] double rate(double time) const;
  /// Integral from `from` to `to` [s], from <= to; exact.
  [[nodiscard]] double integral(double from, double to) const;
};

}  // namespace sheave
