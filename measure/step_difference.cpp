#include "measure/step_difference.h"

#include <cmath>

namespace sheave::measure {
namespace {

constexpr double least_alignment = 0.9;
constexpr double least_order = 0.7;

}  // namespace

double StepDifference::relative() const { return largest == 0.0 ? 0.0 : largest / scale; }

double StepDifference::error() const {
  if (!order) return largest;
  const double ratio = std::exp2(*order);
  return largest * ratio / (ratio - 1.0);
}

void StepDifferenceSum::add(const Vector3& coarse, const Vector3& fine) {
  frame_ += coarse.squaredNorm();
  fine_ += fine.squaredNorm();
  product_ += coarse.dot(fine);
}

void StepDifferenceSum::end_frame(double time) {
  coarse_ += frame_;
  last_ = std::sqrt(frame_);
  frame_ = 0.0;
  if (last_ <= largest_) return;
  largest_ = last_;
  time_ = time;
}

StepDifference StepDifferenceSum::result(double scale, std::size_t parts) const {
  const double root = std::sqrt(static_cast<double>(parts));
  StepDifference difference{largest_ / root, time_, last_ / root, scale, {}};
  if (!(difference.relative() > negligible_difference) || !(fine_ > 0.0)) return difference;
  const double order = 0.5 * std::log2(coarse_ / fine_);
  const double alignment = product_ / std::sqrt(coarse_ * fine_);
  if (alignment >= least_alignment && order >= least_order) difference.order = order;
  return difference;
}

}  // namespace sheave::measure
