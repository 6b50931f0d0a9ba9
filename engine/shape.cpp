#include "engine/shape.h"

#include <array>

namespace sheave {

Errors Shape::validate(const std::string& /*path*/) const { return {}; }

std::span<const Field> PlacedShape::field_table() {
  static const std::array table{
      field<&PlacedShape::position>("position", "m", any_number(), optional,
                                    "origin of the shape in the body frame"),
      field<&PlacedShape::orientation>("orientation", "", any_number(), optional,
                                       "unit quaternion [w, x, y, z], shape frame to body frame"),
      field<&PlacedShape::density>("density", "kg/m3", above(0.0), optional,
                                   "of this shape, in place of the body's; the body then has no "
                                   "mass of its own"),
  };
  return table;
}

Matrix3 point_inertia(double mass, const Vector3& offset) {
  return mass * (offset.squaredNorm() * Matrix3::Identity() - offset * offset.transpose());
}

MassProperties combine(std::span<const PlacedShape> shapes, double density) {
  MassProperties total;
  std::vector<MassProperties> parts;
  for (const PlacedShape& placed : shapes) {
    MassProperties part = placed.shape->unit_density();
    const Matrix3 rotation = placed.orientation.toRotationMatrix();
    const double own_density = placed.density.value_or(density);
    part.mass *= own_density;
    part.inertia = (own_density * rotation * part.inertia * rotation.transpose()).eval();
    part.center_of_mass = placed.position + rotation * part.center_of_mass;
    total.mass += part.mass;
    total.center_of_mass += part.mass * part.center_of_mass;
    parts.push_back(part);
  }
  if (total.mass > 0.0) total.center_of_mass /= total.mass;
  for (const MassProperties& part : parts) {
    total.inertia +=
        part.inertia + point_inertia(part.mass, part.center_of_mass - total.center_of_mass);
  }
  return total;
}

}  // namespace sheave
