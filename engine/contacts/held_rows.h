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
  /// Evaluates the rows of all features but `own` at the end of the substep.
  void collect(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features,
               const ConstraintBatch& own);
  /// One sweep: each group of rows stops its velocity, within the bounds of its multiplier. Returns
  /// the largest change of velocity [m/s or rad/s].
  double sweep(Substep& substep);
  /// Multipliers as they were at collect().
  void restore();
  /// Adds h times the impulses to the multipliers of the features, for forces to be told.
  void keep(std::span<const std::unique_ptr<ConstraintBatch>> features) const;
  [[nodiscard]] bool empty() const { return groups_.empty(); }

 private:
  /// Rows that share one unknown.
  struct Group {
    std::size_t feature = 0;
    std::size_t first = 0;
    std::size_t count = 0;
    double yield = 0.0;       ///< velocity per impulse
    double before = 0.0;      ///< the unknown at collect()
    double multiplier = 0.0;  ///< the unknown
  };

  void add(std::size_t feature, std::span<const double> multipliers, std::size_t first,
           std::size_t count);
  [[nodiscard]] double rate_of(const Substep& substep, const Group& group) const;
  void push_along(Substep& substep, const Group& group, double impulse) const;
  void find_yield(Substep& substep, Group& group);

  RowList rows_;
  std::vector<RowResponse> responses_;
  std::vector<Group> groups_;
  std::vector<BodyState> kept_;
};

}  // namespace sheave
