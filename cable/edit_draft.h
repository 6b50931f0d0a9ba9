#pragma once
// An edit while it is being told; internal to the cable library.

#include <map>
#include <string>
#include <vector>

#include "cable/edit.h"
#include "cable/live_revision.h"

namespace sheave {

struct DraftJoint {
  std::shared_ptr<const JointDef> definition;
  std::shared_ptr<JointDef> added;  ///< the same, if it is new
  std::size_t slot = 0;
};

struct DraftCable {
  CableDef definition;  ///< of a cable that runs its settings alone
  int same_as = -1;     ///< the cable of the world before that it is
  bool runs = false;    ///< it has been changed, and is `running` now
  RunningCable running;
  std::array<std::optional<double>, 2> loose;  ///< as CableRecord::loose
  double excess = 0.0;  ///< by how much what it is made of is too short already [m]
};

/// Collects changes and faults. Nothing of the world is touched.
struct EditDraft {
  EditDraft(LiveRevision& from, std::uint32_t& generation);

  LiveRevision& before;
  std::uint32_t& next_generation;
  Model model;  ///< with bodies that are gone as static ones without a shape
  SlotTable<BodyTag> bodies;
  SlotTable<JointTag> joints;
  SlotTable<CableTag> cables;
  bool has_other_bodies = false;  ///< than the world before
  std::vector<char> is_new;       ///< per body: not the one that was there before
  std::vector<DraftJoint> own_joints;
  std::map<int, DraftCable>
      own_cables;  ///< by slot; those that are not among them are as they were
  /// TakenCable::spans of all that were taken apart: whatever becomes of their links, they are known
  /// for as long as the edit lasts.
  std::vector<std::shared_ptr<const SpanGeometry>> spans_before;
  Errors errors;

  void fail(std::string message) { errors.push_back({"", std::move(message)}); }
  /// Whether the handle refers to something; if not, that is a fault.
  template <class Tag>
  bool check(const SlotTable<Tag>& slots, Handle<Tag> handle, std::string_view kind) {
    std::string fault = slots.fault_of(handle, kind);
    if (fault.empty()) return true;
    fail(std::move(fault));
    return false;
  }
  /// The cable, taken apart; null, and a fault, if it cannot be changed.
  DraftCable* running(CableHandle handle, bool may_be_cut = false);
  [[nodiscard]] std::optional<std::size_t> place_to_part(const DraftCable& cable, int span,
                                                         double share);
  /// Joins its loose ends.
  void close(DraftCable& cable);
  [[nodiscard]] std::string cable_name(CableHandle handle) const;
};

/// A body that stands where there is none.
[[nodiscard]] BodyDef no_body(std::size_t slot);
[[nodiscard]] bool holds_by_itself(const RunningLink& link);
/// Lets loose ends run off what does not hold them; why what is left is no cable.
[[nodiscard]] std::string run_off(DraftCable& cable);

}  // namespace sheave
