#include "command/sweep/chart_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "engine/number_text.h"

namespace sheave::command {
namespace {

double number_in(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

bool is_finite_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(value);
}

/// The distinct values: numbers in ascending order, words in the order of the rows.
std::vector<std::string> distinct(std::vector<std::string> values, bool numeric) {
  const auto before = [&](const std::string& x, const std::string& y) {
    return numeric && number_in(x) < number_in(y);
  };
  std::stable_sort(values.begin(), values.end(), before);
  std::vector<std::string> different;
  for (std::string& value : values) {
    const bool known = numeric ? !different.empty() && different.back() == value
                               : std::count(different.begin(), different.end(), value) > 0;
    if (!known) different.push_back(std::move(value));
  }
  return different;
}

}  // namespace

std::string axis_number(double value) {
  const double size = std::abs(value);
  return size >= 1e4 && size < 1e7 ? fixed_number_text(value, 0) : fmt::format("{:.4g}", value);
}

ChartAxis::ChartAxis(const SweepTable& table, std::size_t axis) : label(table.head.axes[axis]) {
  for (const SweepRow& row : table.rows) values.push_back(row.values[axis]);
  numeric = std::all_of(values.begin(), values.end(), is_finite_number);
  values = distinct(std::move(values), numeric);
  const std::vector<std::string>& units = table.head.axis_units;
  const std::string unit = axis < units.size() ? units[axis] : "";
  if (numeric && !values.empty()) {
    const double most =
        std::max(std::abs(number_in(values.front())), std::abs(number_in(values.back())));
    scale = unit_scale(most, unit);
  }
  if (!unit.empty()) label += fmt::format(" [{}{}]", scale.prefix, unit);
  for (const SweepRow& row : table.rows) {
    const std::string& value = row.values[axis];
    places.push_back(numeric ? number_in(value) / scale.factor
                             : static_cast<double>(index_of(value)));
  }
  if (!numeric || values.size() <= 2) return;
  const double low = number_in(values.front());
  const double high = number_in(values.back());
  const double middle = number_in(values[values.size() / 2]);
  // Uses a logarithmic axis if the values are evenly spaced in the logarithm over more than 1.5
  // decades.
  logarithmic = low > 0.0 && high > 30.0 * low && middle < 0.25 * (low + high);
}

std::size_t ChartAxis::index_of(const std::string& value) const {
  return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) - values.begin());
}

std::string ChartAxis::shown(const std::string& value) const {
  return numeric ? axis_number(number_in(value) / scale.factor) : value;
}

GnuplotCode ChartAxis::tics(std::size_t most, GnuplotScript& script) const {
  GnuplotCode list;
  for (std::size_t i = 0; i < values.size(); i += 1 + values.size() / most) {
    if (i > 0) list.add({", "});
    list.add({script.tic(shown(values[i]), static_cast<double>(i))});
  }
  return {"(", list, ")"};
}

double ChartAxis::end() const {
  return static_cast<double>(std::max<std::size_t>(values.size(), 1)) - 0.5;
}

ShownMeasure::ShownMeasure(const SweepTable& table, std::size_t measure) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const SweepRow& row : table.rows) {
    if (!std::isfinite(row.measured[measure])) continue;
    least = std::min(least, row.measured[measure]);
    most = std::max(most, row.measured[measure]);
  }
  const SweepMeasure& shown = table.head.measures[measure];
  if (least <= most) {
    scale = unit_scale(std::max(std::abs(least), std::abs(most)), shown.unit);
    low = least / scale.factor;
    high = most / scale.factor;
  }
  label = shown.name;
  if (!shown.unit.empty()) label += fmt::format(" [{}{}]", scale.prefix, shown.unit);
}

std::string ShownMeasure::cell(double scaled) const {
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(size > 0.0)) return "0";
  const double before_point = std::floor(std::log10(size)) + 1.0;
  const double apart = high > low ? std::ceil(std::log10(size / (high - low))) + 2.0 : 0.0;
  const double digits = std::max({3.0, before_point <= 6.0 ? before_point : 0.0, apart});
  return fmt::format("{:.{}g}", scaled == 0.0 ? 0.0 : scaled,
                     static_cast<int>(std::min(digits, 9.0)));
}

}  // namespace sheave::command
