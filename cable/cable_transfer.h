#pragma once
// Cables between two worlds: out of the state of one, into the first state of the next; internal to
// the cable library.

#include <span>
#include <string>

#include "cable/cable_system.h"
#include "cable/fresh_links.h"

namespace sheave {

/// The world before, and both at the moment of the edit.
struct TransferFrom {
  CableSystem* system = nullptr;        ///< null: there were no cables
  const FeatureState* state = nullptr;  ///< its part of the state
  const Substep* then = nullptr;        ///< bodies where they were
  const Substep* now = nullptr;         ///< and where they are, in the next world: the same places
};

/// Reads and writes the state of the cables of one world.
class CableTransfer {
 public:
  explicit CableTransfer(CableSystem& system) : system_(system) {}

  [[nodiscard]] RunningCable running_cable(int cable, const CableDef& definition,
                                           const FeatureState& own, const Controls& controls) const;
  /// Makes initial_state() that in which cables go on from another world.
  [[nodiscard]] Errors continue_from(const TransferFrom& from, std::span<const CableStart> starts);
  /// By how much the cable is too short where that is worst [m], in a state `now` that cables have
  /// the part `own` of.
  [[nodiscard]] double missing_length(const Substep& now, const FeatureState& own, int cable);
  /// Why the cable cannot begin as in initial_state(), with bodies as `now`; one that is too short
  /// by no more than `allowed` [m] has been so before.
  [[nodiscard]] std::string start_fault(const Substep& now, int cable, double allowed);

 private:
  [[nodiscard]] RunningCable course_of(int cable, const CableDef& definition,
                                       const FeatureState& own, const Controls& controls) const;
  [[nodiscard]] RunningLink running_link(int cable, int link, const FeatureState& own,
                                         const Controls& controls) const;
  void put_link(int cable, int link, const RunningLink& running, FeatureState& own);
  /// Where the spans beside a wheel are new, they touch it elsewhere than those before: it takes
  /// the way between out of them, or gives it to them.
  void move_contacts(int cable, RunningCable& running, const TransferFrom& from);
  /// The number of the span behind a link of the list of all links.
  [[nodiscard]] static int span_behind(const CableSystem& system, int link);
  /// Of initial_state() as it was compiled: how long the ways are where everything is now.
  [[nodiscard]] LinkWays ways_of(int cable) const;
  /// Gives the cable the state `running`; why it cannot.
  /// How large what the cable lies on is [m]: to know that it is no other.
  [[nodiscard]] double size_of(const CompiledCable& cable, int link, int body) const;
  /// Why a link cannot be put there; empty if it can.
  [[nodiscard]] std::string size_fault(const CompiledCable& cable, int link,
                                       const RunningLink& running) const;
  [[nodiscard]] std::string put_changed(int cable, const RunningCable& changed,
                                        const TransferFrom& from);
  [[nodiscard]] std::string put_cable(int cable, const RunningCable& running, FeatureState& own);
  /// Whether its part of the state has the form of that of cable `then` of another system.
  [[nodiscard]] bool has_layout_of(int cable, const CableSystem& before, int then) const;
  [[nodiscard]] std::string copy_cable(int cable, CableSystem& before, int then,
                                       const FeatureState& from, FeatureState& own);

  CableSystem& system_;
};

}  // namespace sheave
