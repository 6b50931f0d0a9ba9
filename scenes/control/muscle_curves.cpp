#include "scenes/control/muscle_curves.h"

#include "engine/math/portable.h"

namespace sheave {

double MuscleCurves::by_length(double length) const {
  if (length < shortest || length > longest) return 0.0;
  const double low = 0.5 * (shortest + 1.0);
  const double high = 0.5 * (1.0 + longest);
  const auto half_square = [](double x) { return 0.5 * x * x; };
  if (length <= low) return half_square((length - shortest) / (low - shortest));
  if (length <= 1.0) return 1.0 - half_square((1.0 - length) / (1.0 - low));
  if (length <= high) return 1.0 - half_square((length - 1.0) / (high - 1.0));
  return half_square((longest - length) / (longest - high));
}

double MuscleCurves::by_velocity(double velocity) const {
  const double most = lengthening_force - 1.0;
  if (velocity <= -1.0) return 0.0;
  if (velocity <= 0.0) return (velocity + 1.0) * (velocity + 1.0);
  if (velocity >= most) return lengthening_force;
  return lengthening_force - (most - velocity) * (most - velocity) / most;
}

double MuscleCurves::passive(double length) const {
  if (length <= 1.0) return 0.0;
  const double high = 0.5 * (1.0 + longest);
  const double x = (length - 1.0) / (high - 1.0);
  return passive_force * (length <= high ? 0.5 * x * x : x - 0.5);
}

double MuscleActivation::time_constant(double activation, double excitation) const {
  const double factor = 0.5 + 1.5 * activation;
  return excitation > activation ? activation_time * factor : deactivation_time / factor;
}

double MuscleActivation::after(double activation, double excitation, double h) const {
  const auto decay = [&](double over, double tau) {
    return excitation + (activation - excitation) * portable::exp(-over / tau);
  };
  const double middle = decay(0.5 * h, time_constant(activation, excitation));
  return decay(h, time_constant(middle, excitation));
}

}  // namespace sheave
