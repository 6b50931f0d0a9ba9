#include "engine/contacts/broad_phase.h"

#include <algorithm>
#include <numeric>

#include "engine/index.h"

namespace sheave {
namespace {

/// The coordinate in which the centres of finite boxes have the largest variance.
int widest_axis(std::span<const Bounds> boxes) {
  Vector3 sum = Vector3::Zero();
  Vector3 squares = Vector3::Zero();
  double count = 0.0;
  for (const Bounds& box : boxes) {
    if (!box.low.allFinite() || !box.high.allFinite()) continue;
    const Vector3 center = 0.5 * (box.low + box.high);
    sum += center;
    squares += center.cwiseAbs2();
    count += 1.0;
  }
  if (count == 0.0) return 0;
  int axis = 0;
  (squares - sum.cwiseAbs2() / count).maxCoeff(&axis);
  return axis;
}

}  // namespace

std::span<const std::pair<int, int>> BroadPhase::find(std::span<const Bounds> boxes) {
  if (order_.size() != boxes.size()) {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0);
  }
  const int axis = widest_axis(boxes);
  const auto before = [&](int i, int j) {
    const double a = boxes[at(i)].low[axis];
    const double b = boxes[at(j)].low[axis];
    return a != b ? a < b : i < j;
  };
  // Insertion sort is fastest for an order that has changed little. After a change of axis the
  // order changes much, so the number of moves is limited.
  std::size_t moves = 16 * order_.size();
  for (std::size_t k = 1; k < order_.size() && moves > 0; ++k) {
    const int moved = order_[k];
    std::size_t place = k;
    for (; place > 0 && before(moved, order_[place - 1]); --place) {
      order_[place] = order_[place - 1];
    }
    order_[place] = moved;
    moves -= std::min(moves, k - place);
  }
  if (moves == 0) std::sort(order_.begin(), order_.end(), before);
  pairs_.clear();
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Bounds& box = boxes[at(order_[k])];
    for (std::size_t m = k + 1; m < order_.size(); ++m) {
      const Bounds& other = boxes[at(order_[m])];
      if (other.low[axis] > box.high[axis]) break;
      if (box.overlaps(other)) pairs_.emplace_back(std::minmax(order_[k], order_[m]));
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

}  // namespace sheave
