#pragma once
// Where a cable is cut: a number of the state, and the way to it along the cable.
//
// Lengths are unstretched, from the first link on: cable on wheels and drums, then free spans, in the
// order of the course. A place within a span is kept to 1e-9 of the span.

#include <cstdint>
#include <optional>
#include <vector>

#include "cable/cable_state_layout.h"
#include "cable/compiled_cable.h"
#include "engine/state.h"

namespace sheave {

/// A cut within a span. The state has the code of a cut at CableStateLayout::cut_index().
struct CutPlace {
  int span = 0;  ///< counted within the cable
  /// part of the span before the cut, 0 ... 1; none: not chosen, counts as the middle
  std::optional<double> share{};

  [[nodiscard]] std::int64_t code() const;
  /// Nothing if the code is 0: the cable is whole.
  [[nodiscard]] static std::optional<CutPlace> of(std::int64_t code);
  /// Whether a state may have this code, for a cable with so many spans.
  [[nodiscard]] static bool is_code(std::int64_t code, int spans);
};

/// A free span of a cable.
struct FreeStretch {
  int span = 0;         ///< counted within the cable
  double from = 0.0;    ///< length from the first link to its begin [m]
  double length = 0.0;  ///< unstretched [m]
};

/// The free spans in the order of the course, which begins at the first link that the cable touches.
[[nodiscard]] std::vector<FreeStretch> free_stretches(const CableStateLayout& layout,
                                                      const CompiledCable& cable,
                                                      const FeatureState& own);
/// Length from the first link to a cut [m].
[[nodiscard]] double length_to(const CutPlace& place, const CableStateLayout& layout,
                               const CompiledCable& cable, const FeatureState& own);

}  // namespace sheave
