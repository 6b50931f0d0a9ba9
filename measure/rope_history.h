#pragma once
// Load history of the ropes in a run: bends over sheaves, cycles of tension, slack, travel on
// drums.
//
// A cable is divided into sections of equal unstretched lengths, which move along it as it runs.
// The place of a section's middle follows from the stored lengths of links and the rest lengths
// between them, counted from the cable's first end. A section that comes onto a wheel, or passes
// over it between two steps, is bent there once (straight, bent, straight). Its middle counts as
// moved to another place when it is there by a tenth of the section's length, so that rounding and
// small vibrations at an edge count nothing.
//
// The tension of a section is that at its middle. In a span of a rope with weight it is that of the
// catenary there (SpanReport::tension_at()). On a wheel it is the mean of the tensions with which the
// rope comes and goes; on a link at an end of the rope that of the neighbouring end of the span.
//
// A run stands for its repetitions. The first bend of a section that ends where it began follows
// the last one, and is a reverse bend if these two have opposite senses. The history reports events.
// A statement about a rope's life needs formulas (measure/rope_life.h).

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cable/simulation.h"
#include "measure/rainflow.h"
#include "measure/rope_life.h"

namespace sheave::measure {

/// Bends of one section by one sheave.
struct SectionBends {
  int link = 0;   ///< index in the cable's list
  int bends = 0;  ///< number of times that it has come onto the wheel
  /// Number of these at which it had last been bent in the opposite sense, on this wheel or on
  /// another.
  int reverse = 0;
  double diameter = 0.0;        ///< of the wheel, to the rope's centre line, at the last bend [m]
  double least_diameter = 0.0;  ///< the least of all bends, as on a drum with layers [m]
  double most_tension = 0.0;    ///< largest tension at a bend [N]
  double mean_tension = 0.0;    ///< mean over all bends [N]
  double simple_damage = 0.0;   ///< sum over simple bends; 0 without a RopeLife
  double reverse_damage = 0.0;  ///< sum over reverse bends
};

struct SectionHistory {
  double from = 0.0;  ///< unstretched position, from the cable's first end [m]
  double to = 0.0;    ///< [m]
  std::vector<SectionBends> bends;
  double most_tension = 0.0;   ///< [N]
  double least_tension = 0.0;  ///< [N]
  double mean_tension = 0.0;   ///< mean over all steps [N]
  /// Cycles of its tension, by rainflow counting of a repeated run: loading and unloading form one
  /// cycle (Rainflow::closed_cycles()). Cycles below 1/1000 of `most_tension` are left out.
  std::vector<LoadCycle> cycles;

  /// The bends of all wheels as those of one: sums, largest tension, least diameter.
  [[nodiscard]] SectionBends all_bends() const;
  /// Share of the life that the run takes; NaN if a formula has no value for one of the bends.
  [[nodiscard]] double damage() const;
};

struct SpanSlack {
  int span = 0;
  double longest = 0.0;  ///< longest time without tension [s]
  double deepest = 0.0;  ///< largest rest length - length [m]
};

/// Rope that was wound onto a drum or off it while this number of whole turns lay on it.
struct LayerTravel {
  int link = 0;
  int turns = 0;        ///< of a drum with a groove: whole layers
  double travel = 0.0;  ///< [m]
};

struct CableHistory {
  std::string cable;
  /// false: the cable is closed, cut, or has touched a wrappable body, and has no sections
  bool followed = true;
  /// Whether all sections are on the link or span at which they were at the start, or within a
  /// tenth of a section of its edge. Else the run cannot be repeated from its end.
  bool returned = true;
  std::vector<SectionHistory> sections;
  std::vector<SpanSlack> slack;  ///< of spans that have been slack
  std::vector<LayerTravel> layers;
};

/// Observes a run.
class RopeHistory {
 public:
  /// `sections`: number per cable, 1 ... 10000. `life`: sums damages, too.
  explicit RopeHistory(int sections, std::optional<RopeLife> life = {})
      : sections_(sections), life_(std::move(life)) {}
  /// To be called at the start and after every step. Tensions at time 0 are unknown and do not
  /// count.
  void observe(const Simulation& simulation);
  [[nodiscard]] std::vector<CableHistory> history() const;

 private:
  struct Bend {
    int link = 0;
    double tension = 0.0;
    double diameter = 0.0;
    Vector3 sense = Vector3::Zero();
  };
  struct Section {
    double middle = 0.0;   ///< [m]
    int place = -1;        ///< 2 k: on link k; 2 k + 1: on the span behind link k
    int start_place = -1;  ///< at the first observation
    bool returned = true;  ///< whether it is there again
    /// Axis about which it was bent last, by the right-hand rule along the cable; 0: not bent yet.
    Vector3 sense = Vector3::Zero();
    std::vector<SectionBends> bends;
    std::optional<Bend> first;  ///< of a section that began straight
    double most_tension = 0.0;
    double least_tension = 0.0;
    double mean_tension = 0.0;
    double observed = 0.0;  ///< number of observed tensions
    Rainflow tension;
  };
  struct Cable {
    CableHistory told;
    double section_length = 0.0;
    std::vector<Section> sections;
    std::vector<double> slack_since;  ///< per span [s]; < 0: it is not slack
    std::vector<double> stored;       ///< per link, at the step before
  };

  void begin(const std::vector<CableReport>& reports);
  void follow(const CableReport& report, bool tensions_known, Cable& cable) const;
  void count_bend(const Bend& bend, Section& section) const;
  /// Counts a bend as a reverse or a simple one, and its damage.
  void add_kind(const Bend& bend, bool reverse, SectionBends& on) const;
  /// The bends of a run that repeats.
  [[nodiscard]] std::vector<SectionBends> repeated_bends(const Section& section) const;
  static void watch_slack(const CableReport& report, double time, Cable& cable);
  static void watch_drums(const CableReport& report, Cable& cable);

  int sections_;
  std::optional<RopeLife> life_;
  std::vector<Cable> cables_;
};

}  // namespace sheave::measure
