#pragma once
// The contents of a LiveWorld between two edits; internal to the cable library.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable_system.h"
#include "cable/handle.h"
#include "cable/running_cable.h"
#include "cable/simulation.h"
#include "engine/control_check.h"
#include "engine/substep.h"

namespace sheave {

/// A place that handles refer to.
struct Slot {
  std::uint32_t generation = 0;  ///< of the present object; 0: the slot is free
  int index = -1;                ///< index in the model's or the cables' list
  std::string last_name;         ///< name of the last object in a free slot
};

/// The slots of the bodies, of the joints or of the cables.
template <class Tag>
class SlotTable {
 public:
  [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
  [[nodiscard]] bool has(Handle<Tag> handle) const {
    return handle.slot >= 0 && static_cast<std::size_t>(handle.slot) < slots_.size() &&
           handle.generation != 0 &&
           slots_[static_cast<std::size_t>(handle.slot)].generation == handle.generation;
  }
  /// The handle must be valid.
  [[nodiscard]] int index(Handle<Tag> handle) const {
    return slots_[static_cast<std::size_t>(handle.slot)].index;
  }
  [[nodiscard]] Handle<Tag> handle(std::size_t slot) const {
    return {static_cast<std::int32_t>(slot), slots_[slot].generation};
  }
  [[nodiscard]] Handle<Tag> handle_of_index(int index) const {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].generation != 0 && slots_[i].index == index) return handle(i);
    }
    return {};
  }
  /// Uses the first free slot that is not marked in `used`.
  Handle<Tag> add(int index, std::uint32_t generation, std::span<const char> used = {}) {
    std::size_t i = 0;
    const auto taken = [&] {
      return slots_[i].generation != 0 || (i < used.size() && used[i] != 0);
    };
    while (i < slots_.size() && taken()) ++i;
    if (i == slots_.size()) slots_.emplace_back();
    slots_[i].generation = generation;
    slots_[i].index = index;
    return handle(i);
  }
  void remove(Handle<Tag> handle, std::string name) {
    Slot& slot = slots_[static_cast<std::size_t>(handle.slot)];
    slot.generation = 0;
    slot.index = -1;
    slot.last_name = std::move(name);
  }
  void set_index(std::size_t slot, int index) { slots_[slot].index = index; }
  /// Why a handle refers to nothing; empty if it is valid.
  [[nodiscard]] std::string fault_of(Handle<Tag> handle, std::string_view kind) const {
    if (has(handle)) return {};
    const std::string what(kind);
    if (handle.generation == 0) return "this handle refers to no " + what;
    const auto slot = static_cast<std::size_t>(handle.slot);
    if (handle.slot < 0 || slot >= slots_.size()) {
      return "handle " + std::to_string(handle.slot) + " refers to no " + what + " of this world";
    }
    std::string fault = "the " + what + " of handle " + std::to_string(handle.slot) + " is no more";
    if (!slots_[slot].last_name.empty()) {
      fault += "; the last one there was \"" + slots_[slot].last_name + "\"";
    }
    return fault;
  }

 private:
  std::vector<Slot> slots_;
};

/// Fault of a change after which the energy of the world would overflow.
inline constexpr std::string_view energy_fault =
    "the energy of the world would be beyond the range of numbers, 1.8e308 J: masses, speeds or "
    "distances are too large";

/// Marks the world as busy for a scope, also if a callback throws.
class Busy {
 public:
  explicit Busy(bool& is_busy) : is_busy_(is_busy) { is_busy = true; }
  ~Busy() { is_busy_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  bool& is_busy_;
};

/// A cable that a handle refers to.
struct CableRecord {
  CableDef definition;  ///< of the part between its holds
  std::array<std::optional<double>, 2>
      loose;       ///< length beyond the first and beyond the last link [m], if that end is loose
  int place = -1;  ///< index among the world's cables; -1: no part of it carries tension
  RunningCable running;  ///< if `place` is -1: the rest of the cable
};

struct LiveRevision {
  LiveRevision(Simulation made, SlotTable<BodyTag> body_slots, SlotTable<JointTag> joint_slots,
               SlotTable<CableTag> cable_slots, std::vector<CableRecord> cable_records);

  Simulation simulation;
  SlotTable<BodyTag> bodies;         ///< the index of a body is its slot
  SlotTable<JointTag> joints;        ///< indices in Model::joints
  SlotTable<CableTag> cables;        ///< the index is the slot
  std::vector<CableRecord> records;  ///< per slot
  std::optional<Substep> view;  ///< poses of the bodies for readers of joints, if there are joints
  std::vector<JointPlace> joint_places;  ///< in the order of the model
  std::vector<int> breakable_joints;
  std::vector<JointHandle> joint_handles;  ///< in the order of the model
  std::vector<CableHandle> cable_handles;  ///< in the order of the world's cables

  [[nodiscard]] const World& world() const { return simulation.world; }
  [[nodiscard]] CableSystem* system() const;
};

}  // namespace sheave
