#pragma once
// The least margins of a run (measure/branch_margins.h): how near the motion came to another branch.
//
// A margin that becomes 0 is no near miss but a change of the branch, and so are the values just before
// it. Therefore only local minima count whose neighbours belong to the same branch, and the value at
// the end of the run. A length is taken for a parabola of three samples, so its
// least value is known although it lies between two of them. Forces may jump, and have no such value.
//
// A run with a tolerance may return to an earlier substep: samples of a motion that is undone are dropped.

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "measure/branch_margins.h"

namespace sheave::measure {

/// How near a run came to the other branch of an alternative.
struct LeastMargin {
  double margin = 0.0;  ///< in the unit of the branch
  double time = 0.0;    ///< [s]
};

/// Of one alternative in one run.
struct BranchRecord {
  /// While the motion was in the first branch, and in the second.
  std::array<std::optional<LeastMargin>, 2> least{};
  /// Time at which the branch changed first [s].
  std::optional<double> first_change{};
  bool second_at_end = false;
  std::array<bool, 2> visited{};  ///< branches
};

class MarginWatch {
 public:
  /// To be called after every substep; a second call at one time changes nothing.
  void observe(const Simulation& run, BranchReader& reader);
  /// To be called after every step, behind observe().
  void end_step();
  /// With the present state as the end of the run.
  [[nodiscard]] std::map<AlternativeKey, BranchRecord> records() const;

 private:
  struct Sample {
    double time = 0.0;
    std::vector<BranchMargin> margins;
  };
  struct Course {
    BranchRecord record;
    // The last three samples, the newest first; `count` of them are of this branch and known.
    std::array<LeastMargin, 3> last{};
    int count = 0;
    bool second = false;
    bool begun = false;
    double seen = 0.0;  // time of the last sample [s]
  };
  static void add(const BranchMargin& margin, double time, double before, Course& course);

  std::vector<Sample> pending_;  // of this step
  std::map<AlternativeKey, Course> courses_;
  double time_ = 0.0;  // of the last sample that is final [s]
};

}  // namespace sheave::measure
