#pragma once
// Data types of CableSystem: its warnings, and the scratch of its parts.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cable/cable.h"
#include "cable/catenary.h"
#include "cable/link_geometry.h"
#include "cable/span_row.h"
#include "cable/stored_strain.h"
#include "cable/wheel_rope.h"
#include "engine/followed_pressure.h"
#include "engine/math/portable.h"
#include "engine/substep.h"

namespace sheave {

struct CompiledCable;
struct CutPlace;

}  // namespace sheave

namespace sheave::cable_parts {

/// How a rigid cable that can break pulls.
struct BreakingPull {
  double mean = 0.0;     ///< largest tension, as the mean of the part just done [N]
  double impulse = 0.0;  ///< sum of its impulses in the stretch [N s]
  double now = 0.0;      ///< that breaks the cable or does not [N]
};

/// A span that had no tangent in some substeps since the system was created.
struct TangentWarning {
  std::string cable;
  int span = 0;  ///< within its cable's list; -1: behind a wrap
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A cable that touched more bodies than `most_wraps` allows, and passed through the others.
struct WrapWarning {
  std::string cable;
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A cable that lies on a wrappable body in a plane that its spans have left. A real rope on a
/// smooth body would have slid sideways to a shorter path.
struct LeanWarning {
  std::string cable;
  int body = 0;        ///< the body with the largest angle
  double angle = 0.0;  ///< largest angle between a span and the plane [rad]
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A cable that lay where no cable can lie: beyond the end of a bar, as on a longer bar, or along a
/// hollow part of a body.
struct MisplacedWarning {
  std::string cable;
  int body = 0;         ///< the body with the largest excess
  bool hollow = false;  ///< along a hollow part
  double beyond = 0.0;  ///< largest distance beyond the bar's end, or length along the hollow [m]
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A link at which the cable crosses itself at time 0. With the other winding it would not.
struct WindingWarning {
  std::string cable;
  int link = 0;      ///< within the cable's list
  std::string body;  ///< name of the link's body, or "world"
  Winding better = Winding::clockwise;
};

/// A link at which a drive stalled, cable slid although the link does not allow slip, or a taut
/// cable passed beside the groove.
struct LinkWarning {
  std::string cable;
  int link = 0;  ///< within its cable's list; -1: a wrap
  int body = 0;  ///< the link's body; the world has the last number
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// A drum whose rope exceeded its `most_fleet_angle`.
struct FleetWarning {
  LinkWarning drum;
  double angle = 0.0;  ///< largest fleet angle [rad]
  double limit = 0.0;  ///< [rad]
};

/// A sheath between two bodies whose ends were farther apart than its length.
struct SheathWarning {
  LinkWarning sheath;
  double apart = 0.0;   ///< largest distance of the ends [m]
  double length = 0.0;  ///< [m]
};

/// An attachment that has reached a wheel, a pinhole or the end of a sheath. The cable may leave the
/// wheel in the same substep, so the bodies are kept, too; their number is that of the world if it is
/// no body.
struct Arrival {
  int cable = -1;       ///< -1: none has
  int attachment = -1;  ///< link
  int attached = -1;    ///< body
  int wheel = -1;       ///< link
  int body = -1;        ///< of the wheel
  std::string_view place = "the wheel";
};

/// Of a span from an attachment to a wheel, a pinhole or a sheath, or back.
[[nodiscard]] Arrival arrival_on(const SpanSetup& span, const std::vector<LinkGeometry>& links);
/// The fault and its remedy.
[[nodiscard]] std::string sentence_of(const Arrival& arrival, const CompiledCable& cable,
                                      const BodySet& bodies);

/// The number of substeps in which something was observed, and the time of the first.
struct Fallback {
  long substeps = 0;
  double first_time = 0.0;  ///< [s]
};

/// Largest departure of a cable's wraps from the place where a wrap can lie (its plane, or its
/// body), and the body where the departure occurred.
struct Departure {
  Fallback observed;
  double last_time = 0.0;  ///< [s]
  double most = 0.0;       ///< sine of the largest angle, or largest length [m]
  int body = 0;

  /// Notes a departure by `far` at a time.
  void note(double time, double far, int on) {
    if (observed.substeps == 0) observed.first_time = time;
    if (last_time < time) ++observed.substeps;
    last_time = time;
    if (far <= most) return;
    most = far;
    body = on;
  }
};

struct Stall {
  bool now = false;  ///< in the last substep
  Fallback observed;
};

/// The observations of a CableSystem for its warnings. Events are kept elsewhere, because their
/// list only grows.
struct Notes {
  std::vector<Fallback> fallbacks;      ///< per span: substeps without a tangent
  std::vector<Fallback> crowded;        ///< per cable: wraps that found no place
  std::vector<Departure> leans;         ///< per cable: spans that have left the plane of a wrap
  std::vector<Departure> off_ends;      ///< per cable: geodesics beyond the end of a bar
  std::vector<Departure> hollows;       ///< per cable: geodesics along a hollow part of a body
  std::vector<Departure> fleets;        ///< per link: fleet angles above the limit; empty: no drums
  std::vector<Departure> torn_sheaths;  ///< per sheath: ends too far apart
  std::vector<Stall> stalls;            ///< per link
  std::vector<Stall> besides;           ///< per link: taut cable that passed beside the groove
  std::vector<Stall> slides_at;  ///< per link without slip: substeps in which cable slid over it
  bool slides = false;     ///< whether cable slides over such a link in this or in the last substep
  std::size_t events = 0;  ///< of a mark: the number of events at that time
  /// changes with every note except events; 0 of a mark that was never set
  std::uint64_t edition = 0;
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

/// The damper of a span in a run: cable/cable_damping.cpp.
struct SpanDamping {
  double start = 0.0;  ///< stretch at the start of the substep [m]; with a material the strain
  /// g: weight of the start in the stretch at the end, relative to weight 1 of the spring
  double share = 0.0;
  /// Stretch or strain at the end; `pull` is the stretch that a spring without a damper would have.
  [[nodiscard]] double end(double pull) const { return (pull + share * start) / (1.0 + share); }
};

/// State of one revision of slips: whether it makes one change at a time, whether that change has
/// been made, and whether a further one was refused.
struct SlipChanges {
  bool single = false;
  bool done = false;
  bool refused = false;
  bool means = false;  ///< from now on a link slides by the mean strains
};

/// The bearing of a wheel with inertia that loses tension: cable/cable_bearings.cpp.
struct Bearing {
  int link = 0;   ///< index among the links of all cables
  int rotor = 0;  ///< the wheel
  /// the spans before and behind the wheel in this substep; -1: none
  std::array<int, 2> spans{-1, -1};
  double pressed = 0.0;  ///< sum of the tensions on both sides, as multipliers of a whole substep
  /// The part of `pressed` that the rows of spans with weight do not have.
  double above = 0.0;
  FollowedPressure pressure;
  // Of a bearing whose pin has friction.
  /// directions from the wheel along both spans, where the rows were linearised
  std::array<Vector3, 2> away{Vector3::Zero(), Vector3::Zero()};
  std::array<double, 2> early{};  ///< multipliers of both spans before the impulses of `rattle`
};

/// Tensions with which open runs turn the wheels between their spans: cable/cable_held.cpp.
struct GivenPulls {
  std::vector<double> pulls;       ///< ln(h^2 tension), per span that begins such a run
  std::vector<double> before;      ///< scratch
  int changes = 0;                 ///< number of changes in this substep
  bool knows_multipliers = false;  ///< whether a round of the solver has found multipliers
};

/// A run between two links that stick. Pulls are logarithms of multipliers.
struct Piece {
  enum class Kind {
    moves,  ///< bodies determine its tension
    /// rigid, and no body can lengthen it: its tension is undetermined between its neighbours'
    /// bounds
    open,
    too_long,   ///< rigid, no body can lengthen it, and it is slack
    too_short,  ///< rigid, no body can lengthen it, and it lacks cable
  };
  Run run;
  int last = 0;  ///< index of its last span
  Kind kind = Kind::moves;
  int link = -1;       ///< the link behind it if cable can pass there; -1: none
  bool turns = false;  ///< open, and its tensions turn a wheel over which it slides
  double first_pull = 0.0;
  double last_pull = 0.0;
  /// pull of its last span minus that of its first, unless its kind is Kind::moves
  double rise = 0.0;
  /// Friction times wrap angle at `link`; NaN: not computed yet.
  double grip = std::numeric_limits<double>::quiet_NaN();
  // For a piece that is too long or too short: the pull that each side would give it (NaN if that
  // side cannot feed it), the pieces that the pull comes from, and the sides that feed it.
  double from_before = std::numeric_limits<double>::quiet_NaN();
  double from_behind = std::numeric_limits<double>::quiet_NaN();
  std::size_t before = 0;
  std::size_t behind = 0;
  bool fed_before = false;
  bool fed_behind = false;
  bool served = false;
  // For a held piece: the least and the largest pull that the pieces behind it allow.
  double low = 0.0;
  double high = 0.0;
};

/// A span with the present radii of its links.
struct LayeredSpan {
  SpanSetup setup;
  LinkGeometry first;
  LinkGeometry second;
  SpanGeometry geometry;
  SpanTransport transport;
};

/// The row of a span of a cable with a material, without its gradient.
struct StretchedSpan {
  double value = 0.0;              ///< [m]
  double spring_length = 0.0;      ///< A: compliance x EA [m]
  double on = 0.0;                 ///< length of arc that comes onto its links [m, >= 0]
  std::array<double, 2> gained{};  ///< unstretched length that comes off its links [m, >= 0]
  double before = 0.0;             ///< rest length at the start plus the gained lengths [m]
  double start_strain = 0.0;       ///< >= 0
  double memory = 0.0;             ///< strain that the rope remembers at the start
  double length = 0.0;             ///< [m]
  std::array<double, 2> arcs{};    ///< arcs that have come off its links since the start [m]
  SpanDamping damping;             ///< if the span is part of a run
  double end_strain = 0.0;         ///< at the end of the substep, before its run shares cable; >= 0
  /// Rest length at the end with this strain [m].
  [[nodiscard]] double rest_length_at(double strain) const {
    return before - on / (1.0 + 0.5 * (start_strain + strain));
  }
};

/// A span of a rope with weight at the start of a substep: cable/cable_weight.cpp.
struct HangingStart {
  HangingRope rope;
  double value = 0.0;               ///< rest length - chord [m]
  double compliance = 0.0;          ///< of the span without weight [m/N]
  double strain = 0.0;              ///< of its chord tension, if the span ends on wheels
  double most = 0.0;                ///< larger tension of both ends at the end of the substep [N]
  WheelPlane wheels;                ///< at the start
  std::array<double, 2> strains{};  ///< of the rope at the ends of the straight tangent
  // As last evaluated in the substep.
  Vector3 direction = Vector3::Zero();  ///< of the straight tangent
  std::array<double, 2> arcs{};         ///< arcs that have come off its links since the start [m]
  std::array<double, 2> gained{};       ///< unstretched lengths of these arcs [m]
  /// Tensions at the ends of the straight tangent, less the chord tension [N]. With `rattle` they are
  /// the means of both ends of the substep.
  std::array<double, 2> above{};
  /// Unstretched lengths on its wheels beyond the points of the straight tangent, at the end [m].
  std::array<double, 2> beyond{};
  /// Square of the rope's stretch per displacement of the chord; sag takes the rest of it. At the
  /// start of the substep, and the mean or end value that the damper has.
  double began_share = 1.0;
  double damper_share = 1.0;
  // In a run of spans that share rope: cable/heavy_runs.cpp.
  Vector3 began = Vector3::Zero();  ///< direction of the straight tangent at the start
  struct Shared {
    double tension = 0.0;  ///< chord tension, as last evaluated [N]; 0: it shares no rope
    double weight = 1.0;   ///< its derivative by the tension of the run
  };
  Shared now;            ///< in the present pose
  Shared then;           ///< in the pose of the start of the substep
  double unknown = 0.0;  ///< tension of the run at which these were found [N]
  /// Whether rope runs out of the run into the span, because nothing holds it.
  bool runs_out = false;
};

/// One point of an arc over which cable with a material slides: cable/strained_arcs.cpp.
struct ArcNode {
  double share = 0.0;   ///< fraction of the arc
  double weight = 0.0;  ///< tension there relative to that of the run
  int slice = 0;        ///< the nodes of one slice form one piece of StoredStrain
  SpanDamping damping;  ///< g between those of the adjacent spans, e0 of the cable that lay there
  /// Strain there at a given strain of the run.
  [[nodiscard]] double end(double strain) const { return damping.end(weight * strain); }
};

/// Integrals over such an arc at a given strain of the run.
struct ArcSum {
  double unstretched = 0.0;  ///< unstretched length [m]
  /// Integral of the unstretched length times the strain per strain of the run [m].
  double pull = 0.0;
  double kept = 0.0;   ///< stretch that dampers alone would leave at the end [m]
  double slope = 0.0;  ///< decrease of the unstretched length per strain of the run [m]
};

/// The link behind a span of a run over which cable with a material slides.
struct SlidingArc {
  int link = -1;                 ///< -1: no cable slides there, or the link has no arc
  bool damped = false;           ///< the spans beside it have dampers
  double start = 0.0;            ///< length of the arc at the start of the substep [m]
  double length = 0.0;           ///< present length of the arc [m]
  StoredStrain::Piece before;    ///< the cable that lay there at the start
  std::size_t first_node = 0;    ///< index in RunWork::nodes
  std::size_t node_count = 0;    ///< > 0
  std::optional<double> strain;  ///< strain of the run at the end; none: the arc keeps its own
  double gain = 0.0;             ///< gain of unstretched length over the substep [m]
  /// Way of the surface under the cable towards the next span, over the substep [m]: the mean of
  /// the ways past both ends of the arc.
  double surface = 0.0;
  /// Unstretched length that cable lying still on that surface passes on [m].
  double carried = 0.0;
};

/// Effect of a drive on the rest lengths of a chain if the drive does its whole motion.
struct Pull {
  int link = 0;
  int span = -1;       ///< the span of a feed whose link is `link`; < 0: no feed
  int end = 0;         ///< the end of that span
  double way = 0.0;    ///< cable moved in the substep [m], < 0 draws cable in
  double speed = 0.0;  ///< speed at the end of the substep [m/s]
  double gross = 0.0;  ///< sum of all drawn and fed lengths, regardless of sign [m]
  /// part of `way` by which the drive moves ends of spans instead of cable [m]
  double way_of_points = 0.0;
  double speed_of_points = 0.0;
};

/// Spans between two links over which no cable passes.
struct Chain {
  int first_pull = 0;
  int pull_count = 0;
  double available = 0.0;  ///< length that can be drawn [m]
  bool moves = false;      ///< the limit is that no rest length may fall below 0
};

struct ChainLengths {
  double rest_length = 0.0;  ///< rest lengths, and cable on free drums at the ends [m]
  double length = 0.0;       ///< lengths of the spans [m]
  bool moves = false;        ///< the cable is elastic, or forces can move one of its links
};

/// Scratch of CableSystem::limit_drives().
struct DriveWork {
  std::vector<Chain> chains;
  std::vector<Pull> pulls;
  std::vector<std::array<DriveShare, 2>> feed_shares;  ///< per span, for its two ends
  std::vector<double> feed_rates;                      ///< per span that is fed [m/s]
  std::vector<char> stalled;                           ///< per link, in this substep
  /// per link: the direction in which its drive has stalled, as in the state
  std::vector<int> locked;
  std::vector<char> slid;  ///< per link, in this substep
};

/// Geometry of the spans, cached. Bodies do not move within begin() and within finish() of
/// CableSystem, so a span that has been found there stays valid.
class KnownSpans {
 public:
  /// Clears the cache and starts keeping spans.
  void expect(std::size_t count) {
    keeps_ = true;
    spans_.resize(count);
    known_.assign(count, 0);
  }
  const SpanGeometry& keep(int span, const SpanGeometry& geometry) {
    known_[static_cast<std::size_t>(span)] = 1;
    return spans_[static_cast<std::size_t>(span)] = geometry;
  }
  /// Null if the span is not in the cache.
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

/// Rounding error of the length that a span lacks or has to spare, relative to the scene's size.
inline constexpr double length_rounding = 1e-13;

/// Friction times wrap angle of a link in the first half of a substep of `rattle`. The forces of
/// springs are equal in both halves, so the tension ratio there is the mean of the ratios at both
/// ends.
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
  std::vector<RowTerm> gradient;  ///< per body; the member `body` is not used
  std::vector<double> spare, lengths, tensions;
  /// Per span of a rigid cable: its rest length at the end of the substep, before cable is shared.
  std::vector<double> rest_lengths;
  std::vector<SlidingArc> arcs;  ///< per span of the run: the arc behind it
  std::vector<ArcNode> nodes;    ///< of all arcs
  /// Per span of the run: the massless wheel behind it, on which cable with a material lies; -1: none.
  std::vector<int> wheels;
  bool has_wheels = false;       ///< there is such a wheel
  std::optional<double> strain;  ///< of the run at the end of the substep, with these wheels
  std::vector<char> rests;       ///< per link of the cable: no cable has passed over it
  std::vector<char> means;       ///< per link: it slides by the mean strains in this substep

  /// `count`: of the spans of the run.
  void clear_arcs(std::size_t count) {
    arcs.assign(count, SlidingArc{});
    wheels.assign(count, -1);
    has_wheels = false;
  }
};

}  // namespace sheave::cable_parts
