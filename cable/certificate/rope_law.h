#pragma once
// Ropes with a table of tensions, computed independently of the solvers and of cable/tension_law.h:
// by the values and slopes at the points of the table (Hermite's form).

#include <vector>

#include "cable/cable.h"

namespace sheave::certify {

/// The tension of a rope over its strain, as the documentation of its table defines it.
class RopeLaw {
 public:
  /// `cable` has a table.
  explicit RopeLaw(const CableDef& cable);

  [[nodiscard]] double tension(double strain) const;  ///< [N]
  [[nodiscard]] double energy(double strain) const;   ///< per unstretched length [N]
  /// The change of the energy over the change of the strain [N].
  [[nodiscard]] double mean(double from, double to) const;
  /// Least stiffness of the chords near a strain [N].
  [[nodiscard]] double stiffness(double strain) const;

 private:
  struct Point {
    double strain = 0.0;
    double tension = 0.0;  ///< [N]
    double slope = 0.0;    ///< [N]
    double energy = 0.0;   ///< [N]
  };
  /// Index of the piece in which a strain lies; that of the last point beyond it.
  [[nodiscard]] std::size_t piece_of(double strain) const;

  std::vector<Point> points_;
};

}  // namespace sheave::certify
