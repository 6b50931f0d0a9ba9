// How redundant rows share a load.
//
// If fewer rows would be enough, statics does not determine the force of each: a rope beside joints
// that lock the body at its end, a belt between walls. The factorisation drops the pivot of one
// row, and the others carry the whole load. The choice of the dropped row is arbitrary: a rope on a
// locked body had thousands of newtons, or none, depending on the direction in space of the
// machine.
//
// Rows that only pull or only push are therefore regularised: each yields by e W per unit of its
// force, with a small e and its effective inverse mass W. In the first rounds the rows yield to
// their whole force. The forces l are then those with the least sum of W l^2, as if the rows were
// springs with stiffnesses in proportion to 1 / W. Joints that lock do not yield, so they carry all
// that they can carry alone. The rows keep a residual of e W l. Once no other residual is left,
// they yield to the changes of their forces only. Among redundant locks the factorisation drops
// one.
//
// Only rows that take part in a null vector, a change of forces that moves no body, are regularised
// (ActiveSetSolver::find_redundant_parts()). Rows with a compliance need no further regularisation.
//
// If the force of some row decides which links slip (Row::judged), all rows of the machine yield to
// changes only, from the first round on. Otherwise the forces would differ from those by which a
// round has judged the links. In the solution for velocities all rows yield to changes only, too,
// because the forces of the first half are to be kept and no later round removes the residual. Rows
// that are not judged then yield by a thousandth of e.

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {
namespace {

/// e of the head of this file, far above SparseFactor::dropped_pivot.
constexpr double yielding_share = 1e-9;
constexpr double share_of_rates = 1e-12;

bool is_one_sided(const Row& row) { return std::isfinite(row.lower) != std::isfinite(row.upper); }

}  // namespace

bool RowProblem::share_load() {
  constexpr double explained = 0.1;
  sharing_.clear();
  shares_judged_ = false;
  double open = 0.0;
  double yielded = 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (redundant_part_[g] == 0 || !is_one_sided(rows_[at(group.first_row)])) continue;
    Sharing own{g, 0.0};
    bool judged = false;
    double value = 0.0;
    for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
      value += rows_[at(i)].value;
      if (!(rows_[at(i)].compliance > 0.0)) own.yield += rows_[at(i)].weight * slots_.yield(i);
      judged = judged || rows_[at(i)].judged;
    }
    own.yield *= of_velocities_ && !judged ? share_of_rates : yielding_share;
    if (!(own.yield > 0.0)) continue;
    sharing_.push_back(own);
    shares_judged_ = shares_judged_ || judged;
    if (of_velocities_ || group.multiplier == 0.0) continue;
    open = std::max(open, std::abs(value + own.yield * group.multiplier));
    yielded = std::max(yielded, std::abs(own.yield * group.multiplier));
  }
  // The residual that is left is then the yield of these rows.
  if (yielded > 0.0 && open <= explained * yielded) finds_least_ = false;
  for (const Sharing& own : sharing_) {
    const Group& group = groups_[own.group];
    problem_.diagonal[own.group] += group.scale * own.yield;
    if (shares_judged_ || of_velocities_ || !finds_least_) continue;
    problem_.constant[own.group] += group.scale * own.yield * group.multiplier;
  }
  return !sharing_.empty();
}

double RowProblem::yielded() const {
  if (!shares_load_ || !finds_least_ || shares_judged_) return 0.0;
  const std::span<const double> change = active_set_.solution();
  double most = 0.0;
  for (const Sharing& own : sharing_) {
    most = std::max(most, own.yield * std::abs(groups_[own.group].multiplier + change[own.group]));
  }
  return most;
}

}  // namespace sheave
