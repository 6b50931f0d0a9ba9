#include "engine/field.h"

namespace sheave {

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  const bool above_minimum = minimum_allowed ? value >= minimum : value > minimum;
  const bool below_maximum = maximum_allowed ? value <= maximum : value < maximum;
  return above_minimum && below_maximum;
}

}  // namespace sheave
