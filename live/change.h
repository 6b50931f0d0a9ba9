#pragma once
// Interface of all changes of an edit. A new change is a file in live/edits/ and a line in
// change_registry.cpp.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "cable/edit.h"
#include "engine/field.h"
#include "engine/result.h"
#include "live/edit_names.h"
#include "scenes/format.h"

namespace sheave::live {

/// One change of an edit. Derived types add its settings.
class EditChange {
 public:
  virtual ~EditChange() = default;
  EditChange(const EditChange&) = delete;
  EditChange& operator=(const EditChange&) = delete;

  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry
  /// this, as a pointer to the derived type
  [[nodiscard]] virtual const void* settings() const = 0;
  /// The members that are objects.
  [[nodiscard]] virtual std::span<const Member> members() const { return {}; }
  /// Reads the members from the object `node`; declares added and removed bodies to the reader.
  virtual void read(json::NodeId node, EditReader& reader) {
    static_cast<void>(node), static_cast<void>(reader);
  }
  /// Number of added parts: bodies and their shapes, joints, cables and their links.
  [[nodiscard]] virtual std::size_t parts() const { return 0; }
  /// Applies the change to the edit. Faults of names have pointers within the change; impossible
  /// changes are faults of the edit.
  [[nodiscard]] virtual Errors apply(Edit& edit, EditNames& names) const = 0;

 protected:
  EditChange() = default;
};

/// A change of a cable.
class CableChange : public EditChange {
 public:
  std::string cable;

  static constexpr std::string_view cable_meaning = "name of the cable";
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const final {
    const Result<CableHandle> handle = names.cable(cable);
    if (!handle) return handle.errors();
    names.tell_change(part_path("cables", *handle), "", false);
    return change(edit, *handle, names);
  }

 protected:
  [[nodiscard]] virtual Errors change(Edit& edit, CableHandle handle, EditNames& names) const = 0;
};

/// All types of changes, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<EditChange>> change_types();
/// The format of the objects in the list "changes".
[[nodiscard]] const ObjectFormat& change_format();

/// The registry line of `Type`, which declares static type_name, type_meaning and field_table().
template <class Type>
[[nodiscard]] constexpr TypeEntry<EditChange> change_entry() {
  return type_entry<EditChange, Type>();
}

// Defined in the files in live/edits/.
[[nodiscard]] TypeEntry<EditChange> add_body_change();
[[nodiscard]] TypeEntry<EditChange> add_joint_change();
[[nodiscard]] TypeEntry<EditChange> add_cable_change();
[[nodiscard]] TypeEntry<EditChange> add_collider_change();
[[nodiscard]] TypeEntry<EditChange> insert_link_change();
[[nodiscard]] TypeEntry<EditChange> change_body_change();
[[nodiscard]] TypeEntry<EditChange> set_step_change();
[[nodiscard]] TypeEntry<EditChange> remove_body_change();
[[nodiscard]] TypeEntry<EditChange> remove_joint_change();
[[nodiscard]] TypeEntry<EditChange> remove_cable_change();
[[nodiscard]] TypeEntry<EditChange> remove_collider_change();
[[nodiscard]] TypeEntry<EditChange> detach_change();
[[nodiscard]] TypeEntry<EditChange> attach_change();
[[nodiscard]] TypeEntry<EditChange> split_change();
[[nodiscard]] TypeEntry<EditChange> open_change();
[[nodiscard]] TypeEntry<EditChange> join_change();
[[nodiscard]] TypeEntry<EditChange> pay_out_change();
[[nodiscard]] TypeEntry<EditChange> remove_link_change();

}  // namespace sheave::live
