#pragma once
// What CableSystem tells and computes with, part by part.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cable/cable.h"
#include "cable/link_geometry.h"
#include "cable/span_row.h"
#include "cable/stored_strain.h"
#include "engine/followed_pressure.h"
#include "engine/math/portable.h"
#include "engine/substep.h"

namespace sheave::cable_parts {

/// A span that had no tangent in some substeps since the system was created.
struct TangentWarning {
  std::string cable;
  int span = 0;  ///< within its cable's list; -1: behind a wrap
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A cable that touched more bodies than `most_wraps` allows: it passed through the others.
struct WrapWarning {
  std::string cable;
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A cable that lies on a wrappable body in a plane which its spans have left: a rope on a smooth
/// body would have slid sideways to a shorter way.
struct LeanWarning {
  std::string cable;
  int body = 0;        ///< on which it was farthest off
  double angle = 0.0;  ///< largest between a span and the plane [rad]
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A link at which the cable crosses itself at time 0 and would not with the other winding.
struct WindingWarning {
  std::string cable;
  int link = 0;      ///< within the cable's list
  std::string body;  ///< that the link is on, or "world"
  Winding better = Winding::clockwise;
};

/// A link at which something happened that nobody asked for.
struct LinkWarning {
  std::string cable;
  int link = 0;  ///< within its cable's list; -1: a wrap
  int body = 0;  ///< that it is on; the world comes last
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// How often something has been observed, and when first.
struct Fallback {
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// How far spans have left the plane of a wrap, and on which body most.
struct Lean {
  Fallback observed;
  double last_time = 0.0;  ///< [s]
  double sine = 0.0;       ///< largest
  int body = 0;
};

struct Stall {
  bool now = false;  ///< in the last substep
  Fallback observed;
};

/// What a system of cables has noted for its reports. Its events, which only become more, are
/// elsewhere.
struct Notes {
  std::vector<Fallback> fallbacks;  ///< per span that had no tangent
  std::vector<Fallback> crowded;    ///< per cable: wraps that found no place
  std::vector<Lean> leans;          ///< per cable
  std::vector<Stall> stalls;        ///< per link
  std::vector<Stall> slides_at;     ///< per link: over which cable slid that ought not to
  bool slides = false;              ///< whether it does over any link, or did in the last substep
  std::size_t events = 0;           ///< of a mark: how many there were
  std::uint64_t edition = 0;  ///< changes with them, but for the events; of a mark before any 0
};

/// Spans first, first + 1, ... of a cable (cyclic if it is closed) that share one multiplier.
struct Run {
  int first = 0;
  int count = 0;
};

struct RunWeights {
  double now = 0.0;
  double start = 0.0;
};

/// What the damper of a span in a run does: cable/cable_damping.cpp.
struct SpanDamping {
  double start = 0.0;  ///< stretch at the start of the substep [m], or of a material its strain
  double share = 0.0;  ///< g, how much of that the end has, to the share 1 of the spring's
  /// Stretch or strain at the end, of a spring that had `pull` without a damper.
  [[nodiscard]] double end(double pull) const { return (pull + share * start) / (1.0 + share); }
};

/// Of a look at what slides: whether one change at a time is made, whether it has been, and whether
/// one would have been too many.
struct SlipChanges {
  bool single = false;
  bool done = false;
  bool refused = false;
  bool means = false;  ///< a link slides by the means of strains from now on
};

/// Of a wheel with inertia that loses tension: cable/cable_bearings.cpp.
struct Bearing {
  int link = 0;   ///< among those of all cables
  int rotor = 0;  ///< its wheel
  std::array<int, 2> spans{-1,
                           -1};  ///< before it and behind it, in this substep; -1: there is none
  double pressed = 0.0;  ///< sum of the tensions beside it, as multipliers of a whole substep
  FollowedPressure pressure;
};

/// With what open runs turn wheels between their spans: cable/cable_held.cpp.
struct GivenPulls {
  std::vector<double> pulls;       ///< logarithms of h^2 tension, per span that begins such a run
  std::vector<double> before;      ///< scratch
  int changes = 0;                 ///< in the substep
  bool knows_multipliers = false;  ///< whether a round has found some
};

/// A run, as the links that stick at its ends see it. Pulls are logarithms of multipliers.
struct Piece {
  enum class Kind {
    moves,      ///< bodies decide its tension
    open,       ///< rigid, and no body can lengthen it: its tension is what its neighbours hold
    too_long,   ///< the same, and slack
    too_short,  ///< the same, and cable has to come in
  };
  Run run;
  int last = 0;  ///< its last span
  Kind kind = Kind::moves;
  int link = -1;       ///< behind it, where cable can pass; -1: none
  bool turns = false;  ///< whether it is open and slides over a wheel that its tensions turn
  double first_pull = 0.0;
  double last_pull = 0.0;
  double rise = 0.0;  ///< of the pull from its first span to its last, where it is not Kind::moves
  /// Friction times wrap angle at `link`; NaN: not asked for yet.
  double grip = std::numeric_limits<double>::quiet_NaN();
  // Of one too long or too short: the pull that either side would give it, NaN if there is none,
  // the pieces where that comes from, and which of them do.
  double from_before = std::numeric_limits<double>::quiet_NaN();
  double from_behind = std::numeric_limits<double>::quiet_NaN();
  std::size_t before = 0;
  std::size_t behind = 0;
  bool fed_before = false;
  bool fed_behind = false;
  bool served = false;
  // Of one that is held: the pulls that what lies behind allows.
  double low = 0.0;
  double high = 0.0;
};

/// A span with the radii that its links have now.
struct LayeredSpan {
  SpanSetup setup;
  LinkGeometry first;
  LinkGeometry second;
  SpanGeometry geometry;
  SpanTransport transport;
};

/// The row of a span of a material, but for its gradient.
struct StretchedSpan {
  double value = 0.0;              ///< [m]
  double spring_length = 0.0;      ///< A: compliance x EA [m]
  double on = 0.0;                 ///< arc that comes onto its links [m, >= 0]
  std::array<double, 2> gained{};  ///< unstretched length that comes off its links [m, >= 0]
  double before = 0.0;             ///< rest length at the start, and what was gained [m]
  double start_strain = 0.0;       ///< >= 0
  double length = 0.0;             ///< [m]
  std::array<double, 2> arcs{};    ///< that have come off its links since the start [m]
  SpanDamping damping;             ///< of a run
};

/// A part of an arc over which cable of a material slides: cable/strained_arcs.cpp.
struct ArcNode {
  double share = 0.0;   ///< of the arc
  double weight = 0.0;  ///< tension there over that of the run
  int slice = 0;        ///< nodes of one are one piece of StoredStrain
};

/// What covers such an arc at a strain of the run.
struct ArcSum {
  double unstretched = 0.0;  ///< [m]
  double pull = 0.0;         ///< the same times its tension over that of the run [m]
  double slope = 0.0;        ///< by how much less it is, per strain of the run [m]
};

/// The link behind a span of a run, where cable of a material slides.
struct SlidingArc {
  int link = -1;                 ///< -1: nothing slides there, or it has no arc
  double start = 0.0;            ///< at the start of the substep [m]
  double length = 0.0;           ///< now [m]
  StoredStrain::Piece before;    ///< what lay there at the start
  std::size_t first_node = 0;    ///< in RunWork::nodes
  std::size_t node_count = 0;    ///< > 0
  std::optional<double> strain;  ///< of the run at the end; none: it keeps its own
  double gain = 0.0;             ///< unstretched, over the substep [m]
};

/// What a drive does to the rest lengths of a chain if it does its whole share.
struct Pull {
  int link = 0;
  int span = -1;               ///< of a feed, whose link this is; else < 0
  int end = 0;                 ///< and at which of its ends
  double way = 0.0;            ///< in the substep [m], < 0 draws
  double speed = 0.0;          ///< at its end [m/s]
  double gross = 0.0;          ///< of `way`, what is both drawn and fed counted twice [m]
  double way_of_points = 0.0;  ///< part of the above that moves spans' ends instead
  double speed_of_points = 0.0;
};

/// Spans between two links over which no cable passes.
struct Chain {
  int first_pull = 0;
  int pull_count = 0;
  double available = 0.0;  ///< cable that can be drawn [m]
  bool moves = false;      ///< what limits it is that no rest length is below 0
};

struct ChainLengths {
  double rest_length = 0.0;  ///< and what is on free drums at its ends [m]
  double length = 0.0;       ///< of the spans [m]
  bool moves = false;        ///< elastic, or forces can move one of its links
};

/// Scratch of CableSystem::limit_drives().
struct DriveWork {
  std::vector<Chain> chains;
  std::vector<Pull> pulls;
  std::vector<std::array<DriveShare, 2>> feed_shares;  ///< per span, of its ends
  std::vector<double> feed_rates;                      ///< per span that is fed [m/s]
  std::vector<char> stalled;                           ///< per link, in this substep
  std::vector<int> locked;  ///< per link: which way its drive has stalled, as in the state
  std::vector<char> slid;   ///< per link, in this substep
};

/// Where spans are. Within begin() and within finish() of the system bodies stay where they are,
/// and what is found of the spans can be kept.
class KnownSpans {
 public:
  /// Begins anew.
  void expect(std::size_t count) {
    keeps_ = true;
    spans_.resize(count);
    known_.assign(count, 0);
  }
  const SpanGeometry& keep(int span, const SpanGeometry& geometry) {
    known_[static_cast<std::size_t>(span)] = 1;
    return spans_[static_cast<std::size_t>(span)] = geometry;
  }
  /// Null: it has not been kept.
  [[nodiscard]] const SpanGeometry* find(int span) const {
    const auto k = static_cast<std::size_t>(span);
    return keeps_ && known_[k] != 0 ? &spans_[k] : nullptr;
  }
  void forget() { keeps_ = false; }

 private:
  std::vector<SpanGeometry> spans_;
  std::vector<char> known_;
  bool keeps_ = false;
};

/// What rounding leaves of the length that a span lacks or has to spare, relative to the scene's
/// size.
inline constexpr double length_rounding = 1e-13;

/// Friction times wrap angle of a link in the first half of a substep of `rattle`. The forces of
/// springs are the same in both halves, so there it is the mean of the ratios of both ends.
[[nodiscard]] inline double early_exponent(bool rigid, double start, double end) {
  if (rigid || start == end) return start;
  return start + portable::log(0.5 * (1.0 + portable::exp(end - start)));
}

/// Scratch of the rows of runs.
struct RunWork {
  std::vector<Row> rows;
  std::vector<SpanGeometry> spans;
  std::vector<double> weights;
  std::vector<StretchedSpan> stretched;
  std::vector<SpanDamping> dampings;
  std::vector<RowTerm> gradient;  ///< per body; `body` is not used
  std::vector<double> spare, lengths, tensions;
  std::vector<SlidingArc> arcs;  ///< per span of the run, behind it
  std::vector<ArcNode> nodes;    ///< of all of them
  std::vector<char> rests;       ///< per link of the cable: nothing has passed over it
  std::vector<char> means;       ///< per link: in this substep it slides by the means of strains
};

}  // namespace sheave::cable_parts
