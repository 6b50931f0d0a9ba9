#pragma once
// The compiled cables of a world, and the scratch of a substep.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cable/affine_span.h"
#include "cable/cable.h"
#include "cable/cable_parts.h"
#include "cable/cable_report.h"
#include "cable/compiled_cable.h"
#include "cable/knot_work.h"
#include "cable/running_cable.h"
#include "cable/sheath_work.h"
#include "cable/span_row.h"
#include "cable/stored_strain.h"
#include "engine/constraint_batch.h"

namespace sheave {

class CableCompiler;
class CableSystem;
class CableTransfer;
class DrumGrooves;
class FloorFriction;
class HeavySpans;
class Knots;
class MasslessWheels;
class RopeInertia;
class RopeMemories;
class Sheaths;

namespace cable_parts {

/// The working data of CableSystem, which is not part of any state: begin() fills it from the state
/// at the start of a substep.
class CableWork {
  friend class sheave::CableCompiler;
  friend class sheave::CableSystem;
  friend class sheave::CableTransfer;
  friend class sheave::DrumGrooves;
  friend class sheave::FloorFriction;
  friend class sheave::HeavySpans;
  friend class sheave::Knots;
  friend class sheave::MasslessWheels;
  friend class sheave::RopeInertia;
  friend class sheave::RopeMemories;
  friend class sheave::Sheaths;

  using StretchedSpan = cable_parts::StretchedSpan;
  using Fallback = cable_parts::Fallback;
  using Notes = cable_parts::Notes;
  using Run = cable_parts::Run;
  using RunWeights = cable_parts::RunWeights;
  using Piece = cable_parts::Piece;
  using LayeredSpan = cable_parts::LayeredSpan;
  using SpanDamping = cable_parts::SpanDamping;
  using SlidingArc = cable_parts::SlidingArc;
  using Pull = cable_parts::Pull;
  using Chain = cable_parts::Chain;
  using ChainLengths = cable_parts::ChainLengths;
  using Stall = cable_parts::Stall;

  enum class Held { given, reported };
  struct Geometry {
    std::vector<LinkGeometry> links;
    std::vector<SpanSetup> spans;
  };

  std::vector<CompiledCable> cables_;
  std::vector<LinkGeometry> definitions_;    ///< as compiled
  std::vector<int> changing_links_;          ///< links whose geometry depends on the state
  std::vector<LinkGeometry> links_;          ///< in this substep
  std::vector<SpanSetup> span_definitions_;  ///< as compiled
  std::vector<SpanSetup> spans_;             ///< in this substep
  bool has_layers_ = false;                  ///< at least one link is a drum with layers
  bool course_changes_ = false;              ///< the course of a cable depends on the state
  bool driven_ = false;                      ///< a cable has driven links
  std::vector<CableControl> defined_;        ///< per cable, as compiled
  bool controlled_ = false;                  ///< cables_ are not as compiled
  bool controls_links_ = false;              ///< links_ are not as compiled
  /// the integers of the state from which spans_ were connected
  std::vector<std::int64_t> connected_for_;
  std::vector<double> planes_;  ///< the planes of wraps in that state
  /// per link: its index among the links with stored strain, or -1
  std::vector<int> strain_places_;
  FeatureState initial_;
  std::vector<AffineSpan> affine_;  ///< per span of spans_; empty: not known yet
  MovingSpans moving_;  ///< used if all spans are affine; the members below are scratch of begin()
  std::vector<char> is_affine_;  ///< per span, in this substep
  std::uint32_t edition_ = 0;    ///< changes with the rows of affine spans
  /// substep length and share of loads for which that edition was made
  std::array<double, 2> edition_is_for_{};
  cable_parts::KnownSpans known_;
  std::vector<SpanReference> references_;
  std::vector<double> strains_;  ///< per span, at the start; of cables with a material
  /// per span, at the end, where a run has one strain; < 0: the span has its own
  std::vector<double> end_strains_;
  std::vector<double> multipliers_;
  std::vector<double> start_tensions_;  ///< per span [N]
  cable_parts::GivenPulls given_;
  std::vector<cable_parts::Bearing> bearings_;
  std::vector<int> bearing_places_;         ///< per link: its index in bearings_, or -1
  std::vector<std::size_t> row_places_;     ///< scratch: per span, the index of its row
  std::vector<std::array<double, 2>> fed_;  ///< per span and end: length fed in this substep [m]
  std::vector<int> slip_;  ///< per link: direction in which it slides (see CableStateLayout)
  std::vector<int> pending_slip_;
  cable_parts::SlipChanges slip_changes_;
  std::vector<int> kept_slip_;  ///< slip_ before impulses changed it; empty: not changed
  std::vector<int> kept_flips_;
  std::vector<char> held_;  ///< per link: it passes nothing although it has no friction
  std::vector<int> revised_;
  /// Per span, for finish(): tension at the start [N], length at the end of the substep [m].
  std::vector<std::array<double, 2>> ends_;
  bool knows_lengths_ = false;            ///< whether ends_ has the lengths of the spans
  std::vector<int> sweeps_;               ///< per cable, in this substep
  std::vector<int> flips_;                ///< per link: number of changes of slip_ in this substep
  std::vector<double> stored_arcs_;       ///< per link: stretched stored length at the start [m]
  std::vector<StoredStrain> stored_;      ///< per strain place, at the start
  std::vector<StoredStrain> stored_end_;  ///< per strain place, at the end
  Row row_;                               ///< scratch of solve_span()
  cable_parts::LayeredSpan layered_;      ///< scratch of finish()
  cable_parts::DriveWork drive_work_;
  cable_parts::RunWork run_work_;
  std::vector<cable_parts::Piece> pieces_;  ///< of one cable
  // For `rattle`, whose multipliers act in part along the directions at the start of the substep.
  bool knows_start_ = false;
  /// per damped row: its value at the start, and its compliance
  std::vector<std::array<double, 2>> start_values_;
  std::vector<cable_parts::HangingStart> hanging_;  ///< per span
  bool weighs_ = false;                             ///< some cable has weight
  std::vector<cable_parts::SheathWork> sheaths_;
  std::vector<cable_parts::KnotWork> knots_;
  std::vector<char> knotted_;       ///< per span, if there are knots: it is in an arm of a knot
  std::vector<int> sheath_places_;  ///< per link: its index in sheaths_, or -1
  std::vector<int> memory_places_;  ///< per span: its index among those with memory, or -1
  /// Per span with memory, at the start: the strain that its rope remembers, and the rope's strain.
  std::vector<std::array<double, 2>> memories_;
  std::vector<int> floor_places_;   ///< per span: its index in laid_, or -1
  std::vector<FloorProfile> laid_;  ///< rope on floors with friction, at the start
  int stray_ = -1;  ///< span that lies on such a floor away from an anchor; -1: none
  /// per span of cables with friction: the span as last evaluated
  std::vector<SpanGeometry> start_spans_;
  std::vector<double> start_exponents_;  ///< per link: friction times wrap angle at the start
  // For leave_and_touch(): the side of its candidates on which each span was at the start; per lifted
  // link, whether a span beside it was on the side of its winding then; and the links and bodies that
  // the cable has left.
  std::vector<std::vector<WrapSide>> sides_;
  std::vector<char> faces_;
  std::vector<char> changed_links_;
  std::vector<int> left_bodies_;
  // Diagnostics, no part of the simulation.
  cable_parts::Notes notes_;                        ///< without the events
  std::array<cable_parts::Notes, 4> marked_notes_;  ///< per NoteMark
  std::vector<GeodesicLink> geodesic_starts_;  ///< per link: its geodesic at the substep's start
  std::vector<double> geodesic_lengths_;       ///< per link [m]; NaN without a geodesic
  std::vector<char> clear_grips_;              ///< in the order of for_each_grip()
  /// Per cable; of rigid cables that can break.
  std::vector<cable_parts::BreakingPull> pulls_;
  /// Largest excess of a tension over the breaking tension of its cable since expect() [N].
  double overload_ = -std::numeric_limits<double>::infinity();
  int left_ = -1;  ///< link whose wheel a rope with weight has left in this substep; -1: none
  cable_parts::Arrival arrived_;  ///< the last one in this substep
  std::vector<CableEvent> events_;
  std::vector<cable_parts::WindingWarning> winding_warnings_;
};

}  // namespace cable_parts
}  // namespace sheave
