#pragma once
// Knots without mass in a substep; internal to the cable library.
//
// A knot is a body of the mobility `knot`, to which ends of cables are attached. Knots have no degree of
// freedom: cable/knot_point.h derives the place of a knot from the poses of the other bodies, and one
// row for all its spans. Solvers get this row as the rows of the spans, each times the share of its
// rope, tied to one unknown. Spans that share a tension (cable/cable_runs.cpp) are one arm of the knot.
//
//   momentum   The sum of shares x directions is 0, so no common motion of the bodies changes C.
//   `xpbd`     The forces balance at the end of the substep.
//   `rattle`   The first half of the force has the shares of the start, and the second half those of
//              the end, so both halves balance.
//
// finish() gives every span its tension, share x multiplier, and the knot its place. The shares of
// three ropes, or of four that are not in a plane, follow from the directions alone. The shares of four
// ropes in a plane follow from the motion of several bodies, which one row cannot express.

#include "cable/cable_system.h"
#include "engine/result.h"

namespace sheave {

/// The part of a CableSystem that ties knots.
class Knots {
 public:
  explicit Knots(CableSystem& system) : s_(system) {}

  static constexpr int least_ropes = 2;
  static constexpr int most_ropes = most_knot_arms;
  /// Tells which knots have too few or too many ropes; `ropes`: per body, the ends of cables on it.
  static void check_counts(const BodySet& bodies, std::span<const int> ropes, Errors& errors);

  void begin();
  /// Appends the rows of the spans of a cable that are no arms of a knot.
  void linearise_rest(Substep& substep, const CompiledCable& cable, RowList& rows);
  /// Appends the rows of all knots.
  void linearise(Substep& substep, RowList& rows);
  /// Likewise for a sweep; both return the largest correction [m].
  double sweep_rest(Substep& substep, const CompiledCable& cable);
  double sweep(Substep& substep);
  /// Gives the spans their tensions, and the knots their places in Substep::next.
  void finish(Substep& substep, const FeatureState& next);
  /// Places a knot in the present pose, and evaluates its spans there.
  void settle(Substep& substep, cable_parts::KnotWork& knot);

 private:
  using KnotWork = cable_parts::KnotWork;
  [[nodiscard]] cable_parts::Run run_of(const cable_parts::KnotEnd& end) const;
  /// Evaluates the spans of a knot where it is now.
  void evaluate(const Substep& substep, KnotWork& knot);
  /// Finds where the forces of the spans as evaluated balance.
  void find_place(KnotWork& knot) const;
  /// Sum of the compliances of all spans, with their rest lengths at the start of the substep [m/N].
  [[nodiscard]] double compliance_of(const KnotWork& knot) const;
  template <class Visit>
  void for_each_free_run(const CompiledCable& cable, Visit visit);

  CableSystem& s_;
};

namespace cable_parts {

/// Whether the rigid ropes of a taut knot, as last evaluated, can share its force in several ways.
[[nodiscard]] bool is_undetermined(const KnotWork& knot);
/// The message for that.
[[nodiscard]] std::string undetermined_text(const BodySet& bodies, const KnotWork& knot);

}  // namespace cable_parts
}  // namespace sheave
