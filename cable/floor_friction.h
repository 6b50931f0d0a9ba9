#pragma once
// The ropes of a world that lie on a floor with friction; internal to the cable library. The law is in
// cable/floor_profile.h.
//
// The span at an anchor has the tensions of its rope on the floor in the state. A state whose bodies or
// lengths were set may have a tension at the touch-down that these tensions do not know. The tensions
// of a state are therefore limited to that at the touch-down, as if the rope had come there on one way.

#include "cable/cable_system.h"
#include "cable/floor_profile.h"
#include "cable/lying_rope.h"

namespace sheave {

/// The part of a CableSystem that remembers the tensions of ropes on their floors.
class FloorFriction {
 public:
  explicit FloorFriction(CableSystem& system) : s_(system) {}

  /// Keeps the tensions at the start of the substep.
  void begin(const Substep& substep, const FeatureState& state);
  /// Writes the tensions at the end of the substep and counts the losses.
  void finish(const Substep& substep, FeatureState& next) const;
  /// Why a span that lies on a floor with friction away from its anchor ends the run.
  [[nodiscard]] static std::string stray_fault(const CableSystem& system, int span);

  /// The friction under a span in this substep.
  [[nodiscard]] static FloorGrip grip(const CableSystem& system, const Vector3& gravity, int span);
  /// The same in a state; `room` has the tensions of the grip.
  [[nodiscard]] static FloorGrip grip_in(const CableSystem& system, const Vector3& gravity,
                                         const FeatureState& own, int span, FloorProfile& room);

  /// The saved numbers of a span; none without friction.
  [[nodiscard]] static std::vector<double> kept(const CableSystem& system, const FeatureState& own,
                                                int span);
  static void put(const CableSystem& system, const std::vector<double>& kept, int span,
                  FeatureState& own);
  /// Whether a state has tensions that obey the law.
  [[nodiscard]] static bool accepts(const CableSystem& system, const FeatureState& own);
  /// Sum of the losses of a cable since time 0 [J].
  [[nodiscard]] static double loss(const CableSystem& system, const FeatureState& own,
                                   const CompiledCable& cable);
  /// Limits the tensions of a state to those at the touch-downs there.
  static void settle(const CableSystem& system, const BodySet& bodies, const State& state,
                     FeatureState& own);
  /// Lays the ropes of a state with the same tension everywhere on their floors. Returns a span that
  /// would lie away from its anchor; -1: none.
  static int lay(const CableSystem& system, const Substep& now, FeatureState& own);

 private:
  /// The links and spans of a pose.
  struct Course {
    const std::vector<LinkGeometry>& links;
    const std::vector<SpanSetup>& spans;
  };
  /// Where the rope of a span comes onto its floor.
  [[nodiscard]] static TouchDown touch_of(const CableSystem& system, const Substep& now,
                                          const Course& course, const FeatureState& own, int span,
                                          const FloorGrip& grip);
  /// Limits the tensions of a span to that at its touch-down. Returns the loss [J].
  static double limit(const CableSystem& system, const Substep& now, const Course& course,
                      const FeatureState& own, int span, FloorProfile& tensions);
  /// Visits the active spans of ropes with weight and friction, with their places in a state or -1.
  template <class Visit>
  static void for_each_span(const CableSystem& system, const Substep& now, const Course& course,
                            Visit visit);

  CableSystem& s_;
};

}  // namespace sheave
