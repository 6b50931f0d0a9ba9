#include "engine/solvers/direct.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/index.h"
#include "engine/solvers/gauss_seidel.h"

namespace sheave {

void DirectSolver::solve(Substep& substep,
                         std::span<const std::unique_ptr<ConstraintBatch>> features) {
  StepStatistics& statistics = substep.statistics;
  const double enough = tolerance * substep.bodies.scale();
  double violated = 0.0;
  bool revised = false;
  for (int round = 0; round < substep.iterations; ++round) {
    linearise(substep, features);
    make_groups(substep);
    violated = violation();
    if (round > 0 && !revised && violated <= enough) break;
    find_pattern(substep);
    assemble(substep);
    ++statistics.rounds;
    statistics.row_solves += static_cast<std::int64_t>(rows_.size());
    const bool solved = active_set_.solve(problem_);
    statistics.set_changes += active_set_.changes();
    statistics.redundant_rows = std::max(statistics.redundant_rows, active_set_.dropped());
    if (!solved) {
      ++statistics.solver_fallbacks;
      solve_gauss_seidel(substep, features);
      return;
    }
    apply(substep, features);
    revised = false;
    // What the last round finds would have no round to act in; the features decide it for the next substep.
    if (round + 1 == substep.iterations) break;
    for (const auto& feature : features) revised = feature->revise(substep) || revised;
  }
  statistics.rows = static_cast<int>(rows_.size());
  statistics.last_correction = std::max(statistics.last_correction, violated);
}

void DirectSolver::linearise(Substep& substep,
                             std::span<const std::unique_ptr<ConstraintBatch>> features) {
  rows_.clear();
  feature_rows_.clear();
  for (const auto& feature : features) {
    feature_rows_.push_back(static_cast<int>(rows_.size()));
    feature->linearise(substep, rows_);
  }
  feature_rows_.push_back(static_cast<int>(rows_.size()));
  responses_.resize(rows_.size());
  previous_.resize(rows_.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<const double> multipliers = features[f]->multipliers();
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      previous_[at(i)] = multipliers[at(rows_[at(i)].index)];
    }
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) respond(rows_[i], substep.moving, responses_[i]);
}

void DirectSolver::make_groups(const Substep& substep) {
  groups_.clear();
  group_of_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!rows_[i].tied) groups_.push_back({static_cast<int>(i), 0, 0.0, 1.0});
    Group& group = groups_.back();
    ++group.row_count;
    group_of_[i] = static_cast<int>(groups_.size()) - 1;
    // The heaviest row tells the unknown best.
    if (rows_[i].weight == 1.0) group.multiplier = previous_[i];
  }
  const std::size_t n = groups_.size();
  problem_.size = static_cast<int>(n);
  problem_.symmetric = true;
  problem_.constant.assign(n, 0.0);
  problem_.lower.resize(n);
  problem_.upper.resize(n);
  problem_.free.resize(n);
  const double inverse_square = 1.0 / (substep.h * substep.h);
  problem_.diagonal.assign(n, 0.0);
  for (std::size_t g = 0; g < n; ++g) {
    Group& group = groups_[g];
    const Row& first = rows_[at(group.first_row)];
    double value = 0.0;
    double compliance = 0.0;
    double stiffest = std::numeric_limits<double>::infinity();
    double softest = 0.0;
    bool active = false;
    for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
      const Row& row = rows_[at(i)];
      const double gamma = row.compliance * row.damping / substep.h;
      value += row.value;
      if (gamma > 0.0) value += gamma * substep_change(row, substep.moving);
      compliance += row.weight * row.compliance * inverse_square;
      stiffest = std::min(stiffest, gamma);
      softest = std::max(softest, gamma);
      active = active || row.active;
      problem_.symmetric = problem_.symmetric && row.weight == 1.0;
    }
    problem_.symmetric = problem_.symmetric && stiffest == softest;
    group.scale = 1.0 / (1.0 + softest);
    problem_.diagonal[g] = group.scale * compliance;
    problem_.constant[g] = group.scale * (value + compliance * group.multiplier);
    problem_.lower[g] = first.lower - group.multiplier;
    problem_.upper[g] = first.upper - group.multiplier;
    const bool bilateral = !std::isfinite(first.lower) && !std::isfinite(first.upper);
    const bool pushed = std::isfinite(first.lower) ? value < 0.0 : value > 0.0;
    problem_.free[g] = bilateral || active || pushed || group.multiplier != 0.0 ? 1 : 0;
  }
  settle_weights(substep);
}

void DirectSolver::settle_weights(const Substep& substep) {
  mismatch_.resize(rows_.size());
  bool any = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    mismatch_[i] = rows_[i].weight * groups_[at(group_of_[i])].multiplier - previous_[i];
    any = any || mismatch_[i] != 0.0;
  }
  if (!any) return;
  // When a cable begins to slide its multipliers do not have their ratio yet; what that takes moves the bodies.
  motion_.assign(substep.moving.size(), RowTerm{});
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (std::size_t t = 0; t < at(rows_[i].term_count); ++t) {
      const MovingBody& body = substep.moving[at(rows_[i].terms[t].body)];
      RowTerm& motion = motion_[at(rows_[i].terms[t].body)];
      if (body.translates) motion.linear += mismatch_[i] * responses_[i].linear[t];
      if (body.rotates) motion.angular += mismatch_[i] * responses_[i].angular[t];
    }
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto g = at(group_of_[i]);
    const double gamma = rows_[i].compliance * rows_[i].damping / substep.h;
    for (const RowTerm& term : rows_[i].active_terms()) {
      const RowTerm& motion = motion_[at(term.body)];
      problem_.constant[g] += groups_[g].scale * (1.0 + gamma) *
                              (dot(term.linear, motion.linear) + dot(term.angular, motion.angular));
    }
  }
}

double DirectSolver::violation() const {
  double worst = 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double r = problem_.constant[g];
    const bool at_lower = !(problem_.lower[g] < 0.0);
    const bool at_upper = !(problem_.upper[g] > 0.0);
    if ((at_lower && r > 0.0) || (at_upper && r < 0.0)) continue;
    worst = std::max(worst, std::abs(r) / groups_[g].scale);
  }
  return worst;
}

void DirectSolver::find_pattern(const Substep& substep) {
  new_signature_.clear();
  for (const Row& row : rows_) {
    new_signature_.push_back(row.tied ? -2 : -1);
    for (const RowTerm& term : row.active_terms()) new_signature_.push_back(term.body);
  }
  if (new_signature_ == signature_) return;
  signature_ = new_signature_;
  std::vector<std::vector<Touch>> touches(substep.moving.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (int t = 0; t < rows_[i].term_count; ++t) {
      const int body = rows_[i].terms[at(t)].body;
      const MovingBody& moving = substep.moving[at(body)];
      if (moving.translates || moving.rotates) {
        touches[at(body)].push_back({static_cast<int>(i), t});
      }
    }
  }
  entries_.clear();
  couplings_.clear();
  std::map<std::pair<int, int>, int> entry_of;
  for (const std::vector<Touch>& of_body : touches) {
    for (std::size_t a = 0; a < of_body.size(); ++a) {
      for (std::size_t b = a; b < of_body.size(); ++b) {
        const int first = group_of_[at(of_body[a].row)];
        const int second = group_of_[at(of_body[b].row)];
        int entry = -1 - first;
        if (first != second) {
          const auto found =
              entry_of.try_emplace({first, second}, static_cast<int>(entries_.size()));
          if (found.second) entries_.emplace_back(first, second);
          entry = found.first->second;
        }
        couplings_.push_back({entry, of_body[a], of_body[b]});
      }
    }
  }
  active_set_.analyse(static_cast<int>(groups_.size()), entries_);
}

double DirectSolver::coupling(const Substep& substep, Touch of_gradient, Touch of_motion) const {
  const RowTerm& term = rows_[at(of_gradient.row)].terms[at(of_gradient.term)];
  const RowResponse& response = responses_[at(of_motion.row)];
  const MovingBody& body = substep.moving[at(term.body)];
  double sum = 0.0;
  if (body.translates) sum += dot(term.linear, response.linear[at(of_motion.term)]);
  if (body.rotates) sum += dot(term.angular, response.angular[at(of_motion.term)]);
  return sum;
}

void DirectSolver::assemble(const Substep& substep) {
  problem_.values.assign(entries_.size(), 0.0);
  if (problem_.symmetric) {
    for (const Coupling& c : couplings_) {
      const double value = coupling(substep, c.first, c.second);
      if (c.entry >= 0) {
        problem_.values[at(c.entry)] += value;
      } else {
        // The two orders of a pair within one group.
        problem_.diagonal[at(-1 - c.entry)] += c.first.row == c.second.row ? value : 2.0 * value;
      }
    }
    // Without weights only damping scales rows, and then it scales all of a row's group alike: (1 + g) S = 1.
    return;
  }
  problem_.lower_values.assign(entries_.size(), 0.0);
  const auto scaled = [&](Touch gradient, Touch motion) {
    const Row& row = rows_[at(gradient.row)];
    const double gamma = row.compliance * row.damping / substep.h;
    return groups_[at(group_of_[at(gradient.row)])].scale * (1.0 + gamma) *
           rows_[at(motion.row)].weight * coupling(substep, gradient, motion);
  };
  for (const Coupling& c : couplings_) {
    const double value = scaled(c.first, c.second);
    if (c.entry >= 0) {
      problem_.values[at(c.entry)] += value;
      problem_.lower_values[at(c.entry)] += scaled(c.second, c.first);
    } else {
      problem_.diagonal[at(-1 - c.entry)] += value;
      if (c.first.row != c.second.row) {
        problem_.diagonal[at(-1 - c.entry)] += scaled(c.second, c.first);
      }
    }
  }
}

void DirectSolver::apply(Substep& substep,
                         std::span<const std::unique_ptr<ConstraintBatch>> features) {
  motion_.assign(substep.moving.size(), RowTerm{});
  const std::span<const double> change = active_set_.solution();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<double> multipliers = features[f]->multipliers();
    for (int r = feature_rows_[f]; r < feature_rows_[f + 1]; ++r) {
      const auto i = at(r);
      const auto g = at(group_of_[i]);
      const double increment = rows_[i].weight * change[g] + mismatch_[i];
      // Set, not added to, so that rows with one unknown have one multiplier to the last bit.
      const double unknown =
          std::clamp(groups_[g].multiplier + change[g], rows_[at(groups_[g].first_row)].lower,
                     rows_[at(groups_[g].first_row)].upper);
      multipliers[at(rows_[i].index)] = rows_[i].weight * unknown;
      for (std::size_t t = 0; t < at(rows_[i].term_count); ++t) {
        const MovingBody& body = substep.moving[at(rows_[i].terms[t].body)];
        RowTerm& motion = motion_[at(rows_[i].terms[t].body)];
        if (body.translates) motion.linear += increment * responses_[i].linear[t];
        if (body.rotates) motion.angular += increment * responses_[i].angular[t];
      }
    }
  }
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    MovingBody& body = substep.moving[b];
    if (body.translates) body.position += motion_[b].linear;
    if (!body.rotates) continue;
    body.turn += motion_[b].angular;
    if (body.tracks_orientation) body.orientation = turned(body.orientation, motion_[b].angular);
  }
}

}  // namespace sheave
