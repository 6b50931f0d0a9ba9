#pragma once
// A logarithmic axis of a chart whose range consists of whole decades around all values.

#include <limits>
#include <string>

#include "command/output/gnuplot_script.h"

namespace sheave::command {

/// "10⁻⁵".
[[nodiscard]] std::string power_of_ten(int exponent);

class LogAxis {
 public:
  /// Extends the range to a value. A third of a decade beside it stays free, so that no point lies
  /// on the frame. A value that is not positive or not finite is ignored: a logarithmic axis has no
  /// place for it.
  void add(double value);
  [[nodiscard]] bool empty() const { return !(lowest_ <= highest_); }
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  /// Sets range and tics of axis 'x' or 'y'. The axis must have a value.
  void set(char axis, GnuplotScript& script) const;

 private:
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = 0.0;
};

}  // namespace sheave::command
