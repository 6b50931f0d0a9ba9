#pragma once
// Finds the pairs of boxes that overlap, by sweep and prune along the axis along which the centres
// of the boxes are spread most.
//
// Cost: sorting (of an order that hardly changes from substep to substep, so nearly linear) and one
// test per pair that overlaps along the axis. The pairs are in ascending order and depend on the
// boxes alone, not on earlier calls.

#include <span>
#include <utility>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// An axis-aligned box [m]; infinite for unbounded forms.
struct Bounds {
  Vector3 low = Vector3::Zero();
  Vector3 high = Vector3::Zero();
  [[nodiscard]] bool overlaps(const Bounds& other) const {
    return low.x() <= other.high.x() && other.low.x() <= high.x() && low.y() <= other.high.y() &&
           other.low.y() <= high.y() && low.z() <= other.high.z() && other.low.z() <= high.z();
  }
};

class BroadPhase {
 public:
  /// Pairs (i, j), i < j, of boxes that overlap, in ascending order. Valid until the next call.
  std::span<const std::pair<int, int>> find(std::span<const Bounds> boxes);

 private:
  std::vector<int> order_;  // by the lower end; kept because it is nearly sorted in the next call
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace sheave
