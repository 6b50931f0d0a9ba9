#pragma once
// The spans of ropes with weight in a substep; internal to the cable library. The derivation is in
// cable/cable_weight.cpp.

#include <array>

#include "cable/cable_system.h"
#include "cable/hanging_rope.h"

namespace sheave {

/// The part of a CableSystem that moves ropes with weight.
class HeavySpans {
 public:
  explicit HeavySpans(CableSystem& system) : s_(system) {}

  /// Keeps a span at the start of the substep.
  void begin(const Substep& substep, int k, const SpanGeometry& span);
  /// Appends two rows per span: its law, and its load.
  void linearise(const Substep& substep, const CompiledCable& cable, RowList& rows);
  double sweep(Substep& substep, int k);
  /// The span at the end of the substep, with its unstretched transport: strain moves with it.
  SpanTransport transport(const Substep& substep, int k, const SpanGeometry& span,
                          const SpanTransport& arcs, FeatureState& next);
  /// The first link whose wheel a rope with weight has left at the end of the substep; -1: none. The
  /// model holds such a rope on its wheels, and would let it pull them from behind.
  [[nodiscard]] int left_wheel(const FeatureState& next) const;
  /// Keeps the larger end tension of a span with this rest length [m] and chord tension [N].
  void keep_tension(const Substep& substep, int k, const SpanGeometry& span, double rest_length,
                    double tension);

 private:
  /// Tension without the damper's force; the multiplier is that of a `share` of the substep;
  /// with a share of 0 the tension is that of the length.
  [[nodiscard]] double tension_of(const Substep& substep, int k, const HangingSpan& hanging,
                                  double value, double share) const;
  HangingSpan evaluate(const Substep& substep, int k, Row& row);
  /// A span on wheels, with the arcs that have come off them since the start [m]. `mean`: the tension
  /// is the mean over the substep.
  [[nodiscard]] HangingSpan on_wheels(const Substep& substep, int k, const SpanGeometry& span,
                                      const std::array<double, 2>& arcs, double share,
                                      bool mean) const;
  [[nodiscard]] std::array<double, 2> gained(int k, const std::array<double, 2>& arcs,
                                             const std::array<double, 2>& strains) const;
  void load(const Substep& substep, int k, const HangingSpan& hanging, Row& row) const;
  /// The rope stored on a link, as the spans at both sides were last evaluated; [N].
  [[nodiscard]] StoredLoad stored_on(const CompiledCable& cable, int link, double weight) const;

  CableSystem& s_;
};

}  // namespace sheave
