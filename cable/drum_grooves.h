#pragma once
// Events, warnings and reports of drums with a groove; internal to the cable library.

#include <array>
#include <vector>

#include "cable/cable_system.h"

namespace sheave {

/// The part of a CableSystem that watches drums with a groove.
class DrumGrooves {
 public:
  explicit DrumGrooves(CableSystem& system) : s_(system) {}

  /// Notes drums that have become full, and fleet angles above their limits. To be called when links
  /// and spans are those of the end.
  void finish(const Substep& substep, const FeatureState& next);

  /// Fleet angles that exceeded the limit of their drum.
  [[nodiscard]] static std::vector<cable_parts::FleetWarning> fleet_warnings(
      const CableSystem& system);
  /// Describes the rope of a drum. `ends`: of all spans; `ways`: the spans before and after the drum,
  /// -1: there is no such span, and without any the fleet angle is 0.
  [[nodiscard]] static GrooveReport report(const Substep& now, const LinkGeometry& link,
                                           const std::vector<SpanGeometry>& ends,
                                           std::array<int, 2> ways);
  /// Fleet angle [rad]. `leaves`: the drum is the first link of the span.
  [[nodiscard]] static double fleet_angle(const Substep& now, const LinkGeometry& link,
                                          const SpanGeometry& span, bool leaves);

 private:
  void note_fleet_angle(const Substep& substep, int link, int span, bool leaves);

  CableSystem& s_;
};

}  // namespace sheave
