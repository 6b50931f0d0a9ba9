// Moments of thin shells. With the density per area constant, the integrals of x^2, y^2 and z^2 over
// the surface, as means over the mass, are
//
//   sphere        r^2 / 3 each
//   side          r^2 / 2, r^2 / 2, h^2 / 3              of a cylinder of half length h
//   two caps      r^2 / 4, r^2 / 4, h^2                  discs at +-h
//   two halves    r^2 / 3, r^2 / 3, r^2 / 3 + h r + h^2  of a sphere, moved by +-h
//   two faces     a^2, b^2 / 3, c^2 / 3                  of a box, at +-a
//
// A moment of inertia is the sum of two of them. The integrals over an ellipsoid are elliptic. As in
// MuJoCo, its shell is the limit of the solid between an ellipsoid and the one whose half axes are
// longer by e: the derivatives of the volume V = 4/3 pi a b c and of V (b^2 + c^2) / 5 to e give
//
//   I_x = m / 5 (b^2 + c^2 + 2 (b + c) / (1/a + 1/b + 1/c)),
//
// and the area is Thomsen's formula with p = 1.6075, which is off by up to 1.1 %. For a sphere both
// are exact.

#include "scenes/import/mjcf/shells.h"

#include <array>

#include "engine/math/portable.h"

namespace sheave::import::mjcf {
namespace {

/// A part of a surface: its area and the means of the squares of its coordinates.
struct ShellPart {
  double area = 0.0;
  Vector3 squares = Vector3::Zero();
};

std::array<ShellPart, 3> parts_of(const Geom& geom) {
  const Vector3& s = geom.size;
  const double r = s[0];
  const double h = s[1];
  const double square = r * r;
  const ShellPart side{4.0 * pi * r * h, {0.5 * square, 0.5 * square, h * h / 3.0}};
  switch (geom.type) {
    case GeomType::sphere:
      return {{{4.0 * pi * square, Vector3::Constant(square / 3.0)}}};
    case GeomType::cylinder:
      return {{side, {2.0 * pi * square, {0.25 * square, 0.25 * square, h * h}}}};
    case GeomType::capsule:
      return {
          {side, {4.0 * pi * square, {square / 3.0, square / 3.0, square / 3.0 + h * r + h * h}}}};
    case GeomType::box: {
      std::array<ShellPart, 3> faces;
      for (int i = 0; i < 3; ++i) {
        ShellPart& pair = faces[static_cast<std::size_t>(i)];
        pair.area = 8.0 * s[(i + 1) % 3] * s[(i + 2) % 3];
        pair.squares = s.cwiseProduct(s) / 3.0;
        pair.squares[i] = s[i] * s[i];
      }
      return faces;
    }
    default:
      return {};
  }
}

double ellipsoid_area(const Vector3& s) {
  constexpr double power = 1.6075;
  const auto raised = [](double x, double exponent) {
    return portable::exp(exponent * portable::log(x));
  };
  const double sum =
      raised(s[0] * s[1], power) + raised(s[0] * s[2], power) + raised(s[1] * s[2], power);
  return 4.0 * pi * raised(sum / 3.0, 1.0 / power);
}

}  // namespace

double shell_area(const Geom& geom) {
  if (geom.type == GeomType::ellipsoid) return ellipsoid_area(geom.size);
  double area = 0.0;
  for (const ShellPart& part : parts_of(geom)) area += part.area;
  return area;
}

Vector3 shell_moments(const Geom& geom, double mass) {
  Vector3 moments = Vector3::Zero();
  if (geom.type == GeomType::ellipsoid) {
    const Vector3& s = geom.size;
    const double thickness = 1.0 / (1.0 / s[0] + 1.0 / s[1] + 1.0 / s[2]);
    for (int i = 0; i < 3; ++i) {
      const double b = s[(i + 1) % 3];
      const double c = s[(i + 2) % 3];
      moments[i] = 0.2 * mass * (b * b + c * c + 2.0 * (b + c) * thickness);
    }
    return moments;
  }
  const double area = shell_area(geom);
  for (const ShellPart& part : parts_of(geom)) {
    const double share = mass * part.area / area;
    moments += share * (Vector3::Constant(part.squares.sum()) - part.squares);
  }
  return moments;
}

}  // namespace sheave::import::mjcf
