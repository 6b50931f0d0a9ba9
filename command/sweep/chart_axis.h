#pragma once
// The axes and the numbers of charts of sweeps.

#include <cstddef>
#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "command/sweep/table.h"
#include "scenes/unit_scale.h"

namespace sheave::command {

/// One varied quantity as an axis: numbers at their values, words at equal distances.
struct ChartAxis {
  std::string label;  ///< "/bodies/load/mass [kg]"
  UnitScale scale;    ///< of numbers: one prefix of the unit for all
  bool numeric = true;
  bool logarithmic = false;
  std::vector<std::string> values;  ///< the distinct values, in order
  std::vector<double> places;       ///< of each row; numbers are scaled

  ChartAxis(const SweepTable& table, std::size_t axis);

  /// Index of a value in `values`.
  [[nodiscard]] std::size_t index_of(const std::string& value) const;
  /// A value as tables and maps show it: scaled where it is a number.
  [[nodiscard]] std::string shown(const std::string& value) const;
  /// At most `most` names, evenly distributed.
  [[nodiscard]] GnuplotCode tics(std::size_t most, GnuplotScript& script) const;
  /// The end of an axis of words or cells. An axis without values has a positive length, too.
  [[nodiscard]] double end() const;
};

/// The values of a measure as a chart shows them: with one prefix of the unit for all.
struct ShownMeasure {
  UnitScale scale;
  double low = 0.0;   ///< smallest value, scaled; 0 without values
  double high = 0.0;  ///< greatest value, scaled; 0 without values
  std::string label;  ///< "max:rope.tension [kN]"

  ShownMeasure(const SweepTable& table, std::size_t measure);

  /// Three significant digits; more where the values differ less, and for numbers that have no
  /// prefix.
  [[nodiscard]] std::string cell(double scaled) const;
};

/// A number at an axis: 15000 rather than 1.5e+04.
[[nodiscard]] std::string axis_number(double value);

}  // namespace sheave::command
