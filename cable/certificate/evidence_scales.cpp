// Scales below which sizes and forces are rounding.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/evidence.h"
#include "engine/index.h"

namespace sheave::certify {

double Evidence::rounding_of_forces() const {
  // Rounding of a few operations on coordinates of this size.
  constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
  double sum = 0.0;
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& body = bodies[i];
    if (!yields(body.mobility)) continue;
    const double size = size_of(i);
    const double spun = size > 0.0 ? body.axis_inertia / (size * size) : 0.0;
    sum += std::max(body.mass, spun) * (end.bodies[at(i)].position.norm() + bodies.scale());
  }
  return rounding * sum / (h * h);
}

double Evidence::size_of(int body) const {
  if (body == bodies.count()) return 0.0;
  double size = 0.0;
  for (const PlacedShape& placed : bodies.definition(body).shapes) {
    const double radius = placed.shape->half_extent().norm();
    if (!std::isfinite(radius)) continue;
    size = std::max(size, (placed.position - bodies[body].center_of_mass).norm() + radius);
  }
  if (size > 0.0 || !(bodies[body].mass > 0.0)) return size;
  const double moment = std::max(bodies[body].inertia.trace() / 3.0, bodies[body].axis_inertia);
  return std::sqrt(moment / bodies[body].mass);
}

std::string SpanEvidence::name() const {
  if (place < 0) return "a wrap of \"" + std::string(cable) + "\"";
  return std::string(cable) + "." + std::to_string(place);
}

}  // namespace sheave::certify
