#include "engine/substep_driver.h"

namespace sheave {

SubstepDriver::SubstepDriver(const StepSettings& settings,
                             std::span<const std::unique_ptr<ConstraintBatch>> features,
                             std::span<const Stage> stages, Substep& substep, State& state)
    : settings_(settings), features_(features), stages_(stages), substep_(substep), state_(state) {}

std::optional<Divergence> SubstepDriver::run(int index) {
  divergence_.reset();
  const Part whole{index, settings_.substeps};
  if (attempt(whole, Resort::none)) {
    keep();
  } else if (!divergence_) {
    left_to_others_ = 0;
    if (advance_in_halves(whole)) {
      ++substep_.statistics.cut_substeps;
    } else if (!divergence_) {
      make_do(whole);
    }
  }
  if (divergence_) forget();
  return std::move(divergence_);
}

bool SubstepDriver::attempt(Part part, Resort resort) {
  const auto count = static_cast<double>(part.count);
  substep_.h = settings_.dt / count;
  substep_.load_share = settings_.integrator == IntegratorKind::rattle ? 0.5 : 1.0;
  substep_.resort = resort;
  substep_.failed = false;
  substep_.restart();
  for (std::vector<double>& late : substep_.late_forces) late.clear();
  substep_.next.time =
      (static_cast<double>(state_.steps) + static_cast<double>(part.index + 1) / count) *
      settings_.dt;
  for (const Stage& stage : stages_) {
    stage.run(substep_);
    if (substep_.failed) break;
  }
  if (!substep_.failed) divergence_ = find_divergence(substep_, features_);
  if (!substep_.failed && !divergence_) return true;
  substep_.next = state_;  // stages build on what `next` held at the start
  return false;
}

bool SubstepDriver::advance_in_halves(Part part) {
  if (!advance_half(part.first_half())) return false;
  if (!advance_half(part.second_half()) && !divergence_) {
    make_do(part.second_half());
    ++substep_.statistics.substep_parts;
  }
  return true;
}

bool SubstepDriver::advance_half(Part part) {
  const bool smallest = part.count >= most_parts * settings_.substeps;
  const bool tired = left_to_others_ >= patience;
  const bool others = settings_.integrator == IntegratorKind::rattle;
  bool done = attempt(part, Resort::none);
  if (!done && !divergence_ && others && (smallest || tired)) {
    done = attempt(part, Resort::other_integrator);
    if (done) ++left_to_others_;
  }
  if (done) {
    keep();
    ++substep_.statistics.substep_parts;
    return true;
  }
  return !divergence_ && !smallest && advance_in_halves(part);
}

void SubstepDriver::make_do(Part part) {
  if (!attempt(part, Resort::anything)) return;
  keep();
  ++substep_.statistics.unconverged;
}

void SubstepDriver::keep() {
  // Same shape on all sides, so this copies without allocating, and what was is kept without a copy.
  state_.bodies.swap(before_.bodies);
  state_.features.swap(before_.features);
  before_.time = state_.time;
  before_.steps = state_.steps;
  has_stepped_ = true;
  state_.bodies = substep_.next.bodies;
  state_.features = substep_.next.features;
  state_.time = substep_.next.time;
}

}  // namespace sheave
