#pragma once
// The ropes of a world that remember how they were stretched; internal to the cable library. The law
// is in cable/rope_memory.h.
//
// The spans of a run and the cable on the links between them have one strain, and one memory, which
// the state has per span. The law of a substep is that of the way from the strain at its start to
// that at its end. A state whose bodies, or whose lengths, were set may have a strain that its memory
// does not know. The memory that counts is therefore that after the rope has come to the strain of
// the state.

#include "cable/cable_system.h"

namespace sheave {

/// The part of a CableSystem that remembers strains.
class RopeMemories {
 public:
  explicit RopeMemories(CableSystem& system) : s_(system) {}

  /// Keeps strain and memory of each rope at the start of the substep. A search for equilibrium
  /// stretches each rope on one way from its state, so its poses are no memories.
  void begin(const Substep& substep, const FeatureState& state);
  /// Writes the memories at the end of the substep and counts the losses.
  void finish(const Substep& substep, FeatureState& next) const;

  /// The strain that the rope of a span remembers in this state; 0 without memory.
  [[nodiscard]] static double of(const CableSystem& system, const FeatureState& own, int span);
  /// Memory and loss [J] of a span, and their place in a state; 0 without memory.
  [[nodiscard]] static std::array<double, 2> kept(const CableSystem& system,
                                                  const FeatureState& own, int span);
  static void put(const CableSystem& system, const std::array<double, 2>& kept, int span,
                  FeatureState& own);
  /// Sum of the losses of a cable by its law since time 0 [J].
  [[nodiscard]] static double loss(const CableSystem& system, const FeatureState& own,
                                   const CompiledCable& cable);
  /// Energy of a span with this stretch [m], and of the cable on its second link, which is the link
  /// `second` [J].
  [[nodiscard]] static double energy(const CableSystem& system, const FeatureState& own, int span,
                                     int second, double stretch);
  /// Lets the ropes of a state remember the strains that they have there.
  static void settle(const CableSystem& system, const BodySet& bodies, const State& state,
                     FeatureState& own);
  /// The span `after` has come off the span `before`, or goes into it again.
  static void divide(const CableSystem& system, int before, int after, FeatureState& own);
  static void merge(const CableSystem& system, int before, int after, FeatureState& own);

 private:
  /// A run, with its strain.
  struct Stretch {
    double length = 0.0;       ///< [m]
    double rest_length = 0.0;  ///< [m]
    [[nodiscard]] double strain() const;
  };
  /// Visits the spans of each run of the cable.
  template <class Visit>
  void for_each_run(const CompiledCable& cable, Visit visit) const;
  /// The run in a state in which span k has the length `length_of(k)`.
  template <class Length>
  [[nodiscard]] Stretch stretch_of(const CompiledCable& cable, CableSystem::Run run,
                                   const FeatureState& own, Length length_of) const;

  CableSystem& s_;
};

}  // namespace sheave
