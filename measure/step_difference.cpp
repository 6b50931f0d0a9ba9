#include "measure/step_difference.h"

#include <algorithm>
#include <cmath>

namespace sheave::measure {
namespace {

constexpr double least_alignment = 0.9;
constexpr double least_order = 0.7;
constexpr double most_order = 4.5;

}  // namespace

double StepDifference::relative() const { return largest == 0.0 ? 0.0 : largest / scale; }

bool StepDifference::negligible() const {
  return bound == 0.0 || bound <= negligible_difference * scale;
}

double StepDifference::error() const {
  if (!order) return std::max(bound, unseen);
  const double ratio = std::exp2(*order);
  return largest * ratio / (ratio - 1.0);
}

void StepDifferenceSum::add(const Vector3& coarse, const Vector3& fine) {
  frame_coarse_ += coarse.squaredNorm();
  frame_fine_ += fine.squaredNorm();
  frame_sum_ += (coarse + fine).squaredNorm();
  product_ += coarse.dot(fine);
}

void StepDifferenceSum::end_frame(double time) {
  coarse_ += frame_coarse_;
  fine_ += frame_fine_;
  const double coarse = std::sqrt(frame_coarse_);
  const double fine = std::sqrt(frame_fine_);
  bound_ = std::max(bound_, std::sqrt(frame_sum_) + std::max(fine, 0.5 * coarse));
  last_ = std::max(coarse, fine);
  frame_coarse_ = frame_fine_ = frame_sum_ = 0.0;
  if (last_ <= largest_) return;
  largest_ = last_;
  time_ = time;
}

StepDifference StepDifferenceSum::result(double scale, std::size_t parts) const {
  const double root = std::sqrt(static_cast<double>(parts));
  StepDifference difference{.largest = largest_ / root,
                            .time = time_,
                            .at_end = last_ / root,
                            .scale = scale,
                            .bound = bound_ / root};
  if (difference.negligible() || !(coarse_ > 0.0) || !(fine_ > 0.0)) return difference;
  const double order = 0.5 * std::log2(coarse_ / fine_);
  const double alignment = product_ / std::sqrt(coarse_ * fine_);
  if (alignment >= least_alignment && order >= least_order && order <= most_order) {
    difference.order = order;
  }
  return difference;
}

}  // namespace sheave::measure
