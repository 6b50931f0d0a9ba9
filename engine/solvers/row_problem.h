#pragma once
// Rows as a linear complementarity problem of their multipliers.
//
// A change dl of the unknowns l moves the bodies by W K^T dl, with the inverse masses W. The
// unknowns satisfy
//
//   r = c + A dl = 0,   A = J W K^T + D
//
// for free rows. For the others l + dl is at a bound, with r >= 0 at the lower bound and r <= 0 at
// the upper one (engine/solvers/active_set.h). J are the gradients of the rows, K those along which
// multipliers act. Compliance and regularisation add D. The constants c and D are those
// of the positions (engine/solvers/row_system.h) or of the velocities
// (engine/solvers/velocity_system.h) of a substep.

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/solvers/active_set.h"
#include "engine/solvers/row_slots.h"
#include "engine/substep.h"

namespace sheave {

using Features = std::span<const std::unique_ptr<ConstraintBatch>>;

/// Rows, unknowns and matrix, with their scratch. Only the pattern of the matrix is kept between
/// substeps.
class RowProblem {
 public:
  [[nodiscard]] int row_count() const { return static_cast<int>(rows_.size()); }
  /// Finds the unknowns; false if no active set was found, or if Substep::work is used up. Adds to
  /// the substep's statistics.
  bool solve(Substep& substep, bool compromise = false);
  /// Sweeps over the unknowns in place of solve(): projected Gauss-Seidel.
  void relax(Substep& substep, int sweeps);
  /// Whether some rows contradicted each other in the last solve(), so that nothing satisfies them
  /// all. With `compromise` all of them give way; otherwise some are left out.
  [[nodiscard]] bool contradicts() const { return active_set_.contradicts(); }
  /// Residual of rows that share a load, by their regularisation [m]; another round removes it.
  [[nodiscard]] double yielded() const;
  /// Rounding error of the rows' values [m].
  [[nodiscard]] double rounding() const { return rounding_; }

 protected:
  /// Quantities of which the rows are equations.
  enum class Of { positions, velocities };
  explicit RowProblem(Of of) : of_velocities_(of == Of::velocities) {}

  /// Rows that share an unknown.
  struct Group {
    int first_row = 0;
    int row_count = 0;
    double multiplier = 0.0;  ///< l
    double scale = 1.0;       ///< S
    bool elastic = false;     ///< at least one of the rows has a compliance
    double lever = 1.0;       ///< Row::lever of its rows
  };
  /// Row::value and Row::compliance at the start of the substep.
  struct Start {
    double value = 0.0;
    double compliance = 0.0;
  };
  /// Friction in several directions (engine/friction_rows.h), with its state between rounds.
  struct SharedFriction {
    std::size_t feature = 0;
    int index = 0;  ///< index of the first multiplier
    int first_row = 0;
    int count = 0;
    /// Present directions of the rows, in the directions of the feature; the first one is the
    /// direction of the slip.
    Matrix3 frame = Matrix3::Identity();
    bool turned = false;  ///< `frame` is not the unit matrix
    bool slips = false;
    double softness = 0.0;  ///< regularisation of the rows across the slip
  };
  /// Unknown that shares a load.
  struct Sharing {
    std::size_t group = 0;
    double yield = 0.0;  ///< e W [1/kg]
  };

  /// Computes gradients of the rows and responses of the bodies.
  void fill_slots(const Substep& substep);
  void make_groups();
  /// Effective inverse mass of the group's unknown, including compliance, with its rows taken one
  /// by one.
  [[nodiscard]] double yield(std::size_t group) const;
  /// Whether the force of the group bounds friction of a contact.
  [[nodiscard]] bool bounds_friction(const Group& group) const;
  /// Adds the effect of `motion_` on the groups' values to the constants of the problem.
  void count_motion();
  void assemble();
  bool solve_assembled(Substep& substep, bool compromise);
  /// Adds the regularisation of redundant rows that share a load to the matrix; false if there are
  /// none.
  bool share_load();
  /// Sets the sides with which slipping friction begins.
  void set_slipping_sides();
  /// Converts `multipliers` to the feature's own directions.
  void turn_back(const SharedFriction& friction, std::span<double> multipliers) const;
  void note_redundant_rows();
  /// Takes rows, multipliers and friction of `positions`, which no longer need the rows.
  void take_rows(RowProblem& positions);
  /// Takes which unknowns of `positions` share a load with redundant rows.
  void take_redundant_parts(const RowProblem& positions);
  /// Turns the friction's rows again as at the end of the positions.
  void turn_as_in(const RowProblem& positions);

  RowList rows_;
  RowSlots slots_;
  std::vector<int> feature_rows_;  ///< first row of each feature, and the count of rows
  std::vector<double> previous_;   ///< per row: its multiplier before the round
  std::vector<Start> starts_;      ///< per row
  std::vector<Group> groups_;
  std::vector<int> group_of_;
  std::vector<SharedFriction> shared_;
  std::span<const double> levers_;  ///< displacement per unit of each degree of freedom [m]
  std::span<const char> turns_;     ///< whether each degree of freedom is a rotation
  std::vector<double> motion_;      ///< per degree of freedom: displacement or turn, or their rates
  bool has_all_rows_ = false;       ///< ConstraintBatch::has_all_rows() of all features
  bool told_ = false;               ///< has_all_rows_, and all rows are Row::told
  bool assembled_ = false;          ///< the matrix is that of the last fill_slots()
  bool symmetric_rows_ = true;      ///< K = J except for weights
  ComplementarityProblem problem_;
  ActiveSetSolver active_set_;
  double rounding_ = 0.0;       ///< of the values of positions [m]; 0: not found yet
  bool shares_load_ = false;    ///< rows were redundant in the last solve()
  bool shares_judged_ = false;  ///< some rows of sharing_ are Row::judged
  bool finds_least_ = true;     ///< rows that share a load yield to their whole force
  /// Per unknown: whether it shares a load with redundant rows; empty: no row is redundant.
  std::vector<char> redundant_part_;
  /// Rows of these unknowns in the last solve(), by feature and Row::index, in order. Another
  /// linearisation may tie other rows together, so an index of an unknown does not outlive it.
  std::vector<std::pair<int, int>> redundant_rows_;

 private:
  std::vector<Sharing> sharing_;  ///< result of the last share_load()
  bool of_velocities_ = false;
};

}  // namespace sheave
