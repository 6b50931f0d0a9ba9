#pragma once
// The tensions of a rope in sheaths, by the positions alone; internal to the cable library. The
// derivation is in cable/sheath_tensions.cpp.

#include <vector>

#include "cable/cable_parts.h"
#include "cable/sheath_work.h"

namespace sheave {

/// A span of the rope at the present positions.
struct SheathPart {
  int span = 0;
  cable_parts::StretchedSpan stretched;
  int sheath_before = -1;  ///< index in CableWork::sheaths_; -1: none
  int sheath_behind = -1;
  double weight = 1.0;      ///< tension over that of its group
  double tension = 0.0;     ///< by the law [N]
  double compliance = 0.0;  ///< of the law there [m/N]
  double gap = 0.0;         ///< of a slack span: length to spare [m]
};

/// Parts whose rope slides as a whole through the sheaths between them: they share a tension.
struct SheathGroup {
  std::size_t first = 0;
  std::size_t count = 1;
};

/// The law of one rope. All functions take all parts of the rope in their order.
class SheathTensions {
 public:
  /// `sheaths` of all ropes, which must outlive this object; `yield`: 1 / EA of the rope [1/N].
  SheathTensions(std::vector<cable_parts::SheathWork>& sheaths, double yield)
      : sheaths_(sheaths), yield_(yield) {}

  /// The groups by SheathWork::slides; sets the weights of the parts.
  [[nodiscard]] std::vector<SheathGroup> groups_of(std::vector<SheathPart>& parts) const;
  /// Finds tensions and compliances with SheathWork::slides as given.
  void solve(std::vector<SheathPart>& parts) const;
  /// Finds which sheaths slide as a whole as well.
  void solve_freely(std::vector<SheathPart>& parts);
  /// Finds the profiles at the end, and the rope that has come in at both ends of each sheath.
  void settle(const std::vector<SheathPart>& parts);

 private:
  /// Rope that a sheath gains at one end [m], and the decrease of this gain by the tension there.
  struct Gain {
    double length = 0.0;
    double slope = 0.0;
  };

  void solve_group(std::vector<SheathPart>& parts, const SheathGroup& group) const;
  /// Sum of the lengths that a group lacks under a tension [m], and its decrease per tension.
  [[nodiscard]] Gain missing(const std::vector<SheathPart>& parts, const SheathGroup& group,
                             double tension) const;
  [[nodiscard]] Gain boundary_gain(const std::vector<SheathPart>& parts, std::size_t part,
                                   bool behind, double tension) const;
  /// How far the ratio of the tensions beside a sheath whose rope sticks is beyond that of its friction,
  /// or how far rope that slides as a whole moves against it; above 0 where the state of the sheath
  /// behind the part must change.
  [[nodiscard]] double excess_of(const std::vector<SheathPart>& parts, std::size_t part) const;
  /// Finds the rope that has come in at both ends of each sheath.
  void find_flows(const std::vector<SheathPart>& parts);

  std::vector<cable_parts::SheathWork>& sheaths_;
  double yield_;
};

}  // namespace sheave
