#include "engine/instants.h"

#include <algorithm>
#include <cmath>

namespace sheave {

double instant_slop(const StepSettings& step) {
  const double share = step.solver == SolverKind::direct ? 1e-4 : 1e-2;
  return share * step.dt / step.substeps;
}

InstantSearch::InstantSearch(double begin, double end, double shortest,
                             std::span<const double> at_begin, std::span<const double> at_end)
    : earliest_(begin + shortest),
      latest_(end - shortest),
      enough_(tolerance * (end - begin)),
      low_(begin),
      high_(end),
      at_low_(at_begin.begin(), at_begin.end()),
      at_high_(at_end.begin(), at_end.end()),
      width_(end - begin) {}

double InstantSearch::guess() const {
  double first = high_;
  for (std::size_t i = 0; i < at_high_.size(); ++i) {
    if (!(at_high_[i] > 0.0)) continue;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const double before = i < at_low_.size() ? -low_weight_ * at_low_[i] : unknown;
    const double share = before / (before + high_weight_ * at_high_[i]);
    // A margin that jumps, or is no number, tells nothing of the instant.
    const bool known = before >= 0.0 && share >= 0.0 && share <= 1.0 && std::isfinite(at_high_[i]);
    first = std::min(first, low_ + (high_ - low_) * (known ? share : 0.5));
  }
  return first;
}

std::optional<double> InstantSearch::next() {
  if (attempts_ == most_attempts || !(high_ - low_ > enough_)) return std::nullopt;
  double instant = guess();
  const double width = high_ - low_;
  // Where a guess has not halved the bracket, the next attempt does.
  halves_ = attempts_ > 0 && !halves_ && width > 0.5 * width_;
  if (halves_) instant = 0.5 * (low_ + high_);
  width_ = width;
  // An end that is known that well closes the bracket from its other side.
  const double apart = 0.5 * enough_;
  instant = std::clamp(instant, low_ + apart, high_ - apart);
  instant = std::min(std::max(instant, earliest_), latest_);
  if (!(instant > low_ && instant < high_)) return std::nullopt;
  ++attempts_;
  return instant;
}

void InstantSearch::tell(double instant, std::span<const double> margins) {
  const bool holds =
      std::any_of(margins.begin(), margins.end(), [](double margin) { return margin > 0.0; });
  // By the rule of Illinois: margins of an end that stays count half.
  if (holds == held_) (holds ? low_weight_ : high_weight_) *= 0.5;
  (holds ? high_weight_ : low_weight_) = 1.0;
  held_ = holds;
  (holds ? high_ : low_) = instant;
  std::vector<double>& own = holds ? at_high_ : at_low_;
  own.assign(margins.begin(), margins.end());
}

}  // namespace sheave
