// How redundant rows share a load.
//
// Where fewer rows would do, statics leaves open what each of them carries: a rope beside joints
// that lock what it is tied to, a belt between walls. Factors without the pivot of one of them
// leave that one out, and the others carry all of it, whichever they are: a rope of a body that is
// locked had thousands of newtons, or none, by the direction in which the machine lay.
//
// So rows that only pull or only push yield, each by a small share e of what a unit of its force
// moves, W, at first to its force: the forces l are then those with the least sum of W l^2, as if
// the rows were springs that are as stiff as what they hold is light. What locks can carry alone
// they do, for they do not yield. Rows stay off by e W l then; once nothing else is left they yield
// to the changes of the forces only. Among locks alone one is left out, as the factors have it.
//
// Only rows of which one could be left out share anything: those that have a part in a change of
// forces which moves nothing (ActiveSetSolver::find_redundant_parts()). Those with a compliance do
// not yield any further.
//
// Where links with friction are judged by the forces of some of them (Row::judged), all of the
// machine's yield to changes from the first round on, or these would not stay what a round has made
// them; so does everything in the velocities, where the forces of the first half are meant to stay
// and no other round closes what is left: by a thousandth of e, but for rows that are judged.

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

bool RowSystem::share_load() {
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
  // What is left then is what rows yield.
  if (yielded > 0.0 && open <= explained * yielded) finds_least_ = false;
  for (const Sharing& own : sharing_) {
    const Group& group = groups_[own.group];
    problem_.diagonal[own.group] += group.scale * own.yield;
    if (shares_judged_ || of_velocities_ || !finds_least_) continue;
    problem_.constant[own.group] += group.scale * own.yield * group.multiplier;
  }
  return !sharing_.empty();
}

double RowSystem::yielded() const {
  if (!shares_load_ || !finds_least_ || shares_judged_) return 0.0;
  const std::span<const double> change = active_set_.solution();
  double most = 0.0;
  for (const Sharing& own : sharing_) {
    most = std::max(most, own.yield * std::abs(groups_[own.group].multiplier + change[own.group]));
  }
  return most;
}

}  // namespace sheave
