#include "engine/solvers/affine_motion.h"

#include <algorithm>
#include <cmath>

#include "engine/solvers/direct.h"
#include "engine/solvers/row_system.h"

namespace sheave {

std::unique_ptr<AffineMotion> AffineMotion::create(const Model& model, const BodySet& bodies,
                                                   Features features) {
  if (model.step.solver != SolverKind::direct || features.empty()) return nullptr;
  std::optional<AffineBodies> moving = AffineBodies::of(bodies);
  if (!moving) return nullptr;
  std::unique_ptr<AffineMotion> motion(
      new AffineMotion(model, bodies, features, std::move(*moving)));
  if (!motion->append(features) || !motion->terms_.take(motion->rows_, motion->bodies_.count()))
    return nullptr;
  motion->find_matrix();
  return motion;
}

AffineMotion::AffineMotion(const Model& model, const BodySet& bodies, Features features,
                           AffineBodies moving)
    : settings_(model.step),
      features_(features),
      bodies_(std::move(moving)),
      rattle_(model.step.integrator == IntegratorKind::rattle),
      scale_(bodies.scale()) {}

bool AffineMotion::append(Features features) {
  affine_.resize(features.size());
  feature_rows_.resize(features.size());
  feature_counts_.resize(features.size());
  // Rows of the floor come after rows of cables. The rows of a cable that ends at a weight over the
  // floor then remain a chain.
  for (std::size_t f = features.size(); f-- > 0;) {
    ConstraintBatch& feature = *features[f];
    feature_rows_[f] = rows_.size();
    affine_[f] = dynamic_cast<AffineFeature*>(&feature);
    if (feature.corrects_velocities() || feature.is_stiff() || affine_[f] == nullptr ||
        !affine_[f]->append_affine(bodies_, rows_)) {
      return false;
    }
    feature_counts_[f] = rows_.size() - feature_rows_[f];
  }
  return true;
}

void AffineMotion::find_matrix() {
  const std::size_t n = rows_.size();
  for (std::vector<double>* values : {&start_shares_, &softness_, &diagonal_, &values_, &free_,
                                      &unknowns_, &multipliers_, &impulses_, &rates_}) {
    values->assign(n, 0.0);
  }
  for (std::vector<char>* flags : {&springs_, &active_, &found_, &closed_}) flags->assign(n, 0);
  going_on_.assign(bodies_.count(), 0.0);
  speeds_.assign(bodies_.count(), 0.0);
  first_.resize(features_.size());
  std::vector<std::vector<int>> touching(bodies_.count());
  for (std::size_t i = 0; i < n; ++i) {
    for (int p = rows_.starts()[i]; p < rows_.starts()[i + 1]; ++p) {
      touching[at(rows_.numbers()[at(p)])].push_back(static_cast<int>(i));
    }
    springs_[i] = rows_.compliance(i) > 0.0 ? 1 : 0;
    elastic_ = elastic_ || springs_[i] != 0;
  }
  for (const std::vector<int>& rows : touching) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = i + 1; j < rows.size(); ++j) entries_.emplace_back(rows[i], rows[j]);
    }
  }
  std::sort(entries_.begin(), entries_.end());
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  problem_.analyse(static_cast<int>(n), entries_);
  if (elastic_ && rattle_) rigid_.analyse(static_cast<int>(n), entries_);
}

void AffineMotion::prepare(const Substep& substep) {
  if (h_ == substep.h) return;
  h_ = substep.h;
  bodies_.prepare(h_, rattle_ ? 0.5 * h_ : h_);
  terms_.weigh(bodies_.yields());
  const std::size_t n = rows_.size();
  std::vector<double> weighed(bodies_.count(), 0.0);  // W J^T of one row
  std::vector<double> couplings(entries_.size());
  terms_.visit([&](const auto& terms) {
    std::size_t entry = 0;  // entries_ are in the order of the rows
    for (std::size_t i = 0; i < n; ++i) {
      terms.act(i, 1.0, weighed.data());
      diagonal_[i] = terms.along(i, weighed.data());
      for (; entry < entries_.size() && at(entries_[entry].first) == i; ++entry) {
        couplings[entry] = terms.along(at(entries_[entry].second), weighed.data());
      }
      for (int p = rows_.starts()[i]; p < rows_.starts()[i + 1]; ++p) {
        weighed[at(rows_.numbers()[at(p)])] = 0.0;
      }
    }
  });
  std::vector<double> soft_diagonal = diagonal_;
  for (std::size_t i = 0; i < n; ++i) {
    const double compliance = rows_.compliance(i);
    const double gamma = (rattle_ ? 2.0 : 1.0) * compliance * rows_.damping(i) / h_;
    const double scale = 1.0 / (1.0 + gamma);
    start_shares_[i] = compliance > 0.0 ? scale * ((rattle_ ? 1.0 : 0.0) - gamma) : 0.0;
    softness_[i] = scale * (rattle_ ? 4.0 : 1.0) * compliance / (h_ * h_);
    soft_diagonal[i] += softness_[i];
  }
  problem_.set_matrix(soft_diagonal, couplings, {});
  if (elastic_ && rattle_) rigid_.set_matrix(diagonal_, couplings, springs_);
}

bool AffineMotion::begin(AffineSubstep& own, const State& state) {
  for (std::size_t f = 0; f < features_.size(); ++f) {
    const std::size_t first = feature_rows_[f];
    const std::size_t count = feature_counts_[f];
    if (!affine_[f]->begin_affine(own, state.features[f], std::span(values_).subspan(first, count),
                                  std::span(active_).subspan(first, count))) {
      return false;
    }
  }
  return true;
}

void AffineMotion::find_free_values() {
  // For rigid rows the free value is the value itself.
  if (!elastic_) return free_.swap(values_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    free_[i] = values_[i] + start_shares_[i] * std::min(values_[i], 0.0);
  }
}

bool AffineMotion::keep_positions() {
  find_free_values();
  const bool all = all_act();
  if (!(all && problem_.factored_for_all()) && !problem_.factor(active_)) return false;
  find_shortfalls(terms_.gradients(), free_.data(), bodies_.motion().data(), unknowns_.data());
  for (std::size_t i = 0; i < rows_.size() && !all; ++i) {
    if (active_[i] == 0) unknowns_[i] = 0.0;
  }
  problem_.solve(unknowns_);
  return all ? act_and_check_all() : act_and_check(active_);
}

bool AffineMotion::act_and_check_all() {
  const std::size_t n = rows_.size();
  double* const motion = bodies_.motion().data();
  const double least = take_positive(n, unknowns_.data(), multipliers_.data());
  terms_.respond_to(multipliers_.data(), motion);
  left_ = largest_residual(terms_.gradients(), free_.data(), softness_.data(), multipliers_.data(),
                           motion, rates_.data());
  bool holds = left_ <= DirectSolver::tolerance * scale_;
  const double rounding = RowSystem::value_rounding * scale_;
  for (std::size_t i = 0; i < n && least < 0.0; ++i) {
    holds &= unknowns_[i] * diagonal_[i] >= -rounding;
  }
  return holds;
}

bool AffineMotion::act_and_check(std::span<const char> acts) {
  const double rounding = RowSystem::value_rounding * scale_;
  const double enough = DirectSolver::tolerance * scale_;
  bool holds = true;
  terms_.visit([&](const auto& terms) {
    double* const motion = bodies_.motion().data();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      holds &= unknowns_[i] * diagonal_[i] >= -rounding;
      const double multiplier = std::max(unknowns_[i], 0.0);
      multipliers_[i] = multiplier;
      terms.act(i, multiplier, motion);
    }
    left_ = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double residual = free_[i] + terms.along(i, motion) + softness_[i] * multipliers_[i];
      const bool acting = acts[i] != 0;
      holds &= residual >= (acting ? -enough : -rounding);
      holds &= !acting || residual <= enough;
      if (acting) left_ = std::max(left_, std::abs(residual));
    }
  });
  return holds;
}

bool AffineMotion::search_positions() {
  const double rounding = RowSystem::value_rounding * scale_;
  const std::size_t n = rows_.size();
  bodies_.go_straight(going_on_);
  ComplementarityProblem& posed = problem_.posed();
  posed.rounding = rounding;
  const std::vector<double>& values = elastic_ ? values_ : free_;
  // The search begins like the first round of engine/solvers/row_system.h.
  terms_.visit([&](const auto& terms) {
    for (std::size_t i = 0; i < n; ++i) {
      posed.constant[i] = free_[i] + terms.along(i, bodies_.motion().data());
      const double change = terms.along(i, going_on_.data());
      const double gamma = (rattle_ ? 2.0 : 1.0) * rows_.compliance(i) * rows_.damping(i) / h_;
      double value = values[i] + change;
      if (springs_[i] != 0) {
        value = rattle_ ? (1.0 + gamma) * value + (1.0 - gamma) * std::min(values[i], 0.0)
                        : value + gamma * (values[i] > 0.0 ? value : change);
      }
      posed.free[i] = active_[i] != 0 || value <= rounding ? 1 : 0;
    }
  });
  if (!problem_.search()) return false;
  count_search(problem_);
  redundant_ = problem_.found().dropped();
  const std::span<const double> solution = problem_.found().solution();
  std::copy(solution.begin(), solution.end(), unknowns_.begin());
  for (std::size_t i = 0; i < n; ++i) found_[i] = unknowns_[i] > 0.0 ? 1 : 0;
  if (!act_and_check(found_)) return false;
  active_.swap(found_);
  return true;
}

bool AffineMotion::crosses() {
  return terms_.visit([&](const auto& terms) {
    const double* const motion = bodies_.motion().data();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (springs_[i] == 0) continue;
      if ((values_[i] < 0.0) != (values_[i] + terms.along(i, motion) < 0.0)) return true;
    }
    return false;
  });
}

void AffineMotion::find_closed() {
  const double closed = DirectSolver::closed * scale_;
  const std::vector<double>& values = elastic_ ? values_ : free_;
  terms_.visit([&](const auto& terms) {
    const double* const motion = bodies_.motion().data();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      // An open row that closes in this substep may act.
      closed_[i] = springs_[i] == 0 &&
                           (multipliers_[i] > 0.0 || values[i] + terms.along(i, motion) <= closed)
                       ? 1
                       : 0;
    }
  });
}

bool AffineMotion::solve_velocities() {
  const double rate = 1.0 / h_;
  const std::span<double> speeds = bodies_.end_speeds();
  terms_.visit([&](const auto& terms) {
    for (std::size_t i = 0; i < rows_.size() && elastic_; ++i) {
      if (springs_[i] != 0) terms.act(i, rate * multipliers_[i], speeds.data());
    }
  });
  find_rates(terms_.gradients(), speeds.data(), rates_.data());
  std::copy(speeds.begin(), speeds.end(), speeds_.begin());
  if (!keep_velocities()) {
    std::copy(speeds_.begin(), speeds_.end(), speeds.begin());
    find_closed();
    if (!search_velocities()) return false;
  }
  for (std::size_t i = 0; i < rows_.size() && elastic_; ++i) {
    if (springs_[i] != 0) impulses_[i] = rate * multipliers_[i];
  }
  add_product(rows_.size(), h_, impulses_.data(), multipliers_.data());
  return true;
}

bool AffineMotion::keep_velocities() {
  const double rounding = RowSystem::value_rounding * scale_ / h_;
  const std::size_t n = rows_.size();
  if (redundant_ > 0) return false;
  const bool all = all_act();
  AffineProblem& problem = velocities();
  if (!(all && problem.factored_for_all()) && !problem.factor(active_)) return false;
  find_opposites(n, rates_.data(), impulses_.data());
  for (std::size_t i = 0; i < n && !(all && !elastic_); ++i) {
    if (active_[i] == 0 || springs_[i] != 0) impulses_[i] = 0.0;
  }
  problem.solve(impulses_);
  bool holds = true;
  if (take_positive(n, impulses_.data(), unknowns_.data()) < 0.0) {
    for (std::size_t i = 0; i < n; ++i) holds &= impulses_[i] * diagonal_[i] >= -rounding;
  }
  impulses_.swap(unknowns_);
  double* const speeds = bodies_.end_speeds().data();
  terms_.respond_to(impulses_.data(), speeds);
  if (all || !holds) return holds;
  find_closed();
  return terms_.visit([&](const auto& terms) {
    for (std::size_t i = 0; i < n; ++i) {
      if (closed_[i] == 0 || active_[i] != 0) continue;
      holds &= terms.along(i, speeds) >= -rounding;
    }
    return holds;
  });
}

bool AffineMotion::search_velocities() {
  const double rounding = RowSystem::value_rounding * scale_ / h_;
  const std::size_t n = rows_.size();
  double* const speeds = bodies_.end_speeds().data();
  ComplementarityProblem& posed = velocities().posed();
  posed.rounding = rounding;
  // Velocities do not determine forces in balance (a state of self-stress). The multipliers of the
  // positions are kept for such forces, as in engine/solvers/velocity_system.cpp.
  std::fill(impulses_.begin(), impulses_.end(), 0.0);
  return terms_.visit([&](const auto& terms) {
    for (std::size_t i = 0; i < n && redundant_ > 0; ++i) {
      if (closed_[i] == 0) continue;
      impulses_[i] = multipliers_[i] / h_;
      terms.act(i, impulses_[i], speeds);
    }
    for (std::size_t i = 0; i < n; ++i) {
      posed.constant[i] = terms.along(i, speeds);
      posed.lower[i] = -impulses_[i];
      if (closed_[i] == 0) posed.upper[i] = posed.lower[i] = 0.0;
      posed.free[i] = closed_[i] != 0 && multipliers_[i] > 0.0 ? 1 : 0;
    }
    if (!velocities().search()) return false;
    count_search(velocities());
    const std::span<const double> change = velocities().found().solution();
    for (std::size_t i = 0; i < n; ++i) {
      const double before = impulses_[i];
      impulses_[i] = closed_[i] != 0 ? std::max(before + change[i], 0.0) : 0.0;
      terms.act(i, impulses_[i] - before, speeds);
    }
    bool holds = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (closed_[i] == 0) continue;
      const double left = terms.along(i, speeds);
      // A row that acts may keep a residual of the size of rounding, as in act_and_check().
      const double enough = DirectSolver::tolerance * scale_ / h_;
      holds &= left >= (impulses_[i] > 0.0 ? -enough : -rounding);
      holds &= impulses_[i] == 0.0 || left <= enough;
    }
    return holds;
  });
}

void AffineMotion::count_search(const AffineProblem& problem) {
  changes_ += problem.found().changes();
  factorisations_ += problem.found().factorisations();
}

bool AffineMotion::attempt(const Interval& time, Place place, const State& state, State& next,
                           Substep& substep) {
  changes_ = factorisations_ = redundant_ = 0;
  const double loaded = rattle_ ? time.middle() : time.to;
  bodies_.predict(time.from, loaded, time.to);
  AffineSubstep own{time.to, h_,       bodies_.places(),    bodies_.speeds(), bodies_.motion(),
                    {},      !rattle_, &substep.statistics, place.fresh,      place.first};
  if (!begin(own, state)) return false;
  if (!keep_positions()) {
    bodies_.predict(time.from, loaded, time.to);
    if (!search_positions()) return false;
  }
  if (rattle_ && elastic_ && crosses()) return false;
  bodies_.derive();
  if (rattle_) {
    bodies_.add_loads(time.middle(), time.to);
    if (!solve_velocities()) return false;
  }
  return bodies_.arrive() && finish(own, state, next, substep.statistics);
}

bool AffineMotion::finish(AffineSubstep& own, const State& state, State& next,
                          StepStatistics& statistics) {
  for (std::size_t f = 0; f < features_.size(); ++f) {
    own.multipliers = std::span(multipliers_).subspan(feature_rows_[f], feature_counts_[f]);
    if (!affine_[f]->finish_affine(own, state.features[f], next.features[f])) return false;
  }
  statistics.last_correction = std::max(statistics.last_correction, left_);
  statistics.external_work += bodies_.work_of_set_loads();
  statistics.set_changes += changes_;
  statistics.factorisations += factorisations_;
  statistics.redundant_rows = std::max(statistics.redundant_rows, redundant_);
  return true;
}

int AffineMotion::advance(int first, int last, State& state, State& before, Substep& substep,
                          State* start) {
  if (!runs_free(state.controls) || substep.work.stops()) return 0;
  substep.h = settings_.dt / settings_.substeps;
  substep.load_share = rattle_ ? 0.5 : 1.0;
  prepare(substep);
  const bool fresh = !agree_;
  if (fresh) {
    before = state;
    // The stages may have written forces of rows that this class does not have.
    for (std::vector<double>& late : substep.late_forces) late.clear();
  }
  agree_ = true;
  before.memory = state.memory;
  if (!bodies_.load(state, !fresh)) return 0;
  for (std::size_t f = 0; f < first_.size() && start != nullptr && last - first > 1; ++f) {
    first_[f] = state.features[f].reals;
  }
  const double first_time = state.time;
  const double dt = settings_.dt;
  const auto substeps = static_cast<double>(settings_.substeps);
  int done = 0;
  for (int i = first; i < last; ++i, ++done) {
    if (done > 0 && i + 1 == last) bodies_.store_passed(before);
    const double end =
        (static_cast<double>(state.steps) + static_cast<double>(i + 1) / substeps) * dt;
    if (!attempt({state.time, end}, {fresh && done == 0, done == 0}, state, before, substep)) break;
    bodies_.go_on();
    bodies_.pass();
    state.features.swap(before.features);
    before.time = state.time;
    state.time = end;
  }
  if (done == 0) return 0;
  if (first + done < last) {
    if (start != nullptr) {
      *start = state;
      start->time = first_time;
      for (std::size_t f = 0; f < first_.size(); ++f) start->features[f].reals = first_[f];
    }
    bodies_.store_passed(state);
  } else {
    if (done == 1) state.bodies.swap(before.bodies);
    bodies_.store_passed(state);
  }
  before.steps = state.steps;
  keep_forces(substep);
  count(done, substep.statistics);
  return done;
}

bool AffineMotion::runs_free(const Controls& controls) {
  return !controls.cables_any() && !controls.motions.any() && !controls.joint_drives.any();
}

std::int64_t AffineMotion::leap(std::int64_t count, State& state, State& before, Substep& substep) {
  // With several substeps per step, a step that ends in its middle would have to be undone. Loads
  // of controls have to be read once per step.
  if (count <= 0 || !agree_ || settings_.substeps != 1 || !runs_free(state.controls) ||
      state.controls.has_gravity || state.controls.forces.any()) {
    return 0;
  }
  substep.h = settings_.dt;
  substep.load_share = rattle_ ? 0.5 : 1.0;
  prepare(substep);
  if (!bodies_.load(state, true)) return 0;
  std::int64_t done = 0;
  for (; done < count; ++done) {
    const double end = static_cast<double>(state.steps + 1) * settings_.dt;
    if (!attempt({state.time, end}, {false, done == 0}, state, before, substep)) break;
    bodies_.go_on();
    bodies_.pass();
    state.features.swap(before.features);
    state.time = end;
    ++state.steps;
  }
  if (done > 0) bodies_.store_passed(state);
  return done;
}

void AffineMotion::count(int substeps, StepStatistics& statistics) const {
  const int rounds = substeps * (rattle_ ? 2 : 1);
  statistics.rows = static_cast<int>(rows_.size());
  statistics.rounds += rounds;
  statistics.row_solves += static_cast<std::int64_t>(rows_.size()) * rounds;
}

void AffineMotion::keep_forces(Substep& substep) const {
  if (!rattle_) return;
  substep.late_forces.resize(features_.size());
  const double rate = 1.0 / h_;
  for (std::size_t f = 0; f < features_.size(); ++f) {
    std::vector<double>& late = substep.late_forces[f];
    const std::size_t count = features_[f]->multipliers().size();
    // Forces of multipliers without a row stay 0.
    if (late.size() != count) late.assign(count, 0.0);
    for (std::size_t i = feature_rows_[f]; i < feature_rows_[f] + feature_counts_[f]; ++i) {
      late[at(rows_.index(i))] = rate * impulses_[i];
    }
  }
}

}  // namespace sheave
