#pragma once
// What a run does to its ropes: bends over sheaves, cycles of tension, slack, travel on drums.
//
// A cable is divided into sections of equal unstretched lengths, which move along it as it runs:
// the place of a section's middle follows from what is stored on links and what lies between them,
// counted from the cable's first end. One that comes onto a wheel, or passes over it between two
// steps, is bent there once, with what follows when it comes off again: straight, bent, straight. Its
// middle has come to another place when it is there by a tenth of the section's length: where it
// lies at an edge, rounding and vibrations that are smaller than that move nothing. It says what has
// happened and claims no life of a rope by any standard.

#include <string>
#include <vector>

#include "cable/simulation.h"
#include "measure/rainflow.h"

namespace sheave::measure {

/// What one sheave has done to one section.
struct SectionBends {
  int link = 0;   ///< of the cable's list
  int bends = 0;  ///< how often it has come onto the wheel
  /// Of these, how often it had last been bent in the opposite sense, on this wheel or on another.
  int reverse = 0;
  double diameter = 0.0;      ///< of the wheel, to the rope's middle, when it last did [m]
  double most_tension = 0.0;  ///< at a bend [N]
  double mean_tension = 0.0;  ///< of all bends [N]
};

struct SectionHistory {
  double from = 0.0;  ///< unstretched, from the cable's first end [m]
  double to = 0.0;    ///< [m]
  std::vector<SectionBends> bends;
  double most_tension = 0.0;  ///< [N]
  /// Of its tension, by rainflow counting of a run that repeats: loading and unloading are one cycle
  /// (Rainflow::closed_cycles()). Those of less than a thousandth of `most_tension` are not told.
  std::vector<LoadCycle> cycles;
};

struct SpanSlack {
  int span = 0;
  double longest = 0.0;  ///< without tension [s]
  double deepest = 0.0;  ///< rest length less length [m]
};

/// Rope that has been wound onto a drum, or off it, while so many whole turns lay on it.
struct LayerTravel {
  int link = 0;
  int turns = 0;
  double travel = 0.0;  ///< [m]
};

struct CableHistory {
  std::string cable;
  bool followed = true;  ///< false: closed, or cut; there are no sections then
  std::vector<SectionHistory> sections;
  std::vector<SpanSlack> slack;  ///< of spans that have been slack
  std::vector<LayerTravel> layers;
};

/// Watches a run.
class RopeHistory {
 public:
  /// `sections`: of each cable, 1 ... 10000.
  explicit RopeHistory(int sections) : sections_(sections) {}
  /// To be called at the start and after every step. Tensions at time 0 are not known and not
  /// counted.
  void observe(const Simulation& simulation);
  [[nodiscard]] std::vector<CableHistory> history() const;

 private:
  struct Section {
    double middle = 0.0;  ///< [m]
    int place = -1;       ///< 2 k: on link k; 2 k + 1: on the span behind it
    /// About which axis it was bent last, by the right-hand rule along the cable; 0: not yet.
    Vector3 sense = Vector3::Zero();
    std::vector<SectionBends> bends;
    double most_tension = 0.0;
    Rainflow tension;
  };
  struct Cable {
    CableHistory told;
    double section_length = 0.0;
    std::vector<Section> sections;
    std::vector<double> slack_since;  ///< per span; < 0: it is not slack
    std::vector<double> stored;       ///< per link, of the step before
  };

  void begin(const std::vector<CableReport>& reports);
  static void follow(const CableReport& report, bool tensions_known, Cable& cable);
  static void watch_slack(const CableReport& report, double time, Cable& cable);
  static void watch_drums(const CableReport& report, Cable& cable);

  int sections_;
  std::vector<Cable> cables_;
};

}  // namespace sheave::measure
