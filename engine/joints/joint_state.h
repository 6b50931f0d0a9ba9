#pragma once
// The layout of the state of all joints of one type.

#include <algorithm>
#include <span>

#include "engine/joints/joint_hold.h"
#include "engine/state.h"

namespace sheave {

/// The reals are, in this order:
///   per row        mean force of the last substep along the row's gradient [N or N m], locks and
///                  effects joint by joint
///   coordinates    of the joints that count them [m or rad], with whole turns
///   per joint      time at which the joint broke [s]; -1 if it has not broken
///   per joint      JointHold; only after a joint has been locked
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
  /// Time at which a joint broke [s]; < 0 if it has not broken.
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

  /// The places of a joint's numbers.
  struct Part {
    std::size_t joint = 0;
    int first_row = 0;
    int row_count = 0;
    int first_coordinate = -1;  ///< < 0: none are counted
    int coordinate_count = 0;
  };
  /// Copies the numbers of a joint from a state with another layout.
  void adopt(FeatureState& own, const Part& now, const JointStateLayout& other,
             const FeatureState& from, const Part& then) const {
    if (now.row_count == then.row_count) {
      std::copy_n(from.reals.begin() + then.first_row, now.row_count,
                  own.reals.begin() + now.first_row);
    }
    if (now.first_coordinate >= 0 && then.first_coordinate >= 0) {
      std::copy_n(other.coordinates_of(from).begin() + then.first_coordinate, now.coordinate_count,
                  own.reals.begin() + static_cast<std::ptrdiff_t>(rows) + now.first_coordinate);
    }
    set_broken(own, now.joint, other.broken_at(from, then.joint));
    if (other.has_holds(from)) set_hold(own, now.joint, other.hold(from, then.joint));
  }

 private:
  [[nodiscard]] std::size_t first_hold() const { return rows + coordinates + joints; }
  [[nodiscard]] std::span<double> place_of(FeatureState& state, std::size_t joint) const {
    return std::span(state.reals).subspan(first_hold() + joint * JointHold::size, JointHold::size);
  }
};

}  // namespace sheave
