#pragma once
// What every change of an edit must provide. Adding one: a file in live/edits/ and a line in change_registry.cpp.

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "cable/edit.h"
#include "engine/field.h"
#include "engine/result.h"
#include "live/names.h"
#include "scenes/format.h"

namespace sheave::live {

/// What changes of one edit are told by: the names that there are, and those that come with it.
struct EditNames {
  const Names& names;
  std::map<std::string, CableHandle, std::less<>> new_cables{};

  [[nodiscard]] Result<CableHandle> cable(const std::string& name,
                                          const std::string& pointer = "/cable") const {
    const auto found = new_cables.find(name);
    if (found != new_cables.end()) return found->second;
    return names.cable(name, pointer);
  }
};

/// One change of what the world is made of. Settings; derived types add all of them.
class EditChange {
 public:
  virtual ~EditChange() = default;
  EditChange(const EditChange&) = delete;
  EditChange& operator=(const EditChange&) = delete;

  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this, as its own type
  /// Tells the edit; faults of names have pointers within the change. What cannot be is a fault of the edit.
  [[nodiscard]] virtual Errors apply(Edit& edit, EditNames& names) const = 0;

 protected:
  EditChange() = default;
};

/// One of a cable.
class CableChange : public EditChange {
 public:
  std::string cable;

  static constexpr std::string_view cable_meaning = "name of the cable";
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const final {
    const Result<CableHandle> handle = names.cable(cable);
    return handle ? change(edit, *handle, names) : handle.errors();
  }

 protected:
  [[nodiscard]] virtual Errors change(Edit& edit, CableHandle handle, EditNames& names) const = 0;
};

/// All of them, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<EditChange>> change_types();
/// The format of the objects in the list "changes".
[[nodiscard]] const ObjectFormat& change_format();

/// The registry line of `Type`, which declares static type_name, type_meaning and field_table().
template <class Type>
[[nodiscard]] constexpr TypeEntry<EditChange> change_entry() {
  return type_entry<EditChange, Type>();
}

// By the files in live/edits/.
[[nodiscard]] TypeEntry<EditChange> remove_body_change();
[[nodiscard]] TypeEntry<EditChange> remove_joint_change();
[[nodiscard]] TypeEntry<EditChange> remove_cable_change();
[[nodiscard]] TypeEntry<EditChange> detach_change();
[[nodiscard]] TypeEntry<EditChange> attach_change();
[[nodiscard]] TypeEntry<EditChange> split_change();
[[nodiscard]] TypeEntry<EditChange> join_change();
[[nodiscard]] TypeEntry<EditChange> pay_out_change();
[[nodiscard]] TypeEntry<EditChange> remove_link_change();

}  // namespace sheave::live
