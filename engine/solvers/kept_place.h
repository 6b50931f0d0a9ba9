#pragma once
// Poses of the bodies and multipliers of the features, for rounds that may have to be undone.

#include <algorithm>
#include <vector>

#include "engine/solvers/row_system.h"

namespace sheave {

class KeptPlace {
 public:
  void keep(const Substep& substep, Features features) {
    bodies_ = substep.moving;
    multipliers_.resize(features.size());
    for (std::size_t f = 0; f < features.size(); ++f) {
      const std::span<const double> from = features[f]->multipliers();
      multipliers_[f].assign(from.begin(), from.end());
    }
  }

  void go_back(Substep& substep, Features features) const {
    substep.moving = bodies_;
    for (std::size_t f = 0; f < features.size(); ++f) {
      std::copy(multipliers_[f].begin(), multipliers_[f].end(), features[f]->multipliers().begin());
    }
  }

  [[nodiscard]] const std::vector<MovingBody>& bodies() const { return bodies_; }

 private:
  std::vector<MovingBody> bodies_;
  std::vector<std::vector<double>> multipliers_;
};

}  // namespace sheave
