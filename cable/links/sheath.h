#pragma once

#include <optional>
#include <vector>

#include "cable/link.h"

namespace sheave {

/// The cable runs through a sheath along a curve that is fixed to a body, or from one body to another:
/// a Bowden cable, a tendon. The cable leaves the sheath in any direction, as through a pinhole.
/// Coulomb friction acts along it (cable/sheath_profile.h), so the tension in the sheath depends on
/// the history. Needs an elastic cable with `axial_stiffness`; docs/reference/limits.md has the links
/// beside it.
///
/// A sheath between two bodies has neither mass nor bending stiffness. Then the pressure in it is
/// equal to the tension of the rope at each place, and the two bodies feel the rope alone, as if its
/// free spans ended at the two ends of the sheath.
class SheathLink final : public LinkDef {
 public:
  /// Largest number of points.
  static constexpr std::size_t most_points = 10000;
  /// Largest friction x bend: beyond e^50 a tension vanishes in the rounding of the other.
  static constexpr double most_exponent = 50.0;

  /// The curve from the cable's entry to its exit, 2 to most_points points, body frame [m]. With
  /// another body at the exit: the entry, in the frame of `body`, and the exit, in that of the other
  /// body.
  std::vector<Vector3> points;
  /// The body that holds the exit; no rotor. Default: `body`. With another body than `body`, `length`
  /// and `bend` are needed; both stay as they are while the bodies move.
  std::optional<BodyId> exit;
  /// Length of the curve [m], at least the distance of its ends; default: that of the points. With
  /// more than 2 points it must agree within 1 percent with them, or with arcs through them.
  std::optional<double> length;
  /// Sum of the angles by which the curve bends the cable [rad], >= 0; default: that at the points.
  /// With more than 2 points it must agree with them within 1 percent, or be larger by up to half of
  /// the angles beside the ends. The bend counts as even along the length.
  std::optional<double> bend;
  /// Coulomb's coefficient between cable and sheath, >= 0: the tensions at both ends differ by at
  /// most the factor e^(friction x bend). friction x bend is at most most_exponent.
  double friction = 0.0;

  static constexpr std::string_view type_name = "sheath";
  static constexpr std::string_view type_meaning =
      "the cable slides through a sheath along a curve of a body, with friction all along it: a "
      "Bowden cable";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] BodyId exit_body() const override { return exit.value_or(body); }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;

 private:
  /// Adds the faults of a sheath whose exit is on another body.
  void check_exit(const BodySet& bodies, const std::string& path, Errors& errors) const;
};

}  // namespace sheave
