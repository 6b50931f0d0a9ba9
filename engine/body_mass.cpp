#include "engine/body_mass.h"

#include <algorithm>

namespace sheave {

Matrix3 defined_inertia(const BodyDef& body) {
  Matrix3 inertia = body.inertia.value_or(Vector3::Zero()).asDiagonal();
  const Vector3& products = body.products_of_inertia;
  inertia(0, 1) = inertia(1, 0) = products.x();
  inertia(0, 2) = inertia(2, 0) = products.y();
  inertia(1, 2) = inertia(2, 1) = products.z();
  return inertia;
}

MassProperties defined_mass_properties(const BodyDef& body) {
  const bool by_shape = !body.mass && std::any_of(body.shapes.begin(), body.shapes.end(),
                                                  [](const PlacedShape& placed) {
                                                    return placed.density.has_value();
                                                  });
  MassProperties result;
  if (by_shape) {
    result = combine(body.shapes, body.density.value_or(0.0));
  } else if (!body.shapes.empty()) {
    // The shapes share a mass by their volumes.
    const MassProperties unit = combine(body.shapes, 1.0);
    const double density = body.density.value_or(body.mass ? *body.mass / unit.mass : 0.0);
    result = {density * unit.mass, unit.center_of_mass, density * unit.inertia};
  }
  if (body.mass) result.mass = *body.mass;
  if (body.center_of_mass) result.center_of_mass = *body.center_of_mass;
  if (body.inertia) result.inertia = defined_inertia(body);
  return result;
}

}  // namespace sheave
