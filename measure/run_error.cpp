#include "measure/run_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheave::measure {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double square_displacement(const TrackedBody& body, const TrackedBody& other, const BodyPose& pose,
                           const BodyPose& right) {
  // Of one body in two models, one may count full turns and the other not.
  const PoseDifference apart =
      pose_difference(pose, right, body.turns_by_angle && other.turns_by_angle);
  return apart.position.squaredNorm() + body.reach * body.reach * apart.turn.squaredNorm();
}

double position_error(const Trajectory& run, std::size_t frame, const Trajectory& reference,
                      std::size_t reference_frame) {
  if (run.bodies.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    sum += square_displacement(run.bodies[i], reference.bodies[i], run.frames[frame].poses[i],
                               reference.frames[reference_frame].poses[i]);
  }
  return std::sqrt(sum / static_cast<double>(run.bodies.size())) / reference.scale;
}

double tension_error(const Trajectory& run, const Trajectory& reference) {
  double difference = 0.0;
  double size = 0.0;
  // Tensions are not defined before the first step.
  for (std::size_t f = 1; f < reference.frames.size(); ++f) {
    for (std::size_t k = 0; k < reference.frames[f].tensions.size(); ++k) {
      const double right = reference.frames[f].tensions[k];
      const double wrong = run.frames[f].tensions[k] - right;
      difference += wrong * wrong;
      size += right * right;
    }
  }
  if (difference == 0.0) return 0.0;
  return size > 0.0 ? std::sqrt(difference / size) : infinity;
}

double energy_error(const Trajectory& run, const Trajectory& reference) {
  double difference = 0.0;
  double size = 0.0;
  const double start = reference.frames.front().energy;
  for (std::size_t f = 0; f < reference.frames.size(); ++f) {
    const Frame& right = reference.frames[f];
    difference = std::max(difference, std::abs(run.frames[f].energy - right.energy));
    size = std::max({size, std::abs(right.energy - start), right.kinetic_energy});
  }
  // If nothing moves in the reference, its energy differs only by rounding.
  return size > 1e-12 * std::abs(start) && size > 0.0 ? difference / size : 0.0;
}

}  // namespace

PoseDifference pose_difference(const BodyPose& pose, const BodyPose& from, bool by_angle) {
  const Vector3 moved = pose.position - from.position;
  if (by_angle) return {moved, Vector3(0.0, 0.0, pose.angle - from.angle)};
  const Eigen::AngleAxisd turned(pose.orientation * from.orientation.conjugate());
  return {moved, turned.angle() * turned.axis()};
}

double motion_of(const Trajectory& run) {
  double motion = 0.0;
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    motion = std::max(motion, position_error(run, f, run, 0));
  }
  return motion;
}

std::vector<double> position_errors(const Trajectory& run, const Trajectory& reference) {
  std::vector<double> errors;
  const std::size_t frames = std::min(run.frames.size(), reference.frames.size());
  for (std::size_t f = 0; f < frames; ++f) errors.push_back(position_error(run, f, reference, f));
  return errors;
}

RunError error_of(const Trajectory& run, const Trajectory& reference) {
  if (!run.complete() || !reference.complete() || run.frames.size() != reference.frames.size()) {
    return {infinity, infinity, infinity, infinity};
  }
  const std::vector<double> errors = position_errors(run, reference);
  return {*std::max_element(errors.begin(), errors.end()), errors.back(),
          tension_error(run, reference), energy_error(run, reference)};
}

}  // namespace sheave::measure
