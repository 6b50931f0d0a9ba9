#pragma once
// Wheels without inertia, which turn exactly as far as cable passes over them; internal to the cable
// library.
//
// Cable of a material does not slip on such a wheel either. The cable comes onto the rim with the strain
// of one span, lies there, and comes off with the strain with which it lies (cable/stored_strain.h). Both
// ends of the arc move by the same way of the rim. Let p be the unstretched length that leaves the span
// before the wheel, q the one that comes into the span behind it, both positive in the direction of the
// cable, e and e' the strains of these spans, and w the strain of the cable that comes off. Then
//
//   way = p (1 + e) = integral of (1 + w) dq     (p > 0),
//   way = integral of (1 + w) dp = q (1 + e')    (p < 0).
//
// The wheel keeps p - q. The unstretched length of the run is that of its spans and wheels, so the
// function F(e) of cable/cable_material.cpp loses the sum of p - q, with the lengths p that F itself finds
// from the first span on. The strains e and e' are means of the substep, as for cable that comes onto
// other wheels.
//
// A wheel without losses keeps turning at the rate of the last substep while the rows are solved, so
// cable comes on and off there as on any wheel. Only the rest passes afterwards, without lying on the
// rim. A wheel with losses stands until then, and all cable passes afterwards. Only on these wheels is
// p - q counted here. Without it their rope would keep the strain of the start for ever: 0.6 % of the
// tension of a winch that draws over two sheaves.

#include <optional>
#include <span>
#include <vector>

#include "cable/cable_system.h"

namespace sheave {

/// Cable that has passed a wheel.
struct Rolled {
  double length = 0.0;  ///< q: unstretched, into the span behind [m]
  double way = 0.0;     ///< of the rim, towards the span behind [m]
  double rate = 1.0;    ///< dq / dp
};

/// `passed`: p [m]; `before`, `behind`: strains of the adjacent spans.
[[nodiscard]] Rolled roll(const StoredStrain& stored, double passed, double before, double behind);

/// The part of a CableSystem that moves cable over massless wheels.
class MasslessWheels {
 public:
  explicit MasslessWheels(CableSystem& system) : s_(system) {}

  /// Finds the wheels of a run on which cable of a material lies, in RunWork::wheels.
  void find(const Substep& substep, const CompiledCable& cable, cable_parts::Run run);
  /// Sum of p - q [m] with this strain of the run, and minus its derivative by the strain [m]; 0
  /// without a strain or such a wheel.
  struct Kept {
    double length = 0.0;
    double slope = 0.0;
  };
  [[nodiscard]] static Kept kept(const CableSystem& system, std::span<const double> weights,
                                 std::optional<double> of_run);
  /// For a slack run: replaces `kept`, the lengths that its spans keep to spare [m], by those that they
  /// have to share, `spare` less p - q of the wheels over which the difference passes.
  void keep_slack(std::span<const double> spare, std::vector<double>& kept) const;
  /// Undoes the predicted rotation of a wheel.
  static void stop(Substep& substep, int wheel);
  /// Moves cable over the wheel behind span number `i` of the run, and turns the wheel. `passed`: the
  /// unstretched length that leaves this span [m]. Returns the length that comes into the next one [m].
  double pass(Substep& substep, int i, int span, double passed, FeatureState& next);

 private:
  /// Mean strain of span number `i` of the run over the substep.
  [[nodiscard]] double mean_strain(int i) const;
  /// Strain with which cable passes that has no strain of its own on wheels.
  [[nodiscard]] double passing_strain(const Substep& substep, int span) const;
  /// `way`: of the rim, towards the span behind the wheel [m].
  void turn(Substep& substep, int span, double way) const;

  CableSystem& s_;
};

}  // namespace sheave
