// The matrix of engine/solvers/row_system.h: which rows couple, found once per pattern, and by how much.

#include <cmath>
#include <map>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {

void RowSystem::find_pattern(const Substep& substep) {
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

double RowSystem::coupling(const Substep& substep, Touch gradient, Touch motion) const {
  const RowTerm& term = rows_[at(gradient.row)].terms[at(gradient.term)];
  const RowResponse& response = responses_[at(motion.row)];
  const MovingBody& body = substep.moving[at(term.body)];
  double sum = 0.0;
  if (body.translates) sum += dot(term.linear, response.linear[at(motion.term)]);
  if (body.rotates) sum += dot(term.angular, response.angular[at(motion.term)]);
  return sum;
}

void RowSystem::assemble(const Substep& substep) {
  // The factor 1 + g that damping gives a row's gradient is that of its group's S, so A has neither.
  problem_.values.assign(entries_.size(), 0.0);
  // What rounding leaves where the rows of a group cancel (nothing but a wheel that the cable slides over can move) is no
  // yield: such a group keeps its unknown.
  own_yield_.assign(groups_.size(), 0.0);
  const auto add_own_yield = [&](const Coupling& c, double value) {
    if (c.first.row != c.second.row || c.first.term != c.second.term) return;
    own_yield_[at(group_of_[at(c.first.row)])] += std::abs(value);
  };
  const auto drop_cancelled = [&] {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      constexpr double rounding = 1e-13;
      if (problem_.diagonal[g] < rounding * own_yield_[g]) problem_.diagonal[g] = 0.0;
    }
  };
  if (problem_.symmetric) {
    for (const Coupling& c : couplings_) {
      const double value = coupling(substep, c.first, c.second);
      if (c.entry >= 0) {
        problem_.values[at(c.entry)] += value;
      } else {
        add_own_yield(c, value);
        // The two orders of a pair within one group.
        problem_.diagonal[at(-1 - c.entry)] += c.first.row == c.second.row ? value : 2.0 * value;
      }
    }
    drop_cancelled();
    return;
  }
  problem_.lower_values.assign(entries_.size(), 0.0);
  const auto weighted = [&](Touch gradient, Touch motion) {
    return rows_[at(motion.row)].weight * coupling(substep, gradient, motion);
  };
  for (const Coupling& c : couplings_) {
    const double unweighted = coupling(substep, c.first, c.second);
    const double value = rows_[at(c.second.row)].weight * unweighted;
    if (c.entry >= 0) {
      problem_.values[at(c.entry)] += value;
      problem_.lower_values[at(c.entry)] += weighted(c.second, c.first);
    } else {
      add_own_yield(c, unweighted);
      double& diagonal = problem_.diagonal[at(-1 - c.entry)];
      diagonal += value;
      if (c.first.row != c.second.row) diagonal += weighted(c.second, c.first);
    }
  }
  drop_cancelled();
}

}  // namespace sheave
