#include "engine/substep_driver.h"

#include <algorithm>
#include <utility>

#include "engine/integrators/loads.h"

namespace sheave {

SubstepDriver::SubstepDriver(const Model& model,
                             std::span<const std::unique_ptr<ConstraintBatch>> features,
                             std::span<const Stage> stages, Substep& substep, State& state)
    : settings_(model.step),
      features_(features),
      noted_(features_with<NotedFeature>(features)),
      stages_(stages),
      substep_(substep),
      state_(state),
      affine_(AffineMotion::create(model, substep.bodies, features)) {}

void SubstepDriver::forget() {
  has_stepped_ = false;
  controls_changed_ = start_lacks_controls_ = true;
  if (affine_) affine_->forget();
}

int SubstepDriver::run_affine(int index, int end, State* start) {
  const int done = affine_ ? affine_->advance(index, end, state_, before_, substep_, start) : 0;
  if (done == 0 && start != nullptr) keep_start(*start);
  if (done == 0) return 0;
  if (controls_changed_) before_.controls = state_.controls;
  before_.history = state_.history;  // empty, or that of the last substep of the stages
  controls_changed_ = was_cut_ = false;
  has_stepped_ = next_is_old_ = true;
  return done;
}

std::int64_t SubstepDriver::leap(std::int64_t count) {
  const std::int64_t done = affine_ ? affine_->leap(count, state_, before_, substep_) : 0;
  if (done > 0) {
    has_stepped_ = false;
    next_is_old_ = true;
  }
  return done;
}

void SubstepDriver::keep_start(State& start) {
  start.steps = state_.steps;
  start.time = state_.time;
  start.bodies = state_.bodies;
  if (!features_.empty()) start.features = state_.features;
  start.history = state_.history;
  start.memory = state_.memory;
  // Steps do not change controls, so they are copied after a change only.
  if (start_lacks_controls_) start.controls = state_.controls;
  start_lacks_controls_ = false;
}

std::optional<Divergence> SubstepDriver::run(int index) {
  return run(Part{index, settings_.substeps});
}

std::optional<Divergence> SubstepDriver::run_part(std::int64_t index, std::int64_t count) {
  return run(Part{index, count});
}

std::optional<Divergence> SubstepDriver::run_to(double end) {
  stretch_ = {state_.time, end};
  return run(Part{0, 1, true});
}

double SubstepDriver::end_of_substep(int index) const {
  return end_of(Part{index, settings_.substeps});
}

double SubstepDriver::length_of(Part part) const {
  const auto count = static_cast<double>(part.count);
  return (part.of_stretch ? stretch_.to - stretch_.from : settings_.dt) / count;
}

double SubstepDriver::end_of(Part part) const {
  const double share = static_cast<double>(part.index + 1) / static_cast<double>(part.count);
  if (!part.of_stretch) return (static_cast<double>(state_.steps) + share) * settings_.dt;
  if (share == 1.0) return stretch_.to;
  return stretch_.from + (stretch_.to - stretch_.from) * share;
}

void SubstepDriver::note_features() {
  if (affine_) affine_->forget();
  substep_.next.features = state_.features;
}

std::optional<Divergence> SubstepDriver::run(Part whole) {
  divergence_.reset();
  was_cut_ = false;
  fewest_ = whole.count;
  if (affine_) affine_->forget();
  if (next_is_old_) substep_.next = state_;
  next_is_old_ = false;
  rounds_before_ = substep_.statistics.rounds;
  allow_work(most_factorisations);
  if (attempt(whole, Resort::none)) {
    keep();
  } else if (!over()) {
    cut(whole);
  }
  if (divergence_) forget();
  return std::move(divergence_);
}

void SubstepDriver::allow_work(std::int64_t factorisations) {
  const std::int64_t share =
      std::clamp<std::int64_t>(row_count() / rows_of_factorisation, 1, fewest_share);
  substep_.work.allow(factorisations / share + settings_.iterations);
}

std::int64_t SubstepDriver::row_count() const {
  std::int64_t rows = 0;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    // The state of a feature with a varying number of rows (contacts) has about four numbers per
    // row.
    constexpr std::size_t numbers_per_row = 4;
    rows += features_[i]->has_fixed_size()
                ? features_[i]->row_count()
                : static_cast<std::int64_t>(state_.features[i].reals.size() / numbers_per_row);
  }
  return rows;
}

bool SubstepDriver::out_of_work() const {
  return substep_.work.exhausted() || substep_.statistics.rounds - rounds_before_ >= most_rounds;
}

void SubstepDriver::cut(Part whole) {
  left_to_others_ = 0;
  parts_ = 0;
  was_cut_ = true;
  start_ = state_;
  for (NotedFeature* feature : noted_) feature->mark_notes(NoteMark::substep);
  const StepStatistics before = substep_.statistics;
  if (advance_in_halves(whole)) {
    ++substep_.statistics.cut_substeps;
    substep_.statistics.substep_parts += parts_;
    return;
  }
  if (over()) return;
  if (out_of_work()) ++substep_.statistics.exhausted;
  // The residual of a short part would become a large velocity.
  go_back(start_, before, NoteMark::substep);
  make_do(whole);
}

void SubstepDriver::go_back(const State& start, const StepStatistics& before, NoteMark mark) {
  state_.bodies = start.bodies;
  state_.features = start.features;
  state_.history = start.history;
  state_.time = start.time;
  substep_.next = state_;
  next_is_old_ = false;
  if (affine_) affine_->forget();
  for (NotedFeature* feature : noted_) feature->return_to(mark);
  // Of the discarded motion only the work counts.
  const StepStatistics done = std::exchange(substep_.statistics, before);
  StepStatistics& statistics = substep_.statistics;
  statistics.row_solves = done.row_solves;
  statistics.rounds = done.rounds;
  statistics.set_changes = done.set_changes;
  statistics.factorisations = done.factorisations;
  statistics.compromises = done.compromises;
  statistics.redundant_rows = done.redundant_rows;
  statistics.exhausted = done.exhausted;
}

void SubstepDriver::make_do(Part whole) {
  allow_work(last_factorisations);
  if (others() && attempt(whole, Resort::other_integrator)) {
    keep();
    return;
  }
  allow_work(last_factorisations);
  if (!over() && attempt(whole, Resort::anything)) {
    keep();
    ++substep_.statistics.unconverged;
  }
}

bool SubstepDriver::others() const { return settings_.integrator == IntegratorKind::rattle; }

bool SubstepDriver::attempt(Part part, Resort resort) {
  const std::int64_t fallbacks = substep_.statistics.integrator_fallbacks;
  substep_.h = length_of(part);
  substep_.load_share = settings_.integrator == IntegratorKind::rattle ? 0.5 : 1.0;
  substep_.iterations =
      part.count == fewest_ ? settings_.iterations : std::min(settings_.iterations, rounds_of_part);
  substep_.resort = resort;
  substep_.failed = false;
  if (substep_.work.stops()) return false;
  substep_.restart();
  for (std::vector<double>& late : substep_.late_forces) late.clear();
  substep_.next.time = end_of(part);
  for (const Stage& stage : stages_) {
    stage.run(substep_);
    if (substep_.failed || substep_.work.stopped()) break;
  }
  const bool done = !substep_.failed && !substep_.work.stopped();
  if (done) divergence_ = find_divergence(substep_, features_);
  if (done && !divergence_) return true;
  substep_.statistics.integrator_fallbacks = fallbacks;
  substep_.next = state_;  // stages build on the contents that `next` had at the start
  return false;
}

bool SubstepDriver::advance_in_halves(Part part) {
  return advance_half(part.first_half()) && advance_half(part.second_half());
}

bool SubstepDriver::advance_half(Part part) {
  if (out_of_work()) return false;
  const bool smallest = part.count >= most_parts * fewest_;
  const bool tired = left_to_others_ >= patience;
  bool done = attempt(part, Resort::none);
  if (!done && !over() && others() && (smallest || tired)) {
    done = attempt(part, Resort::other_integrator);
    if (done) ++left_to_others_;
  }
  if (done) {
    keep();
    ++parts_;
    return true;
  }
  return !over() && !smallest && advance_in_halves(part);
}

void SubstepDriver::put_in_place(const BodyState* bodies, const double* reals) {
  const auto put = [](auto& own, auto& other, const auto* place) {
    if (own.data() == place || other.data() != place || own.size() != other.size()) return;
    std::swap_ranges(own.begin(), own.end(), other.begin());
    own.swap(other);
  };
  put(state_.bodies, before_.bodies, bodies);
  if (state_.features.empty() || before_.features.empty()) return;
  put(state_.features.back().reals, before_.features.back().reals, reals);
}

void SubstepDriver::keep() {
  if (state_.controls.forces.any()) {
    substep_.statistics.external_work += work_of_set_forces(substep_);
  }
  // All states have the same sizes, so the copies do not allocate. The state before is kept by an
  // exchange, without a copy.
  state_.bodies.swap(before_.bodies);
  if (!features_.empty()) state_.features.swap(before_.features);
  std::swap(state_.history, before_.history);
  before_.time = state_.time;
  before_.steps = state_.steps;
  // Steps do not change controls, so they are copied after a change only.
  if (controls_changed_) before_.controls = state_.controls;
  controls_changed_ = false;
  has_stepped_ = true;
  state_.bodies = substep_.next.bodies;
  if (!features_.empty()) state_.features = substep_.next.features;
  state_.history = substep_.next.history;
  state_.time = substep_.next.time;
}

}  // namespace sheave
