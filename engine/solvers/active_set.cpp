#include "engine/solvers/active_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/index.h"

namespace sheave {

namespace {

constexpr int patience = 3;  // block changes without progress

/// Whether an unknown that is not free is at its lower bound.
bool is_at_lower(const ComplementarityProblem& problem, std::size_t i) {
  return std::isfinite(problem.lower[i]) && problem.free[i] != ComplementarityProblem::at_upper;
}

}  // namespace

void ActiveSetSolver::analyse(int size, std::span<const std::pair<int, int>> entries) {
  entries_.assign(entries.begin(), entries.end());
  factor_.analyse(size, entries);
  neighbour_start_.assign(at(size) + 1, 0);
  for (const auto& [i, j] : entries_) {
    ++neighbour_start_[at(i) + 1];
    ++neighbour_start_[at(j) + 1];
  }
  std::partial_sum(neighbour_start_.begin(), neighbour_start_.end(), neighbour_start_.begin());
  neighbours_.resize(2 * entries_.size());
  std::vector<int> next = neighbour_start_;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    neighbours_[at(next[at(i)]++)] = {j, static_cast<int>(e), false};
    neighbours_[at(next[at(j)]++)] = {i, static_cast<int>(e), true};
  }
}

void ActiveSetSolver::relax(const ComplementarityProblem& problem, int sweeps, WorkLimit* work) {
  changes_ = dropped_ = 0;
  solution_.assign(at(problem.size), 0.0);
  for (std::size_t i = 0; i < solution_.size(); ++i) {
    solution_[i] = std::clamp(0.0, problem.lower[i], problem.upper[i]);
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (work != nullptr && work->stops()) return;
    for (std::size_t i = 0; i < solution_.size(); ++i) {
      if (!(problem.diagonal[i] > 0.0)) continue;
      const double residual = residual_of(problem, i);
      solution_[i] = std::clamp(solution_[i] - residual / problem.diagonal[i], problem.lower[i],
                                problem.upper[i]);
    }
  }
}

bool ActiveSetSolver::solve(ComplementarityProblem& problem, bool compromise, WorkLimit* work) {
  changes_ = dropped_ = factorisations_ = 0;
  contradicts_ = gave_way_ = false;
  Course course{problem.size + 1, patience, false};
  const int most_tries = 50 + 2 * problem.size;
  for (int tries = 0; tries < most_tries; ++tries) {
    if (repeats(problem, tries, course)) return false;
    if (work != nullptr && !work->take_factorisation()) return false;
    ++factorisations_;
    if (attempt(problem, compromise, course)) return true;
  }
  return false;
}

bool ActiveSetSolver::repeats(const ComplementarityProblem& problem, int tries, const Course& now) {
  // Brent's algorithm: the sets of tries 1, 2, 4, 8 ... are kept, and later sets are compared with
  // the last one kept.
  if (tries == 0) return false;
  if ((tries & (tries - 1)) != 0) return now == kept_course_ && problem.free == kept_set_;
  kept_set_ = problem.free;
  kept_course_ = now;
  return false;
}

bool ActiveSetSolver::attempt(ComplementarityProblem& problem, bool compromise, Course& course) {
  solve_free(problem);
  if (course.yields) find_compromise(problem);
  mark_violations(problem);
  // Also if the same violations return in every try: a violation that is caused by a redundant row
  // without its share of the load points to the wrong bound.
  if (!course.yields && (violated_.empty() || course.left < 0)) {
    contradicts_ = false;
    const int blocking = blocking_unknown(problem, !violated_.empty());
    if (blocking >= 0) {
      problem.free[at(blocking)] = blocked_above_ ? ComplementarityProblem::at_upper : 0;
      ++changes_;
      course.fewest = problem.size + 1;
      return false;
    }
    if (!violated_.empty() && !contradicts_ && takes_back_share(problem)) return true;
    if (violated_.empty() && (!compromise || !contradicts_)) return true;
    // Contradicting rows can also make the same violations return without end.
    if (contradicts_ && (compromise || !violated_.empty())) {
      course = {problem.size + 1, patience, true};
      gave_way_ = true;
      return false;
    }
  }
  if (violated_.empty()) return true;
  change_sides(problem, course);
  return false;
}

void ActiveSetSolver::change_sides(ComplementarityProblem& problem, Course& course) {
  const auto count = static_cast<int>(violated_.size());
  if (count < course.fewest) {
    course.fewest = count;
    course.left = patience;
  } else {
    course.left = std::max(course.left - 1, -1);
  }
  if (course.left < 0) violated_ = {violated_.back()};
  for (const int i : violated_) {
    char& side = problem.free[at(i)];
    if (side != 1) {
      side = 1;
    } else {
      side = solution_[at(i)] < problem.lower[at(i)] ? 0 : ComplementarityProblem::at_upper;
    }
  }
  changes_ += static_cast<int>(violated_.size());
}

void ActiveSetSolver::spread(const ComplementarityProblem& problem, std::size_t i, double moved,
                             std::span<double> rhs) const {
  for (int p = neighbour_start_[i]; p < neighbour_start_[i + 1]; ++p) {
    const Neighbour& neighbour = neighbours_[at(p)];
    if (problem.free[at(neighbour.other)] != 1) continue;
    const bool below = !neighbour.transposed && !problem.symmetric;
    const std::vector<double>& values = below ? problem.lower_values : problem.values;
    rhs[at(neighbour.other)] -= values[at(neighbour.entry)] * moved;
  }
}

void ActiveSetSolver::solve_free(const ComplementarityProblem& problem) {
  const std::size_t n = at(problem.size);
  solution_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    solution_[i] = problem.free[i] == 1      ? -problem.constant[i]
                   : is_at_lower(problem, i) ? problem.lower[i]
                                             : problem.upper[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (problem.free[i] != 1 && solution_[i] != 0.0) spread(problem, i, solution_[i], solution_);
  }
  factor_.select(problem.free, 1);
  if (problem.symmetric) {
    factor_.factor(problem.diagonal, problem.values);
  } else {
    factor_.factor(problem.diagonal, problem.values, problem.lower_values);
  }
  dropped_ = factor_.dropped();
  factor_.solve(solution_);
  find_residuals(problem);
}

bool ActiveSetSolver::refine(const ComplementarityProblem& problem, std::span<const double> change,
                             bool last) {
  const std::size_t n = at(problem.size);
  refined_.resize(n);
  for (std::size_t i = 0; i < n; ++i) refined_[i] = problem.free[i] == 1 ? -change[i] : 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (problem.free[i] == 1) continue;
    const double moved =
        (is_at_lower(problem, i) ? problem.lower[i] : problem.upper[i]) - solution_[i];
    if (moved == 0.0) continue;
    refined_[i] = moved;
    spread(problem, i, moved, refined_);
  }
  factor_.solve(refined_);
  for (std::size_t i = 0; i < n; ++i) refined_[i] += solution_[i];
  solution_.swap(refined_);
  for (std::size_t i = 0; i < n; ++i) {
    double broken = 0.0;
    if (problem.free[i] == 1) {
      if (solution_[i] >= problem.lower[i] && solution_[i] <= problem.upper[i]) continue;
      broken = problem.diagonal[i] *
               std::max(problem.lower[i] - solution_[i], solution_[i] - problem.upper[i]);
    } else if (last && problem.lower[i] != problem.upper[i]) {
      const double residual = residual_of(problem, i);
      broken = is_at_lower(problem, i) ? -residual : residual;
    }
    if (!(broken > 0.0 && broken > noise(problem, i))) continue;
    solution_.swap(refined_);
    return false;
  }
  return true;
}

double ActiveSetSolver::residual_of(const ComplementarityProblem& problem, std::size_t i) const {
  double residual = problem.constant[i] + problem.diagonal[i] * solution_[i];
  for (int p = neighbour_start_[i]; p < neighbour_start_[i + 1]; ++p) {
    const Neighbour& neighbour = neighbours_[at(p)];
    const bool below = neighbour.transposed && !problem.symmetric;
    const std::vector<double>& values = below ? problem.lower_values : problem.values;
    residual += values[at(neighbour.entry)] * solution_[at(neighbour.other)];
  }
  return residual;
}

void ActiveSetSolver::find_compromise(const ComplementarityProblem& problem) {
  constexpr double softness = 1e-6;
  const std::size_t n = at(problem.size);
  softened_.resize(n);
  for (std::size_t i = 0; i < n; ++i) softened_[i] = (1.0 + softness) * problem.diagonal[i];
  if (problem.symmetric) {
    factor_.factor(softened_, problem.values);
  } else {
    factor_.factor(softened_, problem.values, problem.lower_values);
  }
  // The right-hand side of the free rows, then A B^-1 times this vector, in `null_vector_`.
  std::vector<double>& rhs = null_vector_;
  rhs.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (problem.free[i] == 1) rhs[i] = -problem.constant[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (problem.free[i] != 1 && solution_[i] != 0.0) spread(problem, i, solution_[i], rhs);
  }
  factor_.solve(rhs);
  for (std::size_t i = 0; i < n; ++i) residual_[i] = problem.diagonal[i] * rhs[i];
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    if (problem.free[at(i)] != 1 || problem.free[at(j)] != 1) continue;
    residual_[at(i)] += problem.values[e] * rhs[at(j)];
    const double below = problem.symmetric ? problem.values[e] : problem.lower_values[e];
    residual_[at(j)] += below * rhs[at(i)];
  }
  factor_.solve(residual_);
  for (std::size_t i = 0; i < n; ++i) {
    if (problem.free[i] == 1) solution_[i] = residual_[i];
  }
  find_residuals(problem);
}

void ActiveSetSolver::find_residuals(const ComplementarityProblem& problem) {
  // r = c + A dl; 0 for rows that the factors satisfy, and for rows whose residual may be anything.
  const std::size_t n = at(problem.size);
  residual_.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool found = problem.free[i] == 1 ? dropped_ == 0 : problem.lower[i] == problem.upper[i];
    if (found) continue;
    residual_[i] = residual_of(problem, i);
  }
}

void ActiveSetSolver::find_redundant_parts(const ComplementarityProblem& problem,
                                           std::vector<char>& part) {
  // Components of the size of rounding take no part.
  constexpr double still = 1e-7;
  part.clear();
  for (int j = 0; j < problem.size && dropped_ > 0; ++j) {
    // A row that moves no body is dropped, too, but not because of other rows.
    const double own = problem.diagonal[at(j)];
    if (problem.free[at(j)] != 1 || !factor_.is_dropped(j) || !(own > 0.0)) continue;
    part.resize(at(problem.size), 0);
    find_null_vector(problem, j);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const double z = null_vector_[i];
      if (z * z * problem.diagonal[i] > still * still * own) part[i] = 1;
    }
  }
}

void ActiveSetSolver::forgive_redundant(ComplementarityProblem& problem) const {
  for (int j = 0; j < problem.size; ++j) {
    if (problem.free[at(j)] != 1 || !factor_.is_dropped(j)) continue;
    problem.constant[at(j)] -= residual_[at(j)];
  }
}

int ActiveSetSolver::blocking_unknown(const ComplementarityProblem& problem, bool going_round) {
  if (dropped_ == 0) return -1;
  double largest = 0.0;
  for (const double constant : problem.constant) largest = std::max(largest, std::abs(constant));
  for (int j = 0; j < problem.size; ++j) {
    if (problem.free[at(j)] != 1 || !factor_.is_dropped(j)) continue;
    const double off = std::abs(residual_[at(j)]);
    const double hidden = noise(problem, at(j));
    if (!(off > hidden)) continue;
    find_null_vector(problem, j);
    // A residual within the agreement counts only in one case: the same violations return in every
    // try, and friction takes part in the null vector. Such friction acts on a coordinate that
    // locks hold. Its residual at a bound, however small, shows that the other bound is the right
    // one.
    const bool tells = going_round && shares_with_friction(problem);
    if (!tells && !(off > agreement(problem, largest))) continue;
    const int blocking = first_blocked(problem, j, residual_[at(j)] < 0.0 ? 1.0 : -1.0);
    if (blocking >= 0) return blocking;
    contradicts_ = true;
  }
  return -1;
}

void ActiveSetSolver::find_null_vector(const ComplementarityProblem& problem, int redundant) {
  // A z = 0 with z_j = 1; unknowns that are not free have the equation z = 0.
  const std::size_t j = at(redundant);
  null_vector_.assign(at(problem.size), 0.0);
  for (int p = neighbour_start_[j]; p < neighbour_start_[j + 1]; ++p) {
    const Neighbour& neighbour = neighbours_[at(p)];
    if (problem.free[at(neighbour.other)] != 1) continue;
    // Column j: the entry's place in row j is (j, other), its mirror image is (other, j).
    const bool below = !neighbour.transposed && !problem.symmetric;
    const std::vector<double>& values = below ? problem.lower_values : problem.values;
    null_vector_[at(neighbour.other)] = -values[at(neighbour.entry)];
  }
  factor_.solve(null_vector_);
  null_vector_[j] = 1.0;
}

double ActiveSetSolver::agreement(const ComplementarityProblem& problem, double largest) const {
  // As A z = 0, the residual is the sum of z_i c_i. The allowed residual contains the rounding of
  // each c and the regularisation of rows that share a load (engine/solvers/row_sharing.cpp), but
  // no more than the tolerance of Newton's rounds.
  constexpr double share = 1e-9;
  constexpr double most = 1e4;  // DirectSolver::tolerance over RowSystem::value_rounding
  double rounded = 0.0;
  for (std::size_t i = 0; i < null_vector_.size(); ++i) {
    const double z = std::abs(null_vector_[i]);
    rounded += z * problem.rounding;
    largest = std::max(largest, z * std::abs(problem.diagonal[i] * solution_[i]));
  }
  return std::min(rounded + share * largest, most * problem.rounding);
}

bool ActiveSetSolver::shares_with_friction(const ComplementarityProblem& problem) const {
  constexpr double still = 1e-9;
  for (std::size_t i = 0; i < null_vector_.size(); ++i) {
    const bool bounded = std::isfinite(problem.lower[i]) && std::isfinite(problem.upper[i]);
    if (bounded && std::abs(null_vector_[i]) > still) return true;
  }
  return false;
}

bool ActiveSetSolver::takes_back_share(const ComplementarityProblem& problem) {
  constexpr double still = 1e-9;
  for (int j = 0; j < problem.size && dropped_ > 0; ++j) {
    if (problem.free[at(j)] != 1 || !factor_.is_dropped(j)) continue;
    find_null_vector(problem, j);
    for (const int i : violated_) {
      const double rate = null_vector_[at(i)];
      if (problem.free[at(i)] != 1 || !(std::abs(rate) > still)) continue;
      const double bound = std::clamp(solution_[at(i)], problem.lower[at(i)], problem.upper[at(i)]);
      const double way = (bound - solution_[at(i)]) / rate;
      for (std::size_t k = 0; k < solution_.size(); ++k) solution_[k] += way * null_vector_[k];
      solution_[at(i)] = bound;
    }
    mark_violations(problem);
    if (violated_.empty()) return true;
  }
  return false;
}

int ActiveSetSolver::first_blocked(const ComplementarityProblem& problem, int redundant,
                                   double direction) {
  // Components of the size of rounding do not move.
  constexpr double still = 1e-9;
  int blocked = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < problem.size; ++i) {
    const double rate = direction * null_vector_[at(i)];
    if (problem.free[at(i)] != 1 || !(std::abs(rate) > still)) continue;
    const bool above = rate > 0.0;
    const double bound = !above ? problem.lower[at(i)] : problem.upper[at(i)];
    const double way = (bound - solution_[at(i)]) / rate;
    // If several unknowns are blocked at the same distance, one of the others goes to its bound and
    // the redundant one stays free, as its row requires.
    if (way < nearest || (way == nearest && blocked == redundant)) {
      nearest = way;
      blocked = i;
      blocked_above_ = above;
    }
  }
  return blocked;
}

double ActiveSetSolver::noise(const ComplementarityProblem& problem, std::size_t i) const {
  // The bound is per row, because one problem may have rows in metres and in radians, of a part of
  // 1e-6 m and of a crane.
  constexpr double rounding = 1e-13;
  double terms = std::abs(problem.constant[i]) + std::abs(problem.diagonal[i] * solution_[i]);
  for (int p = neighbour_start_[i]; p < neighbour_start_[i + 1]; ++p) {
    const Neighbour& neighbour = neighbours_[at(p)];
    const bool below = neighbour.transposed && !problem.symmetric;
    const std::vector<double>& values = below ? problem.lower_values : problem.values;
    terms += std::abs(values[at(neighbour.entry)] * solution_[at(neighbour.other)]);
  }
  return problem.rounding + rounding * terms;
}

void ActiveSetSolver::mark_violations(const ComplementarityProblem& problem) {
  violated_.clear();
  for (int i = 0; i < problem.size; ++i) {
    const std::size_t k = at(i);
    if (problem.lower[k] == problem.upper[k]) continue;
    // Violation of the row's condition, in the unit of c. A violation of the size of rounding does
    // not count.
    double broken = 0.0;
    if (problem.free[k] == 1) {
      const double outside =
          std::max(problem.lower[k] - solution_[k], solution_[k] - problem.upper[k]);
      broken = outside > 0.0 && !(problem.diagonal[k] > 0.0)
                   ? std::numeric_limits<double>::infinity()
                   : outside * problem.diagonal[k];
    } else {
      broken = is_at_lower(problem, k) ? -residual_[k] : residual_[k];
    }
    if (broken > 0.0 && broken > noise(problem, k)) violated_.push_back(i);
  }
}

}  // namespace sheave
