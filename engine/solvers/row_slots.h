#pragma once
// The gradients of all rows along degrees of freedom, and the matrix that couples their unknowns.
//
// A row touches bodies, and a body has one to six degrees of freedom. Each of these is a slot of
// the row, with the component J of the gradient and the motion W K per unit of the row's
// multiplier. Rows that share an unknown are added up: J without weights, W K with the rows'
// weights. An unknown therefore has a block of slots for each body that its rows touch, and
//
//   A(i, j) = sum of J_i W K_j  over the slots of bodies that both touch.
//
// A row that only turns a body (its linear gradient is 0) has slots for the rotation alone. The
// pattern, which is the slots and their couplings, is kept until rows touch other bodies.

#include <span>
#include <utility>
#include <vector>

#include "engine/dynamics/coordinates.h"
#include "engine/math/written_out.h"
#include "engine/row_list.h"

namespace sheave {

class RowSlots {
 public:
  /// Computes the gradients J of the rows and the responses of the bodies. Copies that have not
  /// changed since the last call keep theirs. If the rows have another pattern than those of the
  /// last call, their slots and couplings are found first; returns whether they were.
  bool fill(const Coordinates& coordinates, const RowList& rows,
            std::span<const MovingBody> bodies);
  /// Lets row `row` act along the gradient of a row of `other`; false if the two have different
  /// slots.
  [[nodiscard]] bool act_along(int row, const RowSlots& other, int other_row);
  /// Replaces `count` rows from `first_row` on, which have the same slots, by linear combinations
  /// with the coefficients in the rows of `mixture`: the responses, and if `gradients` also the
  /// gradients.
  void mix(int first_row, int count, const Matrix3& mixture, bool gradients);
  /// Whether both rows are copies of the same row.
  [[nodiscard]] bool is_copy_as_in(int row, const RowSlots& other, int other_row) const;
  /// Adds up the rows that share an unknown, with their present weights.
  void join(const RowList& rows);

  [[nodiscard]] int row_count() const { return static_cast<int>(row_start_.size()) - 1; }
  [[nodiscard]] int unknown_count() const { return static_cast<int>(unknowns_.size()); }
  /// Pairs of unknowns i < j that couple.
  [[nodiscard]] std::span<const std::pair<int, int>> entries() const { return entries_; }
  /// K W K^T of a row: its effective inverse mass [1/kg].
  [[nodiscard]] double yield(int row) const { return yields_[static_cast<std::size_t>(row)]; }

  /// motion += change x the motion per unit of the row's multiplier.
  [[gnu::always_inline]] void add_row(int row, double change, double* motion) const {
    add({row_start_[static_cast<std::size_t>(row)], row_start_[static_cast<std::size_t>(row) + 1]},
        change, motion);
  }
  /// Likewise for an unknown.
  [[gnu::always_inline]] void add_unknown(int unknown, double change, double* motion) const {
    add(unknowns_[static_cast<std::size_t>(unknown)].slots, change, motion);
  }
  /// J . motion for an unknown.
  [[nodiscard, gnu::always_inline]] double along(int unknown, const double* motion) const {
    const Range slots = unknowns_[static_cast<std::size_t>(unknown)].slots;
    const double* gradient = gradient_.data() + slots.first;
    const int* dof = dof_.data() + slots.first;
    double sum = 0.0;
    for_few(
        slots.last - slots.first, [&](int s) __attribute__((always_inline)) {
          sum += gradient[s] * motion[dof[s]];
        });
    return sum;
  }

  /// Updates A after fill(), act_along() and join(): the diagonal, A(i, j) of each entry (i, j),
  /// and A(j, i) unless `symmetric`. Diagonal entries of the size of rounding become 0. The
  /// rows of an unknown cancel to such an entry if only a wheel over which the cable slides can
  /// move; the unknown then moves no body.
  void assemble(bool symmetric);
  [[nodiscard]] std::span<const double> diagonal() const { return diagonal_; }
  [[nodiscard]] const std::vector<double>& above() const { return above_; }
  [[nodiscard]] const std::vector<double>& below() const { return below_; }

 private:
  struct Range {
    int first = 0;
    int last = 0;
  };
  /// Slots of degrees of freedom that two unknowns have in common.
  struct Shared {
    int first = 0;
    int second = 0;
    int count = 0;
  };
  /// An unknown with several rows has slots of its own, behind those of all rows. An unknown with
  /// one row uses the slots of the row.
  struct Unknown {
    Range slots;
    Range rows;
    [[nodiscard]] bool joins() const { return rows.last - rows.first > 1; }
  };
  [[gnu::always_inline]] void add(Range slots, double change, double* motion) const {
    const double* response = motion_.data() + slots.first;
    const int* dof = dof_.data() + slots.first;
    for_few(
        slots.last - slots.first, [&](int s) __attribute__((always_inline)) {
          motion[dof[s]] += change * response[s];
        });
  }
  /// The body of a term, and the degrees of freedom that the term uses: all of the body, or those of
  /// its rotation.
  struct TermPart {
    int body = 0;
    Freedom kind = Freedom::none;
    bool turns_only = false;
  };
  [[nodiscard]] static TermPart part_of(const Coordinates& coordinates, const RowTerm& term,
                                        bool whole);
  void find_pattern(const Coordinates& coordinates, const RowList& rows);
  /// fill(), if the rows have the present pattern; false otherwise.
  [[nodiscard]] bool fill_pattern(const Coordinates& coordinates, const RowList& rows,
                                  std::span<const MovingBody> bodies);
  /// Computes the slots of a row with the parts that begin at `part`; false if the row has others.
  [[nodiscard]] bool fill_row(const Coordinates& coordinates, const Row& row,
                              std::span<const MovingBody> bodies, bool whole, const TermPart* part,
                              std::size_t index);
  void lay_out(const Coordinates& coordinates, const RowList& rows);
  void lay_out_joint(Unknown& unknown);
  void find_couplings(const Coordinates& coordinates);
  /// Updates the entries: products of `gradient_` of one unknown and `motion_` of the other.
  void couple(bool transposed, std::vector<double>& values) const;
  void sort_couplings();

  /// Pattern of the rows: per row whether it is tied or has all slots, and its number of terms.
  std::vector<int> marks_;
  std::vector<TermPart> parts_;  ///< per term of each row
  std::vector<int> row_start_{0};
  std::vector<Unknown> unknowns_;
  std::vector<int> unknown_of_;  ///< per row
  // Per slot.
  std::vector<int> dof_;
  std::vector<double> gradient_;  ///< J
  std::vector<double> motion_;    ///< W K
  std::vector<int> place_;        ///< slot of the unknown, for a row with a shared unknown
  std::vector<double> yields_;    ///< per row
  std::vector<std::pair<const Row*, std::uint32_t>> copies_;  ///< source of the slots of each row
  std::vector<int> joint_;                                    ///< unknowns with several rows
  std::vector<double>
      uncancelled_;            ///< per unknown with several rows: the sum of |J W K| of its rows
  std::vector<char> changed_;  ///< per unknown: changed since the last assemble()
  bool any_changed_ = true;
  bool was_symmetric_ = true;
  std::vector<double> diagonal_;
  std::vector<double> above_;
  std::vector<double> below_;
  /// Slots of an unknown at one body.
  struct Block {
    int unknown = 0;
    int body = 0;
    int first = 0;
    int count = 0;
  };
  /// Slots that the blocks of two unknowns at one body have in common.
  [[nodiscard]] static Shared common(const Block& a, const Block& b);
  std::vector<Block> blocks_;  ///< by unknown
  /// Sorted by kind: unknowns with one common degree of freedom, then with three of one body, then
  /// all others.
  std::vector<std::pair<int, int>> entries_;
  std::size_t ones_ = 0;           ///< number of entries of the first kind
  std::size_t threes_ = 0;         ///< number of entries of the first two kinds
  std::vector<int> shared_start_;  ///< per entry
  std::vector<Shared> shared_;
};

}  // namespace sheave
