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
  /// Lets row `row` act along the gradient of a row of `other` that touches the same bodies.
  void act_along(int row, const RowSlots& other, int other_row);
  /// Makes `count` rows from `first_row` on, which touch the same bodies, the sums of them that the
  /// rows of `mixture` tell: how the bodies respond, and, if asked, their gradients.
  void mix(int first_row, int count, const Matrix3& mixture, bool gradients);
  /// Whether both rows are copies of the same.
  [[nodiscard]] bool is_copy_as_in(int row, const RowSlots& other, int other_row) const;
  /// Adds up the rows that share an unknown, with the weights that they have now.
  void join(const RowList& rows);

  [[nodiscard]] int row_count() const { return static_cast<int>(row_start_.size()) - 1; }
  [[nodiscard]] int unknown_count() const { return static_cast<int>(unknown_start_.size()) - 1; }
  /// Pairs of unknowns i < j that couple.
  [[nodiscard]] std::span<const std::pair<int, int>> entries() const { return entries_; }
  /// K W K^T of a row [1/kg]: how easily it yields.
  [[nodiscard]] double yield(int row) const { return yields_[static_cast<std::size_t>(row)]; }

  /// motion += change x the motion that row's multiplier causes.
  [[gnu::always_inline]] void add_row(int row, double change, double* motion) const {
    add(motion_.data(), row_dof_.data(), row_start_.data() + row, change, motion);
  }
  /// The same of an unknown.
  [[gnu::always_inline]] void add_unknown(int unknown, double change, double* motion) const {
    add(joint_motion(), dof(), unknown_start_.data() + unknown, change, motion);
  }
  /// J . motion of an unknown.
  [[nodiscard, gnu::always_inline]] double along(int unknown, const double* motion) const {
    const double* gradient = joint_gradient();
    const int* dofs = dof();
    const int* start = unknown_start_.data() + unknown;
    double sum = 0.0;
    for (int s = start[0]; s < start[1]; ++s) sum += gradient[s] * motion[dofs[s]];
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
  /// Slots of one body in two unknowns.
  struct Shared {
    int first = 0;
    int second = 0;
    int count = 0;
  };
  [[gnu::always_inline]] static void add(const double* response, const int* dofs, const int* start,
                                         double change, double* motion) {
    for (int s = start[0]; s < start[1]; ++s) motion[dofs[s]] += change * response[s];
  }
  // Where no rows share an unknown the slots of the rows are those of the unknowns.
  [[nodiscard]] const double* joint_gradient() const {
    return joined_ ? joint_gradient_.data() : gradient_.data();
  }
  [[nodiscard]] const double* joint_motion() const {
    return joined_ ? joint_motion_.data() : motion_.data();
  }
  [[nodiscard]] const int* dof() const { return joined_ ? dof_.data() : row_dof_.data(); }
  [[nodiscard]] bool same_pattern(const RowList& rows) const;
  void lay_out(const Coordinates& coordinates, const RowList& rows);
  void find_couplings(const Coordinates& coordinates);
  [[nodiscard]] double coupling(std::size_t entry, bool transposed) const;

  std::vector<int> signature_;  ///< of the pattern: per row whether it is tied, and its bodies
  // Of rows.
  std::vector<int> row_start_{0};
  std::vector<int> row_dof_;
  std::vector<double> gradient_;  ///< J
  std::vector<double> motion_;    ///< W K
  std::vector<double> yields_;
  std::vector<std::pair<const Row*, std::uint32_t>> copies_;  ///< what the slots of a row are of
  std::vector<int> place_;  ///< of a row's slot among those of the unknowns
  std::vector<int> unknown_of_;
  bool joined_ = false;  ///< some rows share an unknown
  // Of unknowns.
  std::vector<int> unknown_start_{0};
  std::vector<int> dof_;
  std::vector<double> joint_gradient_;
  std::vector<double> joint_motion_;
  std::vector<double> uncancelled_;  ///< per unknown: the sum of |J W K| of its rows
  std::vector<char> changed_;        ///< per unknown, since the last assemble()
  bool was_symmetric_ = true;
  std::vector<double> diagonal_;
  std::vector<double> above_;
  std::vector<double> below_;
  struct Block {
    int unknown = 0;
    int body = 0;
    int first = 0;
    int count = 0;
  };
  std::vector<Block> blocks_;
  std::vector<std::pair<int, int>> entries_;
  std::vector<int> shared_start_;  ///< per entry
  std::vector<Shared> shared_;
};

}  // namespace sheave
