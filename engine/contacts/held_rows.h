#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/row_list.h"
#include "engine/substep.h"

namespace sheave {

/// The velocity along the gradient of a row [m/s or rad/s].
[[nodiscard]] double velocity_along(const Substep& substep, const Row& row);
/// Changes the velocities in substep.next by an impulse along the gradient of a row.
void push(Substep& substep, const Row& row, const RowResponse& response, double impulse);

/// Rows of other features that act during an impact: rigid joints, drives, and taut cables keep
/// their constraint on velocities while points of contact rebound. Springs act over time and are
/// left out, as is friction, whose impulse would need the pressure of the impact.
class HeldRows {
 public:
  /// Per body, with the world as the last one: whether rows of features other than `own` act on it
  /// and can move it. Valid until the next call.
  std::span<const char> bodies(Substep& substep,
                               std::span<const std::unique_ptr<ConstraintBatch>> features,
                               const ConstraintBatch& own);
  /// Evaluates the rows of all features but `own` at the end of the substep. With `at_instant`, rows
  /// take impulses of their own at that instant: the forces of the substep before it are no part of
  /// them, a limited force has no impulse, and a rope that is taut without a force takes part.
  void collect(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features,
               const ConstraintBatch& own, bool at_instant);
  /// One sweep: bilateral groups stop their velocities, all at once; after that each other group
  /// does, within the bounds of its multiplier. Returns the largest change of velocity [m/s],
  /// where an angular velocity counts times the lever of its row.
  double sweep(Substep& substep);
  /// Multipliers as they were at collect().
  void restore();
  /// Adds h times the impulses to the multipliers of the features, for forces to be told.
  void keep(std::span<const std::unique_ptr<ConstraintBatch>> features) const;
  /// Adds the impulses to Substep::late_forces, as forces of the second half of the substep.
  void keep_late(Substep& substep) const;
  [[nodiscard]] bool empty() const { return groups_.empty(); }

 private:
  /// Rows that share one unknown.
  struct Group {
    std::size_t feature = 0;
    std::size_t first = 0;
    std::size_t count = 0;
    double yield = 0.0;       ///< velocity per impulse
    double inertia = 0.0;     ///< inverse mass of an inertial row, which is part of `yield`
    double start = 0.0;       ///< velocity of an inertial row at collect()
    double before = 0.0;      ///< the unknown at collect()
    double multiplier = 0.0;  ///< the unknown
  };

  void add(std::size_t feature, std::span<const double> multipliers, std::size_t first,
           std::size_t count);
  void add_at_instant(std::size_t feature, double multiplier, std::size_t first, std::size_t count);
  [[nodiscard]] double velocity_of(const Substep& substep, const Group& group) const;
  [[nodiscard]] double rate_of(const Substep& substep, const Group& group) const;
  void push_along(Substep& substep, const Group& group, double impulse) const;
  void find_yield(Substep& substep, Group& group);
  [[nodiscard]] bool is_bilateral(const Group& group) const;
  /// Factors the effective inverse masses of the bilateral groups, if these are not too many.
  void factor(Substep& substep);
  /// Stops the velocities of the bilateral groups; returns the largest change.
  double stop_bilateral(Substep& substep);

  RowList rows_;
  std::vector<RowResponse> responses_;
  std::vector<Group> groups_;
  std::vector<BodyState> kept_;
  std::vector<std::size_t> bilateral_;  // groups of the factor
  std::vector<double> factor_;          // lower triangle L of L L^T, row by row
  std::vector<double> solution_;
  std::vector<char> bodies_;
  bool at_instant_ = false;
  double closed_ = 0.0;  ///< residual of a taut row [m]
};

}  // namespace sheave
