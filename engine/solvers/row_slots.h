#pragma once
// The gradients of all rows along degrees of freedom, and the matrix that couples their unknowns.
//
// A row touches bodies, a body has one to six degrees of freedom: each of these is a slot, with the
// number J of the gradient there and the motion W K that a unit of the row's multiplier causes.
// Rows that share an unknown are added up: J as they are, W K times their weights. So an unknown is
// a block of slots for each body that it touches, and
//
//   A(i, j) = sum of J_i W K_j  over the slots of bodies that both touch.
//
// A row that only turns a body (its part along the positions is 0) has slots for the turn alone.
// Which slots there are and which of them couple (the pattern) is found once and kept until rows
// touch other bodies.

#include <span>
#include <utility>
#include <vector>

#include "engine/dynamics/coordinates.h"
#include "engine/row_list.h"

namespace sheave {

class RowSlots {
 public:
  /// Finds the slots of these rows, and what couples, unless it is known. Returns whether the
  /// pattern is another one.
  bool find_pattern(const Coordinates& coordinates, const RowList& rows);
  /// The gradients J of the rows, whose pattern it is, and how the bodies respond along them. Rows
  /// that are copies of what they were last time have them already.
  void fill(const Coordinates& coordinates, const RowList& rows,
            std::span<const MovingBody> bodies);
  /// Lets row `row` act along the gradient of a row of `other`; false if that has other slots.
  [[nodiscard]] bool act_along(int row, const RowSlots& other, int other_row);
  /// Makes `count` rows from `first_row` on, which have the same slots, the sums of them that the
  /// rows of `mixture` tell: how the bodies respond, and, if asked, their gradients.
  void mix(int first_row, int count, const Matrix3& mixture, bool gradients);
  /// Whether both rows are copies of the same.
  [[nodiscard]] bool is_copy_as_in(int row, const RowSlots& other, int other_row) const;
  /// Adds up the rows that share an unknown, with the weights that they have now.
  void join(const RowList& rows);

  [[nodiscard]] int row_count() const { return static_cast<int>(row_start_.size()) - 1; }
  [[nodiscard]] int unknown_count() const { return static_cast<int>(unknowns_.size()); }
  /// Pairs of unknowns i < j that couple.
  [[nodiscard]] std::span<const std::pair<int, int>> entries() const { return entries_; }
  /// K W K^T of a row [1/kg]: how easily it yields.
  [[nodiscard]] double yield(int row) const { return yields_[static_cast<std::size_t>(row)]; }

  /// motion += change x the motion that row's multiplier causes.
  [[gnu::always_inline]] void add_row(int row, double change, double* motion) const {
    add({row_start_[static_cast<std::size_t>(row)], row_start_[static_cast<std::size_t>(row) + 1]},
        change, motion);
  }
  /// The same of an unknown.
  [[gnu::always_inline]] void add_unknown(int unknown, double change, double* motion) const {
    add(unknowns_[static_cast<std::size_t>(unknown)].slots, change, motion);
  }
  /// J . motion of an unknown.
  [[nodiscard, gnu::always_inline]] double along(int unknown, const double* motion) const {
    const Range slots = unknowns_[static_cast<std::size_t>(unknown)].slots;
    const double* gradient = gradient_.data();
    const int* dof = dof_.data();
    double sum = 0.0;
    for (int s = slots.first; s < slots.last; ++s) sum += gradient[s] * motion[dof[s]];
    return sum;
  }

  /// Brings A up to date with what fill(), act_along() and join() have changed: the diagonal, 0
  /// where it is but rounding (where the rows of an unknown cancel, because nothing but a wheel
  /// that the cable slides over can move, the unknown has nothing to move), A(i, j) of each entry
  /// (i, j) and, if it is asked for, A(j, i).
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
  /// Of rows that share an unknown the slots are their own, behind those of all rows; otherwise
  /// they are those of the row.
  struct Unknown {
    Range slots;
    Range rows;
    [[nodiscard]] bool joins() const { return rows.last - rows.first > 1; }
  };
  [[gnu::always_inline]] void add(Range slots, double change, double* motion) const {
    const double* response = motion_.data();
    const int* dof = dof_.data();
    for (int s = slots.first; s < slots.last; ++s) motion[dof[s]] += change * response[s];
  }
  /// What of a body's degrees of freedom the term is about: that of the body, or of its rotation.
  [[nodiscard]] static Freedom part_of(const BodyFreedom& freedom, const RowTerm& term, bool whole);
  [[nodiscard]] bool same_pattern(const RowList& rows) const;
  void lay_out(const Coordinates& coordinates, const RowList& rows);
  void lay_out_joint(Unknown& unknown);
  void find_couplings(const Coordinates& coordinates);
  /// Brings entries up to date: where `gradient_[]` of one unknown meets `motion_[]` of the other.
  void couple(bool transposed, std::vector<double>& values) const;
  void sort_couplings();

  /// Of the pattern: per row whether it is tied, its bodies, and which of them it only turns.
  std::vector<int> signature_;
  std::vector<Freedom> term_parts_;  ///< per term of each row
  std::vector<int> row_start_{0};
  std::vector<Unknown> unknowns_;
  std::vector<int> unknown_of_;  ///< per row
  // Of slots.
  std::vector<int> dof_;
  std::vector<double> gradient_;  ///< J
  std::vector<double> motion_;    ///< W K
  std::vector<int> place_;      ///< of the slot of a row that shares its unknown: of the unknown's
  std::vector<double> yields_;  ///< per row
  std::vector<std::pair<const Row*, std::uint32_t>> copies_;  ///< what the slots of a row are of
  std::vector<int> joint_;                                    ///< unknowns that rows share
  std::vector<double>
      uncancelled_;            ///< per unknown that rows share: the sum of |J W K| of its rows
  std::vector<char> changed_;  ///< per unknown, since the last assemble()
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
  /// What the blocks of two unknowns at one body have in common.
  [[nodiscard]] static Shared common(const Block& a, const Block& b);
  std::vector<Block> blocks_;  ///< by unknown
  /// First those whose unknowns have one degree of freedom in common, then those with three of one
  /// body, then all others.
  std::vector<std::pair<int, int>> entries_;
  std::size_t ones_ = 0;           ///< how many of the first kind there are
  std::size_t threes_ = 0;         ///< and of the first two
  std::vector<int> shared_start_;  ///< per entry
  std::vector<Shared> shared_;
};

}  // namespace sheave
