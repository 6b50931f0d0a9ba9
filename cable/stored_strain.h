#pragma once
// The strain of cable with a material that is stored on a wheel; internal to the cable library.
//
// Cable comes onto a wheel with the strain of its span and keeps that strain, since it does not
// slip. Cable comes off at either end: first in, first out on a wheel that keeps turning; last in,
// first out on a drum or a wheel that turns back. The stored cable is therefore a list of pieces
// from the incoming end to the outgoing end, with one strain each.
//
// One mean strain per link would be simpler, and exact for a belt that runs steadily. But a drum
// that has taken in 10 m under a load on top of 90 m without load would give these 10 m back with a
// tenth of their strain, and the load would not return to its place. The number of pieces is
// bounded: beyond the bound the two neighbours that one piece represents best become one piece. A
// piece keeps the integrals of the strain, of its energy and of its moment about the middle. So
// merging keeps the covered arc and the stored energy, and the strain of a merged piece is the
// straight line of least squares. A part of it has the energy by the second-order expansion of the
// energy about the mean strain, exact for constant EA, so that all parts have that of the piece. A
// piece that was never merged has one strain. A load that varies once to and fro while the cable comes on
// leaves an error of at most 2 % of its range in the strain with which the cable comes off again.

#include <array>
#include <span>

#include "cable/strain_energy.h"

namespace sheave {

/// The cable stored on one link.
class StoredStrain {
 public:
  static constexpr int most_pieces = 16;
  /// number of saved numbers
  static constexpr std::size_t real_count = std::size_t{5} * most_pieces;

  enum class End { incoming, outgoing };

  struct Piece {
    double length = 0.0;   ///< unstretched [m]
    double stretch = 0.0;  ///< integral of the strain over it [m]
    /// Integral of its square [m], or of StrainEnergy::of(); times EA / 2 this is the energy.
    double square = 0.0;
    /// Integral of the strain times the distance from the middle, towards the outgoing end [m2].
    double moment = 0.0;
    /// Integral of the square of the distance of the strain from the straight line [m].
    double scatter = 0.0;
    [[nodiscard]] double strain() const { return length > 0.0 ? stretch / length : 0.0; }
    /// Change of the strain per length towards the outgoing end [1/m]. Both ends stay above 0.
    [[nodiscard]] double slope() const;
    /// Strain at an end.
    [[nodiscard]] double strain_at(End end) const;
    /// Unstretched length that covers `arc` [m], counted from an end.
    [[nodiscard]] double rest_of(End end, double arc) const;
    /// Takes `part` [m], less than the length, off an end and returns it.
    Piece split(End end, double part, const StrainEnergy& energy);
  };

  StoredStrain() = default;
  /// Reads `real_count` numbers: pieces from the incoming end on; unused ones are 0.
  explicit StoredStrain(std::span<const double> reals);
  void save(std::span<double> reals) const;

  /// Unstretched length of the cable that covers `arc` [m, >= 0], counted from an end. Beyond the
  /// stored cable the strain is `beyond`.
  [[nodiscard]] double rest_of(End end, double arc, double beyond) const;
  /// Takes `length` [m, >= 0] of unstretched cable off an end, or all that is stored, and returns
  /// it.
  Piece take(End end, double length, const StrainEnergy& energy);
  /// Puts cable onto an end: `length` [m, >= 0] unstretched, with this strain.
  void put(End end, double length, double strain, const StrainEnergy& energy);
  /// Puts cable onto an end as one piece, with the integrals of `piece`.
  void put(End end, const Piece& piece);
  /// Changes the unstretched length to `length` [m; below 0 counts as 0] by taking from an end or
  /// putting cable with this strain onto it.
  void fit(End end, double length, double strain, const StrainEnergy& energy);
  [[nodiscard]] Piece total() const;
  [[nodiscard]] double most_strain() const;  ///< of all pieces; 0 without any
  /// Strain at a share of the covered arc, counted from the incoming end; 0 without any cable.
  [[nodiscard]] double strain_at(double share) const;

 private:
  void merge_closest();

  std::array<Piece, most_pieces + 1> pieces_{};  ///< one entry more than saved, for merging
  std::size_t count_ = 0;
};

}  // namespace sheave
