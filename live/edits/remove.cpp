// Changes that remove parts.

#include <array>

#include "live/change.h"

namespace sheave::live {
namespace {

class RemoveBody final : public EditChange {
 public:
  std::string body;

  static constexpr std::string_view type_name = "remove_body";
  static constexpr std::string_view type_meaning =
      "takes a body away, with its collider; joints, links and rotors that are on it must go "
      "before";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&RemoveBody::body>("body", "", {}, required, "name of the body"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  void read(json::NodeId /*node*/, EditReader& reader) override { reader.remove_body(body); }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    edit.remove(*handle);
    names.remove_body(body);
    return {};
  }
};

class RemoveJoint final : public EditChange {
 public:
  std::string joint;

  static constexpr std::string_view type_name = "remove_joint";
  static constexpr std::string_view type_meaning = "takes a joint away";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&RemoveJoint::joint>("joint", "", {}, required, "name of the joint"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    const Result<JointHandle> handle = names.joint(joint);
    if (!handle) return handle.errors();
    edit.remove(*handle);
    names.remove_joint(joint);
    return {};
  }
};

class RemoveCable final : public CableChange {
 public:
  static constexpr std::string_view type_name = "remove_cable";
  static constexpr std::string_view type_meaning = "takes a cable away";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&RemoveCable::cable, RemoveCable>("cable", "", {}, required, cable_meaning),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& /*names*/) const override {
    edit.remove(handle);
    return {};
  }
};

class RemoveCollider final : public EditChange {
 public:
  std::string body;

  static constexpr std::string_view type_name = "remove_collider";
  static constexpr std::string_view type_meaning = "a body no longer touches any other";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&RemoveCollider::body>("body", "", {}, required, "name of the body"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    edit.remove_collider(*handle);
    return {};
  }
};

}  // namespace

TypeEntry<EditChange> remove_body_change() { return change_entry<RemoveBody>(); }
TypeEntry<EditChange> remove_joint_change() { return change_entry<RemoveJoint>(); }
TypeEntry<EditChange> remove_cable_change() { return change_entry<RemoveCable>(); }
TypeEntry<EditChange> remove_collider_change() { return change_entry<RemoveCollider>(); }

}  // namespace sheave::live
