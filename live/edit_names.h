#pragma once
// Names during one edit: the existing ones, and those that the edit adds and removes.

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/edit.h"
#include "engine/field.h"
#include "engine/result.h"
#include "live/names.h"
#include "scenes/part_reader.h"

namespace sheave::live {

/// Reads the parts that an edit adds. References to existing bodies are read as their slots,
/// references to bodies that the edit adds as numbers from Names::body_slots() on, in their order.
/// EditNames::id() resolves both.
class EditReader {
 public:
  /// Both must outlive the reader.
  EditReader(PartReader& parts, const Names& names);
  [[nodiscard]] PartReader& parts() { return parts_; }
  [[nodiscard]] FieldReader& fields() { return parts_.fields(); }
  [[nodiscard]] const json::Document& document() const { return parts_.document(); }

  /// Declares a body to which later parts may refer. `name` must outlive the reader.
  void add_body(std::string_view name);
  /// Later parts may no longer refer to this body.
  void remove_body(std::string_view name);

 private:
  PartReader& parts_;
  int next_number_;
};

/// Names and numbers while an edit is collected.
class EditNames {
 public:
  /// Both must outlive this object.
  EditNames(const LiveWorld& world, const Names& names);

  [[nodiscard]] Result<BodyHandle> body(const std::string& name,
                                        const std::string& pointer = "/body") const;
  [[nodiscard]] Result<JointHandle> joint(const std::string& name,
                                          const std::string& pointer = "/joint") const;
  [[nodiscard]] Result<CableHandle> cable(const std::string& name,
                                          const std::string& pointer = "/cable") const;

  void add(BodyHandle body, const BodyDef& definition);
  void add(JointHandle joint, std::shared_ptr<const JointDef> definition);
  void add(CableHandle cable, const std::string& name);
  /// Notes the changed definition of a body.
  void change(const BodyDef& definition);
  void remove_body(const std::string& name) { removed_bodies_.insert(name); }
  void remove_joint(const std::string& name) { removed_joints_.insert(name); }

  /// The edit's id of a body that was read with a part.
  [[nodiscard]] BodyId id(Edit& edit, BodyId read) const;
  /// Replaces all references in an object of the table's type by the ids of the edit.
  void put_ids(Edit& edit, std::span<const Field> fields, void* object) const;

  /// Faults of joints and bodies with the same name and a common quantity, with the paths of parts.
  [[nodiscard]] Errors shared_names() const;

  /// Sets the pointer of the following change.
  void begin(std::string pointer) { change_ = std::move(pointer); }
  /// Relates the part that faults of an edit call `path` ("/bodies/3") to its definition, the value
  /// at `pointer` in this change; if not `exact`, to the change as a whole.
  void tell_part(const std::string& path, const std::string& pointer, bool exact = true);
  /// Relates that part to the value at `pointer` that this change modifies, unless an earlier
  /// change has related the same part; if not `exact`, to any place in it.
  void tell_change(const std::string& path, const std::string& pointer, bool exact);
  /// The pointer in the request of an edit's fault with this path; empty if the path belongs to no
  /// related part.
  [[nodiscard]] std::string pointer_of(const std::string& path) const;

  StepSettings step;  ///< step settings within this edit

 private:
  struct Part {
    std::string pointer;
    bool exact = true;
  };
  struct Body {
    BodyHandle handle;
    BodyDef definition;
  };
  struct Joint {
    JointHandle handle;
    std::shared_ptr<const JointDef> definition;
  };
  [[nodiscard]] const BodyDef* body_called(const std::string& name) const;
  [[nodiscard]] const JointDef* joint_called(const std::string& name) const;

  const LiveWorld& world_;
  const Names& names_;
  std::vector<BodyHandle> added_bodies_;  // in the order in which they were read
  std::map<std::string, Body> bodies_;    // added or changed bodies
  std::map<std::string, Joint> joints_;   // added joints
  std::map<std::string, CableHandle> cables_;
  std::set<std::string> removed_bodies_, removed_joints_;
  std::string change_;
  std::map<std::string, Part> parts_;
};

/// The path of a part in the faults of an edit: "/bodies/3".
template <class Tag>
[[nodiscard]] std::string part_path(std::string_view list, Handle<Tag> handle) {
  return "/" + std::string(list) + "/" + std::to_string(handle.slot);
}

}  // namespace sheave::live
