#pragma once
// Cables between two worlds: out of the state of one, into the first state of the next; internal to the cable library.

#include <span>
#include <string>

#include "cable/cable_system.h"

namespace sheave {

/// Reads and writes the state of the cables of one world.
class CableTransfer {
 public:
  explicit CableTransfer(CableSystem& system) : system_(system) {}

  [[nodiscard]] RunningCable running_cable(int cable, const CableDef& definition,
                                           const FeatureState& own, const Controls& controls) const;
  /// Makes initial_state() that in which cables go on from another world, whose cables had the state `from`; null: there were none.
  [[nodiscard]] Errors continue_from(CableSystem* before, const FeatureState* from,
                                     std::span<const CableStart> starts);
  /// By how much the cable is too short where that is worst [m], in a state `now` that cables have the part `own` of.
  [[nodiscard]] double missing_length(const Substep& now, const FeatureState& own, int cable);
  /// Why the cable cannot begin as in initial_state(), with bodies as `now`; one that is too short by no more than `allowed`
  /// [m] has been so before.
  [[nodiscard]] std::string start_fault(const Substep& now, int cable, double allowed);

 private:
  [[nodiscard]] RunningLink running_link(int cable, int link, const FeatureState& own,
                                         const Controls& controls) const;
  void put_link(int cable, int link, const RunningLink& running, FeatureState& own);
  /// Gives links that have just been inserted what lies on them, and shares the rest of their span; why that cannot be.
  [[nodiscard]] std::string share_with_fresh(int cable, RunningCable& running) const;
  /// Gives the cable the state `running`; why it cannot.
  [[nodiscard]] std::string put_cable(int cable, const RunningCable& running, FeatureState& own);
  /// Whether its part of the state has the form of that of cable `then` of another system.
  [[nodiscard]] bool has_layout_of(int cable, const CableSystem& before, int then) const;
  void copy_cable(int cable, CableSystem& before, int then, const FeatureState& from,
                  FeatureState& own);

  CableSystem& system_;
};

}  // namespace sheave
