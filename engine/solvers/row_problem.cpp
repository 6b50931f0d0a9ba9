#include "engine/solvers/row_problem.h"

#include <algorithm>
#include <utility>

#include "engine/index.h"

namespace sheave {

void RowProblem::fill_slots(const Substep& substep) {
  assembled_ = false;
  const Coordinates& coordinates = substep.bodies.coordinates();
  levers_ = coordinates.levers();
  turns_ = coordinates.turns();
  if (slots_.fill(coordinates, rows_, substep.moving)) {
    active_set_.analyse(slots_.unknown_count(), slots_.entries());
  }
}

void RowProblem::make_groups() {
  const std::size_t rows = rows_.size();
  groups_.resize(rows);
  group_of_.resize(rows);
  problem_.symmetric = symmetric_rows_;
  double heaviest = 0.0;  // of the group's rows so far
  std::size_t n = 0;
  told_ = has_all_rows_;
  for (std::size_t i = 0; i < rows; ++i) {
    const Row& row = rows_[i];
    if (!row.tied) groups_[n++] = {static_cast<int>(i), 0, 0.0, 1.0, false, row.lever};
    Group& group = groups_[n - 1];
    ++group.row_count;
    group.elastic = group.elastic || row.compliance > 0.0;
    told_ = told_ && row.told;
    group_of_[i] = static_cast<int>(n) - 1;
    // The row with the largest weight determines the unknown most accurately.
    if (group.row_count == 1 || row.weight > heaviest) {
      heaviest = row.weight;
      group.multiplier = heaviest == 1.0 ? previous_[i] : previous_[i] / heaviest;
    }
    problem_.symmetric = problem_.symmetric && row.weight == 1.0;
  }
  groups_.resize(n);
  problem_.size = static_cast<int>(n);
  problem_.constant.assign(n, 0.0);
  problem_.diagonal.assign(n, 0.0);
  assembled_ = false;
  problem_.lower.resize(n);
  problem_.upper.resize(n);
  problem_.free.resize(n);
}

void RowProblem::count_motion() {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    problem_.constant[g] += slots_.along(static_cast<int>(g), motion_.data());
  }
}

double RowProblem::yield(std::size_t g) const {
  const Group& group = groups_[g];
  double sum = problem_.diagonal[g];
  for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
    sum += rows_[at(i)].weight * slots_.yield(i);
  }
  return sum;
}

bool RowProblem::solve(Substep& substep, bool compromise) {
  assemble();
  bool solved = solve_assembled(substep, compromise);
  redundant_part_.clear();
  if (active_set_.dropped() > 0) active_set_.find_redundant_parts(problem_, redundant_part_);
  note_redundant_rows();
  shares_load_ = solved && !redundant_part_.empty() && !active_set_.contradicts() && share_load();
  if (shares_load_) {
    active_set_.forgive_redundant(problem_);
    solved = solve_assembled(substep, compromise);
  }
  StepStatistics& statistics = substep.statistics;
  ++statistics.rounds;
  statistics.row_solves += static_cast<std::int64_t>(rows_.size());
  if (active_set_.gave_way()) ++statistics.compromises;
  return solved;
}

bool RowProblem::solve_assembled(Substep& substep, bool compromise) {
  const bool solved = active_set_.solve(problem_, compromise, &substep.work);
  StepStatistics& statistics = substep.statistics;
  statistics.set_changes += active_set_.changes();
  statistics.factorisations += active_set_.factorisations();
  statistics.redundant_rows = std::max(statistics.redundant_rows, active_set_.dropped());
  return solved;
}

void RowProblem::relax(Substep& substep, int sweeps) {
  assemble();
  active_set_.relax(problem_, sweeps, &substep.work);
  ++substep.statistics.rounds;
  substep.statistics.row_solves += static_cast<std::int64_t>(rows_.size()) * sweeps;
}

void RowProblem::assemble() {
  // Damping multiplies a row's gradient by 1 + g, and S of its group divides by the same factor, so
  // A contains neither. Sweeps that follow a failed solution use the matrix as it is.
  if (assembled_) return;
  assembled_ = true;
  slots_.assemble(problem_.symmetric);
  const std::span<const double> diagonal = slots_.diagonal();
  for (std::size_t g = 0; g < diagonal.size(); ++g) problem_.diagonal[g] += diagonal[g];
  problem_.values = slots_.above();
  if (!problem_.symmetric) problem_.lower_values = slots_.below();
}

void RowProblem::take_rows(RowProblem& positions) {
  std::swap(rows_, positions.rows_);
  std::swap(starts_, positions.starts_);
  feature_rows_ = positions.feature_rows_;
  previous_ = positions.previous_;
  shared_ = positions.shared_;
  rounding_ = positions.rounding_;
}

void RowProblem::note_redundant_rows() {
  redundant_rows_.clear();
  if (redundant_part_.empty()) return;
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      if (redundant_part_[at(group_of_[at(i)])] == 0) continue;
      redundant_rows_.emplace_back(static_cast<int>(f), rows_[at(i)].index);
    }
  }
  std::sort(redundant_rows_.begin(), redundant_rows_.end());
}

void RowProblem::take_redundant_parts(const RowProblem& positions) {
  redundant_part_.clear();
  const auto& redundant = positions.redundant_rows_;
  if (redundant.empty()) return;
  redundant_part_.assign(groups_.size(), 0);
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const std::pair row(static_cast<int>(f), rows_[at(i)].index);
      if (!std::binary_search(redundant.begin(), redundant.end(), row)) continue;
      redundant_part_[at(group_of_[at(i)])] = 1;
    }
  }
}

void RowProblem::turn_as_in(const RowProblem& positions) {
  for (std::size_t s = 0; s < shared_.size(); ++s) {
    const SharedFriction& turned = shared_[s];
    const SharedFriction& before = positions.shared_[s];
    for (int k = 0; k < turned.count; ++k) {
      const auto row = at(turned.first_row + k);
      previous_[row] = positions.previous_[row];
      if (k > 0) rows_[row].softness += before.softness - turned.softness;
    }
  }
  shared_ = positions.shared_;
}

}  // namespace sheave
