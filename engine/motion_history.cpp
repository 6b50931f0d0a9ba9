#include "engine/motion_history.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheave {
namespace {

constexpr auto kept = static_cast<std::size_t>(MotionHistory::most_known);

}  // namespace

bool MotionHistory::tells(double length, std::size_t dofs) const {
  return order >= 0 && length == step && differences.size() == kept * dofs;
}

void MotionHistory::guess(std::span<double> accelerations) const {
  const std::size_t dofs = accelerations.size();
  std::copy_n(differences.begin(), dofs, accelerations.begin());
  for (std::size_t k = 1; k <= static_cast<std::size_t>(order); ++k) {
    const double* const difference = differences.data() + k * dofs;
    for (std::size_t d = 0; d < dofs; ++d) accelerations[d] += difference[d];
  }
}

void MotionHistory::add(double length, std::span<const double> accelerations,
                        std::span<const double> by_start, std::span<const double> levers) {
  const std::size_t dofs = accelerations.size();
  if (length != step || differences.size() != kept * dofs) {
    differences.assign(kept * dofs, 0.0);
    step = length;
    known = 0;
  }
  // Errors that the guesses would have had: by the velocity, then of order 0, 1, ...
  std::array<double, kept + 1> errors{};
  const auto before = static_cast<std::size_t>(known);
  for (std::size_t d = 0; d < dofs; ++d) {
    const double lever = levers[d];
    errors[0] = std::max(errors[0], std::abs(accelerations[d] - by_start[d]) * lever);
    double next = accelerations[d];
    for (std::size_t k = 0; k < kept; ++k) {
      double& difference = differences[k * dofs + d];
      const double change = next - difference;
      difference = next;
      if (k >= before) break;
      next = change;
      errors[k + 1] = std::max(errors[k + 1], std::abs(next) * lever);
    }
  }
  const auto end = errors.begin() + static_cast<std::ptrdiff_t>(before) + 1;
  order = std::min_element(errors.begin(), end) - errors.begin() - 1;
  known = std::min(known + 1, most_known);
}

bool MotionHistory::is_sound(std::size_t dofs) const {
  if (known < 0 || known > most_known || order < by_velocity ||
      order >= std::max<std::int64_t>(known, 0)) {
    return known == 0 && order == by_velocity && differences.empty();
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::isfinite(step) && (differences.empty() || differences.size() == kept * dofs) &&
         std::all_of(differences.begin(), differences.end(), finite);
}

}  // namespace sheave
