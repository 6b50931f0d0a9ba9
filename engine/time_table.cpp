#include "engine/time_table.h"

#include <algorithm>

namespace sheave {

double TimeTable::at(double time) const {
  if (values.empty()) return 0.0;
  if (times.empty() || time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

double TimeTable::rate(double time) const {
  if (times.empty() || time <= times.front() || time > times.back()) return 0.0;
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  const auto i = static_cast<std::size_t>(after - times.begin());
  return (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
}

double TimeTable::integral(double from, double to) const {
  // Trapezia between the corners are exact for a function that is linear there.
  double sum = 0.0;
  double left = from;
  for (const double corner : times) {
    if (corner <= from || corner >= to) continue;
    sum += 0.5 * (at(left) + at(corner)) * (corner - left);
    left = corner;
  }
  return sum + 0.5 * (at(left) + at(to)) * (to - left);
}

}  // namespace sheave
