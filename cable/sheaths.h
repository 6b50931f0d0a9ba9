#pragma once
// Ropes in sheaths in a substep; internal to the cable library. The derivation is in
// cable/sheaths.cpp.

#include <vector>

#include "cable/cable_system.h"
#include "cable/sheath_work.h"

namespace sheave {

/// The part of a CableSystem that moves ropes through sheaths.
class Sheaths {
 public:
  explicit Sheaths(CableSystem& system) : s_(system) {}

  /// Keeps the sheaths at the start of the substep.
  void begin(const Substep& substep, const FeatureState& state);
  /// Appends a row per span; the rows beside a sheath through which the whole rope slides are tied.
  void linearise(const Substep& substep, const CompiledCable& cable, RowList& rows);
  double sweep(Substep& substep, const CompiledCable& cable);
  /// Whether the rope of a sheath has come to slide as a whole, or to stick, since the last round.
  bool revise(const Substep& substep, const CompiledCable& cable);
  /// Finds the strains of the spans at the end of the substep.
  void keep_end_strains(const Substep& substep, const CompiledCable& cable);
  /// Moves rope between spans and sheaths.
  void finish(const CompiledCable& cable, FeatureState& next);

 private:
  /// A span of the rope at the present positions.
  struct Part {
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
  struct Group {
    std::size_t first = 0;
    std::size_t count = 1;
  };
  /// Rope that a sheath gains at one end [m], and the decrease of this gain by the tension there.
  struct Gain {
    double length = 0.0;
    double slope = 0.0;
  };

  /// Evaluates the row of a span and appends its part.
  void gather(const Substep& substep, int span, Row& row, std::vector<Part>& parts) const;
  void gather_all(const Substep& substep, const CompiledCable& cable, std::vector<Row>& rows,
                  std::vector<Part>& parts) const;
  /// Finds tensions and compliances with SheathWork::slides as given.
  void solve(std::vector<Part>& parts) const;
  /// Finds which sheaths slide as a whole as well.
  void solve_freely(std::vector<Part>& parts);
  void solve_group(std::vector<Part>& parts, const Group& group) const;
  /// Sum of the lengths that a group lacks under a tension [m], and its decrease per tension.
  [[nodiscard]] Gain missing(const std::vector<Part>& parts, const Group& group,
                             double tension) const;
  [[nodiscard]] Gain boundary_gain(const std::vector<Part>& parts, std::size_t part, bool behind,
                                   double tension) const;
  [[nodiscard]] std::vector<Group> groups_of(std::vector<Part>& parts) const;
  void set_row(const Part& part, double yield, bool tied, Row& row) const;
  double sweep_group(Substep& substep, const std::vector<Part>& parts, const Group& group,
                     std::vector<Row>& rows);
  /// Finds the profiles at the end, and the rope that has come in at both ends of each sheath.
  void settle(std::vector<Part>& parts);
  /// Energy that friction takes in a sheath between two parts [J].
  static double loss_in(const cable_parts::SheathWork& sheath);

  CableSystem& s_;
};

}  // namespace sheave
