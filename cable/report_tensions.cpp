// Tensions along the spans of a report.

#include <algorithm>

#include "cable/cable_report.h"

namespace sheave {

double SpanReport::tension_at(double share) const {
  const double place = share * rest_length;
  for (std::size_t i = 1; i < laid.size(); ++i) {
    const bool forwards = laid[i - 1].length < laid[i].length;
    const Place& a = forwards ? laid[i - 1] : laid[i];
    const Place& b = forwards ? laid[i] : laid[i - 1];
    if (place < a.length || place > b.length || !(b.length > a.length)) continue;
    return a.tension + (b.tension - a.tension) * ((place - a.length) / (b.length - a.length));
  }
  // Without weight and inertia the forces are opposite, and `tension` has no error of a norm.
  if (is_zero(start_force + end_force)) return tension;
  if (floored > 0.0) {
    // Only the parts that hang have vertical components.
    const Vector3 load = start_force + end_force;
    const Vector3 up = -load.normalized();
    const double hung = (rest_length - floored) / rest_length;
    const double first = hung * std::max(-start_force.dot(up), 0.0) / load.norm();
    const Vector3 level = start_force - up * start_force.dot(up);
    const double last = hung - first;
    if (share < first) return (level - up * (load.norm() * (first - share) / hung)).norm();
    const double beyond = std::max(share - (1.0 - last), 0.0);
    return (level + up * (load.norm() * beyond / hung)).norm();
  }
  return ((1.0 - share) * start_force - share * end_force).norm();
}

double SpanReport::largest_tension() const {
  double largest = std::max(tension_at(0.0), tension_at(1.0));
  for (const Place& place : laid) largest = std::max(largest, place.tension);
  return largest;
}

double CableReport::largest_tension() const {
  double largest = 0.0;
  for (const SpanReport& span : spans) largest = std::max(largest, span.largest_tension());
  for (const WrapReport& wrap : wraps) largest = std::max(largest, wrap.span.largest_tension());
  return largest;
}

}  // namespace sheave
