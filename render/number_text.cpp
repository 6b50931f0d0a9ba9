#include "render/number_text.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace sheave::render {

std::string fixed_text(double value, int decimals) {
  std::string text = fixed_number_text(value, std::clamp(decimals, 0, 15));
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string quantity_text(double value, double reference, std::string_view unit) {
  const UnitScale scale = unit_scale(reference);
  const double size = std::abs(reference) / scale.factor;
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
  std::string text = fixed_text(value / scale.factor, decimals);
  text += ' ';
  text += scale.prefix;
  text += unit;
  return text;
}

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / power;
  // The tolerance keeps rounding errors from moving a value such as 0.2 to the step below.
  constexpr double slack = 1.0 - 1e-9;
  if (lead >= 10.0 * slack) return 10.0 * power;
  if (lead >= 5.0 * slack) return 5.0 * power;
  if (lead >= 2.0 * slack) return 2.0 * power;
  return power;
}

Ticks round_ticks(double low, double high, int count) {
  Ticks ticks;
  const double wanted = (high - low) / std::max(count, 1);
  double step = round_down(wanted);
  // A step rounded down may be up to 2.5 times too fine; the next of 1, 2, 5 may be nearer.
  if (wanted / step > 1.5) step = round_down(step * 2.5);
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double tolerance = 1e-6 * step;
  const auto first = static_cast<long long>(std::ceil((low - tolerance) / step));
  const auto last = static_cast<long long>(std::floor((high + tolerance) / step));
  for (long long k = first; k <= last && k < first + 100; ++k) {
    ticks.values.push_back(static_cast<double>(k) * step);
  }
  return ticks;
}

}  // namespace sheave::render
