// How redundant rows share a load.
//
// Where fewer rows would do, statics leaves open what each of them carries: a rope beside joints
// that lock what it is tied to, a belt between walls. Factors without the pivot of one of them
// leave that one out, and the others carry all of it, whichever they are: a rope of a body that is
// locked had thousands of newtons, or none, by the direction in which the machine lay.
//
// So rows that only pull or only push yield, each by a small share e of what a unit of its force
// moves, W: the forces l are then those with the least sum of W l^2, as if the rows were springs
// that are as stiff as what they hold is light. What locks can carry alone they do, for they do not
// yield. Rows stay off by e W l, which is nothing. Among locks alone one is left out, as the factors
// have it.
//
// Rows by which links with friction are judged (Row::judged) yield to the changes of their forces
// instead, or these would not stay what a round has made them; so does everything in the velocities,
// where the forces of the first half are meant to stay.

#include <cmath>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {
namespace {

bool is_one_sided(const Row& row) { return std::isfinite(row.lower) != std::isfinite(row.upper); }

}  // namespace

bool RowSystem::share_load() {
  // Far above SparseFactor::dropped_pivot.
  constexpr double share = 1e-9;
  bool any = false;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (redundant_part_[g] == 0 || !is_one_sided(rows_[at(group.first_row)])) continue;
    double yields = 0.0;
    bool judged = of_velocities_;
    for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
      if (!(rows_[at(i)].compliance > 0.0)) yields += rows_[at(i)].weight * slots_.yield(i);
      judged = judged || rows_[at(i)].judged;
    }
    const double softness = group.scale * share * yields;
    problem_.diagonal[g] += softness;
    if (!judged) problem_.constant[g] += softness * group.multiplier;
    any = any || yields > 0.0;
  }
  return any;
}

}  // namespace sheave
