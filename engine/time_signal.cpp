#include "engine/time_signal.h"

#include <cmath>

#include "engine/math/portable.h"
#include "engine/vector.h"

namespace sheave {

double TimeSignal::at(double time) const {
  return table.at(time) + amplitude * portable::sin(2.0 * pi * frequency * time + phase);
}

double TimeSignal::rate(double time) const {
  const double turns = 2.0 * pi * frequency;
  return table.rate(time) + amplitude * turns * portable::cos(turns * time + phase);
}

double TimeSignal::integral(double from, double to) const {
  // cos(a) - cos(b) as a product, which does not lose digits when a and b are close.
  const double turns = 2.0 * pi * frequency;
  const double half = 0.5 * turns * (to - from);
  const double sinc = half == 0.0 ? 1.0 : portable::sin(half) / half;
  const double middle = portable::sin(turns * 0.5 * (from + to) + phase);
  return table.integral(from, to) + amplitude * middle * sinc * (to - from);
}

}  // namespace sheave
