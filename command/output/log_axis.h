#pragma once
// A logarithmic axis of a chart, with whole decades round everything that is drawn.

#include <limits>
#include <string>

#include "command/output/gnuplot_script.h"

namespace sheave::command {

/// "10⁻⁵".
[[nodiscard]] std::string power_of_ten(int exponent);

class LogAxis {
 public:
  /// A third of a decade beside a value stays free, so that no point lies on the frame. A
  /// logarithmic axis has no zero: what is not above it, or not finite, is left out.
  void add(double value);
  [[nodiscard]] bool empty() const { return !(lowest_ <= highest_); }
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  /// Sets range and tics of an axis: 'x' or 'y', which must not be empty.
  void set(char axis, GnuplotScript& script) const;

 private:
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = 0.0;
};

}  // namespace sheave::command
