#include "engine/solvers/affine_problem.h"

#include <algorithm>
#include <limits>

#include "engine/index.h"

namespace sheave {

void AffineProblem::analyse(int size, std::span<const std::pair<int, int>> entries) {
  entries_.assign(entries.begin(), entries.end());
  factor_.analyse(size, entries_);
  acting_diagonal_.resize(at(size));
  acting_couplings_.resize(entries_.size());
  factored_for_.assign(at(size), 0);
  regular_ = analysed_ = false;
}

void AffineProblem::set_matrix(std::span<const double> diagonal, std::span<const double> couplings,
                               std::span<const char> excluded) {
  diagonal_.assign(diagonal.begin(), diagonal.end());
  couplings_.assign(couplings.begin(), couplings.end());
  excluded_.assign(excluded.begin(), excluded.end());
  regular_ = false;
}

bool AffineProblem::factor(std::span<const char> acts) {
  if (regular_ && std::equal(acts.begin(), acts.end(), factored_for_.begin())) return true;
  std::copy(acts.begin(), acts.end(), factored_for_.begin());
  all_ = std::find(acts.begin(), acts.end(), 0) == acts.end();
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    acting_diagonal_[i] = takes_part(acts, static_cast<int>(i)) ? diagonal_[i] : 1.0;
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    acting_couplings_[e] = takes_part(acts, i) && takes_part(acts, j) ? couplings_[e] : 0.0;
  }
  factor_.factor(acting_diagonal_, acting_couplings_);
  regular_ = factor_.dropped() == 0;
  return regular_;
}

ComplementarityProblem& AffineProblem::posed() {
  const std::size_t n = diagonal_.size();
  if (!analysed_) search_.analyse(static_cast<int>(n), entries_);
  analysed_ = true;
  problem_.size = static_cast<int>(n);
  problem_.diagonal = diagonal_;
  problem_.values = couplings_;
  problem_.constant.resize(n);
  problem_.lower.assign(n, 0.0);
  problem_.upper.assign(n, std::numeric_limits<double>::infinity());
  problem_.free.resize(n);
  return problem_;
}

bool AffineProblem::search() {
  WorkLimit limit;
  limit.allow(most_factorisations);
  return search_.solve(problem_, false, &limit) && !search_.contradicts();
}

}  // namespace sheave
