#pragma once
// The strain with which the cable of a material lies on a wheel; internal to the cable library.
//
// Cable comes onto a wheel with the strain of the span it comes from and keeps it there, since
// nothing slips. Off it comes at either end: on a wheel that turns on first in, first out, on a
// drum or a wheel that turns back last in, first out. So what lies on a link is a row of pieces
// from the incoming end to the outgoing one, with a strain each.
//
// A mean per link would be simpler and right for a belt that runs steadily. But a drum that has
// taken in 10 m under a load on top of 90 m under none would give them back with a tenth of their
// strain, and the load would not come back to where it was. The number of pieces is bounded: of
// more, those two neighbours become one whose merging costs least. A piece knows the integrals of
// strain and of its square, so merging keeps the arc that the cable covers and the energy in it;
// what it changes is only with which strain cable comes off again, by about 1/16 of the range over
// which the load varied.

#include <array>
#include <span>

namespace sheave {

/// Cable as it lies on one link.
class StoredStrain {
 public:
  static constexpr int most_pieces = 16;
  static constexpr std::size_t real_count = std::size_t{3} * most_pieces;  ///< of a saved one

  enum class End { incoming, outgoing };

  struct Piece {
    double length = 0.0;   ///< unstretched [m]
    double stretch = 0.0;  ///< integral of the strain over it [m]
    double square = 0.0;   ///< integral of its square [m]; times EA / 2 the energy
    [[nodiscard]] double strain() const { return length > 0.0 ? stretch / length : 0.0; }
  };

  StoredStrain() = default;
  /// From `real_count` numbers: pieces from the incoming end on, unused ones 0.
  explicit StoredStrain(std::span<const double> reals);
  void save(std::span<double> reals) const;

  /// Unstretched length of what covers `arc` [m, >= 0] from an end; beyond what there is with the
  /// strain `beyond`.
  [[nodiscard]] double rest_of(End end, double arc, double beyond) const;
  /// Takes `length` [m, >= 0] unstretched cable off an end, or all there is, and tells what it was.
  Piece take(End end, double length);
  /// Puts cable onto an end: `length` [m, >= 0] unstretched, with this strain.
  void put(End end, double length, double strain);
  /// Puts a piece of several strains onto an end.
  void put(End end, const Piece& piece);
  /// Makes the unstretched length `length` [m; below 0 counts as 0] by taking from an end or
  /// putting onto it.
  void fit(End end, double length, double strain);
  [[nodiscard]] Piece total() const;
  [[nodiscard]] double most_strain() const;  ///< of all pieces; 0 without any

 private:
  void merge_cheapest();

  std::array<Piece, most_pieces + 1> pieces_{};  ///< one more while merging
  std::size_t count_ = 0;
};

}  // namespace sheave
