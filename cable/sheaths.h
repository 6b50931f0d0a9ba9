#pragma once
// Ropes in sheaths in a substep; internal to the cable library. The law of their tensions
// is cable/sheath_tensions.h.

#include <vector>

#include "cable/cable_system.h"
#include "cable/sheath_tensions.h"

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
  /// Moves rope between spans and sheaths, and notes sheaths whose ends are too far apart.
  void finish(const Substep& substep, const CompiledCable& cable, FeatureState& next);

  /// Sheaths between two bodies whose ends were farther apart than their length.
  [[nodiscard]] static std::vector<cable_parts::SheathWarning> warnings(const CableSystem& system);
  /// Appends points of the curve of a sheath [m]. A sheath between two bodies hangs like a slack rope.
  static void draw(const Substep& now, const LinkGeometry& link, std::vector<Vector3>& path);
  /// Distance of the ends of a sheath [m].
  [[nodiscard]] static double reach(const Substep& now, const LinkGeometry& link);

 private:
  /// Evaluates the row of a span and appends its part.
  void gather(const Substep& substep, int span, Row& row, std::vector<SheathPart>& parts) const;
  void gather_all(const Substep& substep, const CompiledCable& cable, std::vector<Row>& rows,
                  std::vector<SheathPart>& parts) const;
  [[nodiscard]] SheathTensions tensions(const CompiledCable& cable) const {
    return {s_.sheaths_, cable.inverse_stiffness};
  }
  void set_row(const SheathPart& part, double yield, bool tied, Row& row) const;
  double sweep_group(Substep& substep, const std::vector<SheathPart>& parts,
                     const SheathGroup& group, std::vector<Row>& rows);
  void note_reach(const Substep& substep, const cable_parts::SheathWork& sheath);
  /// Energy that friction takes in a sheath between two parts [J].
  static double loss_in(const cable_parts::SheathWork& sheath);

  CableSystem& s_;
};

}  // namespace sheave
