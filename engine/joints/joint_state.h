#pragma once
// The layout of what joints of one type carry from substep to substep.

#include <algorithm>
#include <span>

#include "engine/joints/joint_hold.h"
#include "engine/state.h"

namespace sheave {

/// Reals: generalised force per row [N or N m] of the last substep along the row's gradient, locks and effects joint by joint;
/// then the coordinates [m or rad] of the joints that count them, angles with all turns; then when each joint broke [s], -1 for
/// one that has not; then, as soon as one of them has been locked again, what each holds (JointHold).
struct JointStateLayout {
  std::size_t rows = 0;
  std::size_t coordinates = 0;
  std::size_t joints = 0;

  [[nodiscard]] FeatureState initial() const {
    FeatureState state;
    state.reals.assign(first_hold(), 0.0);
    std::fill(state.reals.end() - static_cast<std::ptrdiff_t>(joints), state.reals.end(), -1.0);
    return state;
  }
  [[nodiscard]] bool accepts(const FeatureState& state) const {
    if (!state.integers.empty()) return false;
    if (!has_holds(state)) return state.reals.size() == first_hold();
    if (state.reals.size() != first_hold() + joints * JointHold::size) return false;
    for (std::size_t j = 0; j < joints; ++j) {
      if (!hold(state, j).is_sound()) return false;
    }
    return true;
  }
  [[nodiscard]] std::span<const double> coordinates_of(const FeatureState& state) const {
    return std::span(state.reals).subspan(rows, coordinates);
  }
  /// [s]; < 0 if it has not.
  [[nodiscard]] double broken_at(const FeatureState& state, std::size_t joint) const {
    return state.reals[rows + coordinates + joint];
  }
  void set_broken(FeatureState& state, std::size_t joint, double time) const {
    state.reals[rows + coordinates + joint] = time;
  }
  [[nodiscard]] bool has_holds(const FeatureState& state) const {
    return state.reals.size() > first_hold();
  }
  [[nodiscard]] JointHold hold(const FeatureState& state, std::size_t joint) const {
    if (!has_holds(state)) return {};
    return JointHold::read(std::span(state.reals).subspan(first_hold() + joint * JointHold::size));
  }
  void set_hold(FeatureState& state, std::size_t joint, const JointHold& hold) const {
    if (!has_holds(state)) {
      state.reals.resize(first_hold() + joints * JointHold::size);
      for (std::size_t j = 0; j < joints; ++j) JointHold{}.write(place_of(state, j));
    }
    hold.write(place_of(state, joint));
  }

 private:
  [[nodiscard]] std::size_t first_hold() const { return rows + coordinates + joints; }
  [[nodiscard]] std::span<double> place_of(FeatureState& state, std::size_t joint) const {
    return std::span(state.reals).subspan(first_hold() + joint * JointHold::size, JointHold::size);
  }
};

}  // namespace sheave
