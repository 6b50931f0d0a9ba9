#pragma once
// The rows of spans whose tension is no multiple of the strain: cable/tension_law.h.
//
// A row has the form stretch = compliance x tension (engine/row.h). A law is linearised at the
// present strain e: with a tension T* and a stiffness S* the row of a spring of length A has the
// value -A T* / S* and the compliance A / S*, so rounds of a solver are Newton's method on the law,
// and end where the row's tension is T*.
//
//   xpbd     T* = T(e) + c (e - e0) / h,   with the strain e0 at the start and the damper c [N s].
//   rattle   The tension of the substep is the mean of T between e0 and e1, which is the change of
//            the energy over that of the strain: a span without a damper keeps its energy to rounding.
//            The rule of rattle adds both ends, 2 F = T0 + T1 (engine/solvers/row_springs.cpp). The
//            row of the start has the energy U0 of its strain, as the value -A e0 and the
//            compliance A e0^2 / 2 U0, hence T0 = 2 U0 / e0. The row of the end has
//              T* = 2 mean - 2 U0 / e0 + 2 c (e - e0) / h,
//            which without a damper is above 0 at all strains above 0, because T rises. A span that
//            goes slack or taut in the substep gives and takes its energy exactly.
//
// T = EA e makes both the rows of a constant stiffness.
//
// A rope with memory (cable/rope_memory.h) has the tensions of the way from e0 to e. Its strains count
// from p, at which it becomes slack, and in the row of the start U0 is the energy that it gives when it
// is let off. With this T* > 0 holds on, because the tension along the way back falls, too.

#include "cable/compiled_cable.h"
#include "engine/row.h"
#include "engine/substep.h"

namespace sheave {

/// The cable of a link, by the index of the link among those of all cables.
[[nodiscard]] const CompiledCable& cable_of(const std::vector<CompiledCable>& cables, int link);

/// The moment for which a row of a law is made.
struct LawStep {
  enum class Rule { end, start, mean };
  Rule rule = Rule::end;
  double h = 0.0;  ///< for dampers [s]; 0: dampers do not act
};

/// `knows_start`: the rows of the start of this substep have been evaluated.
[[nodiscard]] LawStep law_step(const Substep& substep, bool knows_start);

/// A linearised law: a spring of length A and strain e has the value -A (e - p) `ratio` and the
/// compliance A `yield`, with the strain p at which it becomes slack.
struct LawRow {
  double ratio = 1.0;
  double yield = 0.0;   ///< [1/N], > 0
  bool pushes = false;  ///< the damper would push although the span is stretched
};

/// The strain of a spring at the start of the substep, or its slack.
struct LawStart {
  double strain = 0.0;
  double slack = 0.0;   ///< as a strain, >= 0; known for the rule `mean` only
  double memory = 0.0;  ///< strain that a rope with memory remembers at the start
};

/// The strain at which a rope of the cable becomes slack: cable/rope_memory.h; 0 without memory.
[[nodiscard]] double slack_strain(const CompiledCable& cable, const LawStart& start);

/// The law of `cable`, which has one, at `given_strain`. `damper`: [N s].
[[nodiscard]] LawRow law_row(const CompiledCable& cable, const LawStep& step, const LawStart& given,
                             double given_strain, double damper);

/// Gives a row with the value of a stretched or slack spring of length `spring_length` [m] the law
/// of its cable. `strain` is that of the value.
void follow_law(const CompiledCable& cable, const LawStep& step, const LawStart& start,
                double strain, double spring_length, Row& row);

}  // namespace sheave
