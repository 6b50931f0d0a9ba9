#include "engine/divergence.h"

#include <cmath>
#include <span>

#include "engine/constraint_batch.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/substep.h"

namespace sheave {
namespace {

/// Limit of distance, and of displacement per substep, in scene sizes. Beyond it, positions with 16
/// digits no longer resolve the scene's own length scale.
constexpr double runaway_sizes = 1e9;

/// Whether all numbers are finite; 0 times infinity or NaN is NaN.
bool are_finite(std::span<const double> numbers) {
  double sum = 0.0;
  for (const double number : numbers) sum += 0.0 * number;
  return sum == 0.0;
}

/// Name of the first quantity of a body's new state that is invalid; null if all are valid.
const char* fault_of(const BodyState& body, double size, double h) {
  const double farthest = runaway_sizes * size;
  // Fast path for valid states: comparisons of squares, all of which a NaN fails.
  const double far_squared = farthest * farthest;
  const double turn = dot(body.angular_velocity, body.angular_velocity);
  if (dot(body.position, body.position) <= far_squared &&
      h * h * dot(body.velocity, body.velocity) <= far_squared &&
      h * h * turn <= runaway_sizes * runaway_sizes &&
      std::abs(body.orientation.w()) + std::abs(body.orientation.x()) +
              std::abs(body.orientation.y()) + std::abs(body.orientation.z()) <=
          4.0) {
    return nullptr;
  }
  // allFinite() first, because a maximum may ignore a NaN.
  const auto beyond = [](const Vector3& v, double limit) {
    return !v.allFinite() || v.cwiseAbs().maxCoeff() > limit;
  };
  if (beyond(body.position, farthest)) return "position";
  if (beyond(h * body.velocity, farthest)) return "velocity";
  if (!body.orientation.coeffs().allFinite()) return "orientation";
  if (beyond(h * body.angular_velocity, runaway_sizes)) return "angular velocity";
  return nullptr;
}

}  // namespace

Runaway runaway_limits(double size, double h) {
  const double farthest = runaway_sizes * size;
  return {farthest, farthest / h, runaway_sizes / h};
}

std::optional<Divergence> find_divergence(
    const Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features) {
  const BodySet& bodies = substep.bodies;
  const double time = substep.next.time;
  if (!std::isfinite(time)) {
    return Divergence{BodyId::world(), time, "the time is not finite; the step must be shorter"};
  }
  // Texts are made on failure only, because this function runs in every substep.
  const auto when = [&] { return " at time " + number_text(time) + " s"; };
  for (int i = 0; i < bodies.count(); ++i) {
    const char* what = fault_of(substep.next.bodies[at(i)], bodies.scale(), substep.h);
    if (what == nullptr) continue;
    return Divergence{
        {i},
        time,
        "body \"" + bodies.name(i) + "\": " + what + " is not finite or has run away" + when()};
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (const std::string fault = features[i]->fault(); !fault.empty()) {
      const std::string name(features[i]->name());
      return Divergence{BodyId::world(), time, name + when() + ": " + fault, name};
    }
    const std::vector<double>& reals = substep.next.features[i].reals;
    if (are_finite(reals)) {
      std::string why = features[i]->dead_end(substep);
      if (why.empty()) continue;
      return Divergence{BodyId::world(), time, std::move(why) + when(),
                        std::string(features[i]->name())};
    }
    const std::string name(features[i]->name());
    return Divergence{BodyId::world(), time, name + ": the state is not finite" + when(), name};
  }
  return std::nullopt;
}

}  // namespace sheave
