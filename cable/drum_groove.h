#pragma once
// The way of a rope on a drum with a helical groove; internal to the cable library.
//
// The angle a [rad] counts the rope on the drum, from the groove's start. The rope's place along the
// axle is z(a), and one radian takes R(a) = dS/da of rope, with the stored length S. Within layer k
// (0 is the innermost) the rope lies on the radius r_k = r + k height, and with the lead p
//   z' = +-p / 2 pi,   R_k = sqrt(r_k^2 + (p / 2 pi)^2),
// so a turn takes the length of its helix, sqrt((2 pi r_k)^2 + p^2). After `turns` turns the layer
// is full, and the next one goes back.
//
// A rope that changes its layer at one angle would jump. Over half a turn about each change the
// model takes R and z' as linear in a: R goes from R_k to R_{k+1}, z' from one sign to the other.
// Then S and z are quadratic there, and S is the sum of the layers outside of these arcs. In an arc
// z' < p / 2 pi and r' = height / pi, so that a helix with this z' and r' differs from R by less than
// (p / 2 pi)^2 / 2r and (height / pi)^2 / 2r per radian. At its turning point the rope stays p / 8
// short of the end of the layer.
//
// Energy is conserved with any R(a) and z(a): cable/span_groove.h.

namespace sheave {

/// A groove as defined.
struct DrumGroove {
  /// Further layers are counted as this one.
  static constexpr int most_layers = 10000;
  /// The groove at an angle.
  struct Place {
    double gain = 0.0;   ///< R = dS/da [m/rad]
    double axial = 0.0;  ///< z along the normal, from the centre of the drum [m]
    double slope = 0.0;  ///< dz/da [m/rad]
    int layer = 0;       ///< 0: the innermost
  };

  double radius = 0.0;  ///< of the innermost layer [m], > 0
  double lead = 0.0;    ///< way along the normal per turn of the innermost layer [m], any sign
  double start = 0.0;   ///< z where the groove starts [m]
  double turns = 0.0;   ///< per layer, >= 1; infinite: one layer without end
  double height = 0.0;  ///< growth of the radius per layer [m], >= 0
  int layers = 0;       ///< that fit between the flanges; 0: any number
  double most_fleet_angle = 0.0;  ///< above which the run warns [rad]; infinite: none

  [[nodiscard]] Place at(double angle) const;
  /// S(angle) [m].
  [[nodiscard]] double length(double angle) const;
  /// S(angle + turn) - S(angle) [m].
  [[nodiscard]] double length(double angle, double turn) const;
  /// The angle at which the drum stores this length [rad].
  [[nodiscard]] double angle(double length) const;
  /// Length of rope with which the last layer is full [m]; infinite: the drum is never full.
  [[nodiscard]] double full_length() const;

 private:
  struct Piece;
  [[nodiscard]] bool has_layers() const;
  [[nodiscard]] double per_layer() const;         ///< angle of a layer [rad]
  [[nodiscard]] double gain_of(int layer) const;  ///< R_k [m/rad]
  [[nodiscard]] Piece piece(double angle) const;
};

}  // namespace sheave
