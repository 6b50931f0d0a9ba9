#pragma once
// Moves cables from the state of one world to the initial state of the next; internal to the cable
// library.

#include <span>
#include <string>

#include "cable/cable_system.h"
#include "cable/fresh_links.h"

namespace sheave {

/// The cables of the world before an edit.
struct TransferFrom {
  CableSystem* system = nullptr;        ///< null: there were no cables
  const FeatureState* state = nullptr;  ///< the cables' part of its state
};

/// Reads and writes the state of the cables of one world.
class CableTransfer {
 public:
  explicit CableTransfer(CableSystem& system) : system_(system) {}

  [[nodiscard]] RunningCable running_cable(int cable, const CableDef& definition,
                                           const FeatureState& own, const Controls& controls) const;
  /// The cable's running state with the spans that its links refer to, to be taken apart. `own` is
  /// the part that cables have of the state `now`.
  [[nodiscard]] TakenCable take_apart(int cable, const CableDef& definition,
                                      const FeatureState& own, const Controls& controls,
                                      const Substep& now);
  /// Makes initial_state() the state in which cables go on from another world. `now` has the poses
  /// of the bodies; it may be null if no cable has been taken apart.
  [[nodiscard]] Errors continue_from(const TransferFrom& from, const Substep* now,
                                     std::span<const CableStart> starts);
  /// Why the cable cannot begin as in initial_state(), with the bodies as in `now`. `allowed`:
  /// length by which it was too short before already [m].
  [[nodiscard]] std::string start_fault(const Substep& now, int cable, double allowed);

 private:
  /// A running cable, and the index within the cable of each of its links.
  struct Course {
    RunningCable running;
    std::vector<int> numbers;
  };
  [[nodiscard]] Course course_of(int cable, const CableDef& definition, const FeatureState& own,
                                 const Controls& controls) const;
  /// Largest length that the cable lacks in any of its parts [m]; links_ and spans_ must follow the
  /// state.
  [[nodiscard]] double missing_length(const Substep& now, const FeatureState& own, int cable) const;
  [[nodiscard]] RunningLink running_link(int cable, int link, const FeatureState& own,
                                         const Controls& controls) const;
  void put_link(int cable, int link, const RunningLink& running, FeatureState& own);
  /// Moves the contacts of wheels whose adjacent spans are new: the wheel takes the arc between the
  /// old and the new contact out of the span, or gives it to the span.
  void move_contacts(int cable, RunningCable& running, const Substep& now);
  /// Arcs and spans of the cable with the bodies as they are now, for initial_state() as compiled.
  [[nodiscard]] LinkWays ways_of(int cable) const;
  /// Size of the surface that the cable touches [m]. An equal size shows that the surface is the
  /// same.
  [[nodiscard]] double size_of(const CompiledCable& cable, int link, int body) const;
  /// Why a running link cannot be used here; empty if it can.
  [[nodiscard]] std::string size_fault(const CompiledCable& cable, int link,
                                       const RunningLink& running) const;
  [[nodiscard]] std::string put_changed(int cable, const RunningCable& changed, const Substep& now);
  [[nodiscard]] std::string put_cable(int cable, const RunningCable& running, FeatureState& own);
  /// Whether the cable's part of the state has the same layout as that of cable `then` of another
  /// system.
  [[nodiscard]] bool has_layout_of(int cable, const CableSystem& before, int then) const;
  [[nodiscard]] std::string copy_cable(int cable, CableSystem& before, int then,
                                       const FeatureState& from, FeatureState& own);

  CableSystem& system_;
};

}  // namespace sheave
