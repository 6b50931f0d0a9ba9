#include "scenes/statistic.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sheave {
namespace {

using Numbers = std::array<double, Course::size>;
static_assert(sizeof(Course) == sizeof(Numbers));

}  // namespace

std::optional<Statistic> statistic_over_time(std::string_view name) {
  if (name == "min") return Statistic::minimum;
  if (name == "max") return Statistic::maximum;
  for (std::size_t i = 1; i < statistic_names.size(); ++i) {
    if (name == statistic_names[i]) return static_cast<Statistic>(i);
  }
  return {};
}

void Course::add(double time, double value) {
  if (begin < 0.0) begin = time;
  if (!std::isfinite(value)) {
    finite = 0.0;
    count += 1.0;
    return;
  }
  if (count == 0.0) {
    area += (time - begin) * value;
    first = minimum = maximum = value;
    first_time = time;
  } else if (time > last_time) {
    area += 0.5 * (time - last_time) * (last + value);
  }
  if (count == 0.0 || time > last_time) {
    count += 1.0;
    sum += value;
  }
  last = value;
  last_time = time;
  minimum = std::min(minimum, value);
  maximum = std::max(maximum, value);
}

double Course::value(Statistic statistic) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (count == 0.0 || finite == 0.0) return nan;
  switch (statistic) {
    case Statistic::mean:
      return sum / count;
    case Statistic::rate:
      return last_time > first_time ? (last - first) / (last_time - first_time) : nan;
    case Statistic::minimum:
      return minimum;
    case Statistic::maximum:
      return maximum;
    case Statistic::range:
      return maximum - minimum;
    case Statistic::drift:
      return last - first;
    case Statistic::integral:
      return area;
    case Statistic::at:
      break;
  }
  return nan;
}

Course Course::from(std::span<const double, size> numbers) {
  Numbers copy{};
  std::copy(numbers.begin(), numbers.end(), copy.begin());
  return std::bit_cast<Course>(copy);
}

void Course::store(std::span<double, size> numbers) const {
  const auto own = std::bit_cast<Numbers>(*this);
  std::copy(own.begin(), own.end(), numbers.begin());
}

}  // namespace sheave
