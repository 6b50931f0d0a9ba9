#pragma once
// An edit while its changes are collected; internal to the cable library.

#include <map>
#include <string>
#include <vector>

#include "cable/edit.h"
#include "cable/live_revision.h"

namespace sheave {

struct DraftJoint {
  std::shared_ptr<const JointDef> definition;
  std::shared_ptr<JointDef> added;  ///< `definition` as mutable; null if the joint is not new
  std::size_t slot = 0;
};

struct DraftCable {
  CableDef definition;  ///< for a running cable only its settings
  int same_as = -1;     ///< index of the same cable in the world before; -1: none
  bool runs = false;    ///< the cable has been changed; `running` is its present state
  RunningCable running;
  std::array<std::optional<double>, 2> loose;  ///< as CableRecord::loose
  double excess = 0.0;  ///< length by which the cable is too short already [m]
};

/// Collects changes and faults. The world itself is not changed.
struct EditDraft {
  EditDraft(LiveRevision& from, std::uint32_t& generation);

  LiveRevision& before;
  std::uint32_t& next_generation;
  Model model;  ///< bodies that were removed are static bodies without a shape
  SlotTable<BodyTag> bodies;
  SlotTable<JointTag> joints;
  SlotTable<CableTag> cables;
  bool has_other_bodies = false;  ///< whether the bodies differ from those of the world before
  std::vector<char> is_new;       ///< per body: it was added, or replaces a removed one
  std::vector<DraftJoint> own_joints;
  std::map<int, DraftCable> own_cables;  ///< by slot; cables that are not in it are unchanged
  /// Owns TakenCable::spans of all cables that were taken apart, for as long as the edit lasts.
  /// Links refer to these spans wherever they end up.
  std::vector<std::shared_ptr<const SpanGeometry>> spans_before;
  Errors errors;

  void fail(std::string message) { errors.push_back({"", std::move(message)}); }
  /// Whether the handle refers to something. If not, adds a fault.
  template <class Tag>
  bool check(const SlotTable<Tag>& slots, Handle<Tag> handle, std::string_view kind) {
    std::string fault = slots.fault_of(handle, kind);
    if (fault.empty()) return true;
    fail(std::move(fault));
    return false;
  }
  /// The cable, taken apart. Null and a fault if the cable cannot be changed.
  DraftCable* running(CableHandle handle, bool may_be_cut = false);
  [[nodiscard]] std::optional<std::size_t> place_to_part(const DraftCable& cable, int span,
                                                         double share);
  /// Joins the cable's two loose ends.
  void close(DraftCable& cable);
  [[nodiscard]] std::string cable_name(CableHandle handle) const;
};

/// A placeholder for a slot without a body.
[[nodiscard]] BodyDef no_body(std::size_t slot);
[[nodiscard]] bool holds_by_itself(const RunningLink& link);
/// Lets loose ends run off the links that do not hold them. Returns why the rest is no cable; empty
/// if it is one.
[[nodiscard]] std::string run_off(DraftCable& cable);

}  // namespace sheave
