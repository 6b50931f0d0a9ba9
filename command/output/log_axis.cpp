#include "command/output/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace sheave::command {

std::string power_of_ten(int exponent) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char c : fmt::format("{}", exponent)) {
    text += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

void LogAxis::add(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return;
  lowest_ = std::min(lowest_, 0.5 * value);
  highest_ = std::max(highest_, 2.0 * value);
}

double LogAxis::lower() const { return std::pow(10.0, std::floor(std::log10(lowest_))); }

double LogAxis::upper() const {
  return std::max(std::pow(10.0, std::ceil(std::log10(highest_))), 10.0 * lower());
}

void LogAxis::set(char axis, GnuplotScript& script) const {
  constexpr int most_named = 10;  // decades
  const GnuplotPiece name = axis == 'x' ? GnuplotPiece("x") : GnuplotPiece("y");
  const int first = static_cast<int>(std::lround(std::log10(lower())));
  const int last = static_cast<int>(std::lround(std::log10(upper())));
  GnuplotCode named;
  for (int i = first; i <= last; i += 1 + (last - first) / most_named) {
    if (!named.empty()) named.add({", "});
    named.add({script.tic(power_of_ten(i), std::pow(10.0, i))});
  }
  // The tics have explicit names: gnuplot's own notation of powers needs enhanced text, which would
  // interpret special characters in names.
  script.add({"set logscale ", name, "\nset ", name, "range [", lower(), ":", upper(),
              "]\nset format ", name, " ''\nset ", name, "tics add (", named, ")\n"});
}

}  // namespace sheave::command
