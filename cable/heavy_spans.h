#pragma once
// The spans of ropes with weight in a substep; internal to the cable library. The derivation is in
// cable/cable_weight.cpp.

#include <array>
#include <vector>

#include "cable/cable_system.h"
#include "cable/hanging_rope.h"
#include "cable/heavy_runs.h"
#include "engine/index.h"

namespace sheave {

/// The part of a CableSystem that moves ropes with weight.
class HeavySpans {
 public:
  explicit HeavySpans(CableSystem& system) : s_(system) {}

  /// Keeps a span at the start of the substep.
  void begin(const Substep& substep, int k, const SpanGeometry& span);
  /// Appends two rows per span: its law, and its load.
  void linearise(const Substep& substep, const CompiledCable& cable, RowList& rows);
  double sweep(Substep& substep, const CompiledCable& cable);
  /// The span at the end of the substep, with its unstretched transport: strain moves with it.
  SpanTransport transport(const Substep& substep, int k, const SpanGeometry& span,
                          const SpanTransport& arcs, FeatureState& next);
  /// The first link whose wheel a rope with weight has left at the end of the substep; -1: none. The
  /// model holds such a rope on its wheels, and would let it pull them from behind.
  [[nodiscard]] int left_wheel(const FeatureState& next) const;
  /// Why the floor of a rope does not hold any more: cable/heavy_floor.cpp. Empty: it holds.
  [[nodiscard]] static std::string floor_fault(const CableSystem& system, const Substep& substep);
  // Spans that share rope: cable/heavy_run_rows.cpp.
  /// Finds the chord tension of a span under the multiplier at the end of the substep, and returns its
  /// mean over the substep [N]; 0: the span shares no rope.
  double settle_tension(const Substep& substep, int k);
  /// Writes into run_work_.spare, per span of the run, the rest length that has to leave the span for
  /// the run to rest on its links [m], and the larger end tensions there.
  void find_spare(const Substep& substep, const CompiledCable& cable, cable_parts::Run run,
                  const FeatureState& own);
  /// Keeps the larger end tension of a span with this rest length [m] and chord tension [N].
  /// Returns the tension, which is not below that of a rope that lies slack on its floor.
  double keep_tension(const Substep& substep, int k, const SpanGeometry& span, double rest_length,
                      double tension);

 private:
  /// Tension without the damper's force; the multiplier is that of a `share` of the substep;
  /// with a share of 0 the tension is that of the length.
  [[nodiscard]] double tension_of(const Substep& substep, int k, const HangingSpan& hanging,
                                  double value, double share) const;
  /// The part of a span's change on which its damper acts [m]: the change of its `value` [m], without
  /// the stretch of the rope that has come onto it, `came` [m, unstretched].
  [[nodiscard]] double damped_change(int k, double value, double came) const {
    const cable_parts::HangingStart& start = s_.hanging_[at(k)];
    return value - start.value + start.strain * came;
  }
  /// Whether rope passes the link from one span to the other.
  [[nodiscard]] bool passes(const CompiledCable& cable, int link) const;
  /// Force of the damper per rate of the chord [N s/m].
  [[nodiscard]] double damper_of(const CompiledCable& cable, int k, double rest_length) const {
    return cable.damper(rest_length) * s_.hanging_[at(k)].damper_share;
  }
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
  double sweep_span(Substep& substep, int k);
  double sweep_run(Substep& substep, const CompiledCable& cable, cable_parts::Run run);
  [[nodiscard]] std::vector<cable_parts::Run> runs_of(const CompiledCable& cable) const;
  /// The shape of a span in the present pose.
  [[nodiscard]] HeavyShape shape_of(const Substep& substep, int k, const SpanGeometry& span) const;
  /// Unstretched length over stretched length of the rope on a link, at the start of the substep.
  [[nodiscard]] double stored_share(int link) const;
  [[nodiscard]] std::vector<SharedSpan> shared_spans(const Substep& now, const CompiledCable& cable,
                                                     cable_parts::Run run,
                                                     const FeatureState& own) const;
  /// Finds the chord tension of the next span of run_, and its derivative by the unknown.
  void find_shared_tension(const Substep& substep, int k, const SpanGeometry& span);

  CableSystem& s_;
  /// The run whose rows are being made.
  struct RunRows {
    bool shares = false;  ///< whether it has several spans
    bool begun = false;
    RunTensions now;                    ///< in the present pose
    RunTensions then;                   ///< in the pose of the start of the substep
    Vector3 arrives = Vector3::Zero();  ///< direction of the rope that comes to the next link
    Vector3 arrived = Vector3::Zero();  ///< the same at the start of the substep
  };
  RunRows run_;
};

}  // namespace sheave
