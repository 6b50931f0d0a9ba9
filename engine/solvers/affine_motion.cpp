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
  if (!motion->append(features)) return nullptr;
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
  for (const auto& feature : features) {
    feature_rows_.push_back(rows_.size());
    if (feature->corrects_velocities() || feature->is_stiff() ||
        !feature->append_affine(bodies_, rows_)) {
      return false;
    }
  }
  feature_rows_.push_back(rows_.size());
  return true;
}

void AffineMotion::find_matrix() {
  const std::size_t n = rows_.size();
  for (std::vector<double>* values : {&shares_, &start_shares_, &softness_, &diagonal_, &values_,
                                      &free_, &unknowns_, &multipliers_, &impulses_}) {
    values->assign(n, 0.0);
  }
  active_.assign(n, 0);
  first_.resize(features_.size());
  springs_.assign(n, 0);
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
  couplings_.assign(entries_.size(), 0.0);
  factor_.analyse(static_cast<int>(n), entries_);
  if (elastic_ && rattle_) rigid_factor_.analyse(static_cast<int>(n), entries_);
}

void AffineMotion::prepare(const Substep& substep) {
  if (h_ == substep.h) return;
  h_ = substep.h;
  bodies_.prepare(h_, rattle_ ? 0.5 * h_ : h_);
  factored_for_.clear();
  std::vector<double> weighed(bodies_.count(), 0.0);  // W J^T of one row
  std::size_t entry = 0;                              // they are in the order of the rows
  const Terms terms = this->terms();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    terms.act(i, 1.0, weighed.data());
    diagonal_[i] = terms.along(i, weighed.data());
    for (; entry < entries_.size() && at(entries_[entry].first) == i; ++entry) {
      couplings_[entry] = terms.along(at(entries_[entry].second), weighed.data());
    }
    for (int p = rows_.starts()[i]; p < rows_.starts()[i + 1]; ++p) {
      weighed[at(rows_.numbers()[at(p)])] = 0.0;
    }
    const double compliance = rows_.compliance(i);
    const double gamma = (rattle_ ? 2.0 : 1.0) * compliance * rows_.damping(i) / h_;
    const double scale = 1.0 / (1.0 + gamma);
    shares_[i] = rattle_ ? 1.0 : scale;
    start_shares_[i] = rattle_ && compliance > 0.0 ? scale * (1.0 - gamma) : 0.0;
    softness_[i] = scale * (rattle_ ? 4.0 : 1.0) * compliance / (h_ * h_);
  }
}

bool AffineMotion::factor() {
  if (factored_for_ == active_) return regular_;
  factored_for_ = active_;
  const std::size_t n = rows_.size();
  const auto factor = [&](SparseFactor& into, bool springs) {
    const auto acts = [&](int i) {
      return active_[at(i)] != 0 && (springs || rows_.compliance(at(i)) == 0.0);
    };
    std::vector<double> diagonal(n, 1.0);
    std::vector<double> couplings(entries_.size(), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      if (acts(static_cast<int>(i))) diagonal[i] = diagonal_[i] + (springs ? softness_[i] : 0.0);
    }
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      if (acts(entries_[e].first) && acts(entries_[e].second)) couplings[e] = couplings_[e];
    }
    into.factor(diagonal, couplings);
    return into.dropped() == 0;
  };
  regular_ = factor(factor_, true);
  if (elastic_ && rattle_) regular_ = factor(rigid_factor_, false) && regular_;
  return regular_;
}

bool AffineMotion::begin(const State& state) {
  const AffineSubstep own{0.0, h_,       bodies_.places(), bodies_.speeds(), bodies_.motion(),
                          {},  !rattle_, nullptr};
  for (std::size_t f = 0; f < features_.size(); ++f) {
    const std::size_t first = feature_rows_[f];
    const std::size_t count = feature_rows_[f + 1] - first;
    if (!features_[f]->begin_affine(own, state.features[f],
                                    std::span(values_).subspan(first, count),
                                    std::span(active_).subspan(first, count))) {
      return false;
    }
  }
  return true;
}

bool AffineMotion::solve_positions() {
  const std::size_t n = rows_.size();
  double* const motion = bodies_.motion().data();
  const Terms terms = this->terms();
  for (std::size_t i = 0; i < n; ++i) {
    double value = shares_[i] * values_[i];
    if (start_shares_[i] != 0.0) value += start_shares_[i] * std::min(values_[i], 0.0);
    free_[i] = value;
    unknowns_[i] = active_[i] != 0 ? -(value + terms.along(i, motion)) : 0.0;
  }
  factor_.solve(unknowns_);
  const double rounding = RowSystem::value_rounding * scale_;
  bool holds = true;
  for (std::size_t i = 0; i < n; ++i) {
    holds &= unknowns_[i] * diagonal_[i] >= -rounding;
    const double multiplier = std::max(unknowns_[i], 0.0);
    multipliers_[i] = multiplier;
    terms.act(i, multiplier, motion);
  }
  const double enough = DirectSolver::tolerance * scale_;
  left_ = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double residual = free_[i] + terms.along(i, motion) + softness_[i] * multipliers_[i];
    const bool acts = active_[i] != 0;
    holds &= residual >= (acts ? -enough : -rounding);
    holds &= !acts || residual <= enough;
    if (acts) left_ = std::max(left_, std::abs(residual));
  }
  return holds;
}

bool AffineMotion::solve_velocities() {
  const std::size_t n = rows_.size();
  double* const speeds = bodies_.end_speeds().data();
  const double* const motion = bodies_.motion().data();
  const Terms terms = this->terms();
  const double rate = 1.0 / h_;
  for (std::size_t i = 0; i < n && elastic_; ++i) {
    if (springs_[i] != 0) terms.act(i, rate * multipliers_[i], speeds);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool acts = active_[i] != 0 && springs_[i] == 0;
    impulses_[i] = acts ? -terms.along(i, speeds) : 0.0;
  }
  (elastic_ ? rigid_factor_ : factor_).solve(impulses_);
  const double rounding = RowSystem::value_rounding * scale_ * rate;
  bool holds = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (springs_[i] != 0) {
      impulses_[i] = rate * multipliers_[i];
    } else {
      holds &= impulses_[i] * diagonal_[i] >= -rounding;
      impulses_[i] = std::max(impulses_[i], 0.0);
      terms.act(i, impulses_[i], speeds);
    }
    multipliers_[i] += h_ * impulses_[i];
  }
  // An open row that closes now is one that acts.
  const double closed = DirectSolver::closed * scale_;
  for (std::size_t i = 0; i < n; ++i) {
    if (active_[i] != 0 || springs_[i] != 0) continue;
    const bool open = values_[i] + terms.along(i, motion) > closed;
    holds &= open || terms.along(i, speeds) >= -rounding;
  }
  return holds;
}

bool AffineMotion::attempt(double from, double to, const State& state, State& next,
                           Substep& substep) {
  bodies_.predict(from, rattle_ ? 0.5 * (from + to) : to, to);
  if (!begin(state) || !factor() || !solve_positions()) return false;
  bodies_.derive();
  if (rattle_) {
    bodies_.add_loads(0.5 * (from + to), to);
    if (!solve_velocities()) return false;
  }
  if (!bodies_.arrive()) return false;
  for (std::size_t f = 0; f < features_.size(); ++f) {
    const std::size_t first = feature_rows_[f];
    const std::span<const double> multipliers =
        std::span(multipliers_).subspan(first, feature_rows_[f + 1] - first);
    next.features[f].reals = state.features[f].reals;
    const AffineSubstep own{
        to,          h_,       bodies_.places(),   bodies_.speeds(), bodies_.motion(),
        multipliers, !rattle_, &substep.statistics};
    if (!features_[f]->finish_affine(own, next.features[f])) return false;
  }
  return true;
}

int AffineMotion::advance(int first, int last, State& state, State& before, Substep& substep,
                          State* start) {
  const Controls& controls = state.controls;
  if (controls.cables_any() || controls.motions.any() || controls.joint_drives.any()) return 0;
  if (substep.work.stops()) return 0;
  substep.h = settings_.dt / settings_.substeps;
  substep.load_share = rattle_ ? 0.5 : 1.0;
  prepare(substep);
  if (!agree_) before = state;
  agree_ = true;
  before.memory = state.memory;
  if (!bodies_.load(state)) return 0;
  for (std::size_t f = 0; f < first_.size() && start != nullptr; ++f) {
    first_[f] = state.features[f].reals;
  }
  const double first_time = state.time;
  const double dt = settings_.dt;
  const auto substeps = static_cast<double>(settings_.substeps);
  int done = 0;
  for (int i = first; i < last; ++i, ++done) {
    const double end =
        (static_cast<double>(state.steps) + static_cast<double>(i + 1) / substeps) * dt;
    if (!attempt(state.time, end, state, before, substep)) break;
    substep.statistics.last_correction = std::max(substep.statistics.last_correction, left_);
    substep.statistics.external_work += bodies_.work_of_set_loads();
    bodies_.go_on();
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
    bodies_.store_end(state, state);
  } else if (done > 1) {
    bodies_.store_start(state, before);
    bodies_.store_end(state, state);
  } else {
    state.bodies.swap(before.bodies);
    bodies_.store_end(before, state);
  }
  before.steps = state.steps;
  keep_forces(substep);
  count(done, substep.statistics);
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
    late.assign(features_[f]->multipliers().size(), 0.0);
    for (std::size_t i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      late[i - feature_rows_[f]] = rate * impulses_[i];
    }
  }
}

}  // namespace sheave
