#pragma once
// Cables between two worlds: out of the state of one, into the first state of the next; internal to
// the cable library.

#include <span>
#include <string>

#include "cable/cable_system.h"
#include "cable/fresh_links.h"

namespace sheave {

/// The world before.
struct TransferFrom {
  CableSystem* system = nullptr;        ///< null: there were no cables
  const FeatureState* state = nullptr;  ///< its part of the state
};

/// Reads and writes the state of the cables of one world.
class CableTransfer {
 public:
  explicit CableTransfer(CableSystem& system) : system_(system) {}

  [[nodiscard]] RunningCable running_cable(int cable, const CableDef& definition,
                                           const FeatureState& own, const Controls& controls) const;
  /// The same to be taken apart, in a state `now` that cables have the part `own` of.
  [[nodiscard]] TakenCable take_apart(int cable, const CableDef& definition,
                                      const FeatureState& own, const Controls& controls,
                                      const Substep& now);
  /// Makes initial_state() that in which cables go on from another world, with bodies as `now`,
  /// which may be null if none of them has been taken apart.
  [[nodiscard]] Errors continue_from(const TransferFrom& from, const Substep* now,
                                     std::span<const CableStart> starts);
  /// Why the cable cannot begin as in initial_state(), with bodies as `now`; one that is too short
  /// by no more than `allowed` [m] has been so before.
  [[nodiscard]] std::string start_fault(const Substep& now, int cable, double allowed);

 private:
  /// A cable as it runs, and the number of each of its links within it.
  struct Course {
    RunningCable running;
    std::vector<int> numbers;
  };
  [[nodiscard]] Course course_of(int cable, const CableDef& definition, const FeatureState& own,
                                 const Controls& controls) const;
  /// By how much the cable is too short where that is worst [m], in a state that is followed.
  [[nodiscard]] double missing_length(const Substep& now, const FeatureState& own, int cable) const;
  [[nodiscard]] RunningLink running_link(int cable, int link, const FeatureState& own,
                                         const Controls& controls) const;
  void put_link(int cable, int link, const RunningLink& running, FeatureState& own);
  /// Where the spans beside a wheel are new, they touch it elsewhere than those before: it takes
  /// the way between out of them, or gives it to them.
  void move_contacts(int cable, RunningCable& running, const Substep& now);
  /// Of initial_state() as it was compiled: how long the ways are where everything is now.
  [[nodiscard]] LinkWays ways_of(int cable) const;
  /// Gives the cable the state `running`; why it cannot.
  /// How large what the cable lies on is [m]: to know that it is no other.
  [[nodiscard]] double size_of(const CompiledCable& cable, int link, int body) const;
  /// Why a link cannot be put there; empty if it can.
  [[nodiscard]] std::string size_fault(const CompiledCable& cable, int link,
                                       const RunningLink& running) const;
  [[nodiscard]] std::string put_changed(int cable, const RunningCable& changed, const Substep& now);
  [[nodiscard]] std::string put_cable(int cable, const RunningCable& running, FeatureState& own);
  /// Whether its part of the state has the form of that of cable `then` of another system.
  [[nodiscard]] bool has_layout_of(int cable, const CableSystem& before, int then) const;
  [[nodiscard]] std::string copy_cable(int cable, CableSystem& before, int then,
                                       const FeatureState& from, FeatureState& own);

  CableSystem& system_;
};

}  // namespace sheave
