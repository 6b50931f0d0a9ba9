#pragma once
// What the changes of one edit are told by: the names that there are, and those that come and go
// with it.

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

/// Reads the parts that an edit adds. References to bodies are read as their slots, those to the
/// bodies that the edit itself adds as numbers from Names::body_slots() on, in their order;
/// EditNames::id() tells what they are.
class EditReader {
 public:
  /// Both must outlive the reader.
  EditReader(PartReader& parts, const Names& names);
  [[nodiscard]] PartReader& parts() { return parts_; }
  [[nodiscard]] FieldReader& fields() { return parts_.fields(); }
  [[nodiscard]] const json::Document& document() const { return parts_.document(); }

  /// A body that later parts may refer to. `name` must outlive the reader.
  void add_body(std::string_view name);
  /// One that they may not refer to any more.
  void remove_body(std::string_view name);

 private:
  PartReader& parts_;
  int next_number_;
};

/// Names and numbers while an edit is being made.
class EditNames {
 public:
  /// Both must outlive this.
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
  /// A body has been changed to this.
  void change(const BodyDef& definition);
  void remove_body(const std::string& name) { removed_bodies_.insert(name); }
  void remove_joint(const std::string& name) { removed_joints_.insert(name); }

  /// What the edit calls a body that a part has been read with.
  [[nodiscard]] BodyId id(Edit& edit, BodyId read) const;
  /// Lets all references of an object of the table's type, as read, be what the edit calls them.
  void put_ids(Edit& edit, std::span<const Field> fields, void* object) const;

  /// Joints and bodies of one name of which a quantity could be that of either; with the paths of
  /// parts.
  [[nodiscard]] Errors shared_names() const;

  /// From now on changes are those at this pointer.
  void begin(std::string pointer) { change_ = std::move(pointer); }
  /// What is wrong with the part that faults of an edit call `path` ("/bodies/3") is wrong with its
  /// definition, the value at `pointer` in this change; if not `exact`, with the change.
  void tell_part(const std::string& path, const std::string& pointer, bool exact = true);
  /// It is wrong with what this change changes of it at `pointer`, unless an earlier change has
  /// told of the same part; if not `exact`, wherever in it.
  void tell_change(const std::string& path, const std::string& pointer, bool exact);
  /// The pointer in the request of a fault that an edit tells with a path; empty if it is not about
  /// a part that it was told of.
  [[nodiscard]] std::string pointer_of(const std::string& path) const;

  StepSettings step;  ///< as this edit has them

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
  std::map<std::string, Body> bodies_;    // that have been added or changed
  std::map<std::string, Joint> joints_;   // that have been added
  std::map<std::string, CableHandle> cables_;
  std::set<std::string> removed_bodies_, removed_joints_;
  std::string change_;
  std::map<std::string, Part> parts_;
};

/// The path by which an edit's faults call a part: "/bodies/3".
template <class Tag>
[[nodiscard]] std::string part_path(std::string_view list, Handle<Tag> handle) {
  return "/" + std::string(list) + "/" + std::to_string(handle.slot);
}

}  // namespace sheave::live
