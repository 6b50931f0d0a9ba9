#pragma once
// Load history of the ropes in a run: bends over sheaves, cycles of tension, slack, travel on
// drums.
//
// A cable is divided into sections of equal unstretched lengths, which move along it as it runs.
// The place of a section's middle follows from the stored lengths of links and the rest lengths
// between them, counted from the cable's first end. A section that comes onto a wheel, or passes
// over it between two steps, is bent there once (straight, bent, straight). Its middle counts as
// moved to another place when it is there by a tenth of the section's length, so that rounding and
// small vibrations at an edge count nothing. The history reports events and makes no statement
// about a rope's life by any standard.

#include <string>
#include <vector>

#include "cable/simulation.h"
#include "measure/rainflow.h"

namespace sheave::measure {

/// Bends of one section by one sheave.
struct SectionBends {
  int link = 0;   ///< index in the cable's list
  int bends = 0;  ///< number of times that it has come onto the wheel
  /// Number of these at which it had last been bent in the opposite sense, on this wheel or on
  /// another.
  int reverse = 0;
  double diameter = 0.0;      ///< of the wheel, to the rope's centre line, at the last bend [m]
  double most_tension = 0.0;  ///< largest tension at a bend [N]
  double mean_tension = 0.0;  ///< mean over all bends [N]
};

struct SectionHistory {
  double from = 0.0;  ///< unstretched position, from the cable's first end [m]
  double to = 0.0;    ///< [m]
  std::vector<SectionBends> bends;
  double most_tension = 0.0;  ///< [N]
  /// Cycles of its tension, by rainflow counting of a repeated run: loading and unloading form one
  /// cycle (Rainflow::closed_cycles()). Cycles below 1/1000 of `most_tension` are left out.
  std::vector<LoadCycle> cycles;
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
  bool followed = true;  ///< false: the cable is closed or cut, and has no sections
  std::vector<SectionHistory> sections;
  std::vector<SpanSlack> slack;  ///< of spans that have been slack
  std::vector<LayerTravel> layers;
};

/// Observes a run.
class RopeHistory {
 public:
  /// `sections`: number per cable, 1 ... 10000.
  explicit RopeHistory(int sections) : sections_(sections) {}
  /// To be called at the start and after every step. Tensions at time 0 are unknown and do not
  /// count.
  void observe(const Simulation& simulation);
  [[nodiscard]] std::vector<CableHistory> history() const;

 private:
  struct Section {
    double middle = 0.0;  ///< [m]
    int place = -1;       ///< 2 k: on link k; 2 k + 1: on the span behind link k
    /// Axis about which it was bent last, by the right-hand rule along the cable; 0: not bent yet.
    Vector3 sense = Vector3::Zero();
    std::vector<SectionBends> bends;
    double most_tension = 0.0;
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
  static void follow(const CableReport& report, bool tensions_known, Cable& cable);
  static void watch_slack(const CableReport& report, double time, Cable& cable);
  static void watch_drums(const CableReport& report, Cable& cable);

  int sections_;
  std::vector<Cable> cables_;
};

}  // namespace sheave::measure
