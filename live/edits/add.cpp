// Changes that add parts, written as in scenes.

#include <array>

#include "live/change.h"
#include "scenes/format.h"

namespace sheave::live {
namespace {

/// Replaces the references of an object of a registered type, including those common to all its
/// types.
template <class Base>
void put_ids_of(const Base& object, std::span<const TypeEntry<Base>> types, Edit& edit,
                const EditNames& names) {
  // The object belongs to the edit and is not constant; settings() only gives its derived type.
  names.put_ids(edit, Base::common_field_table(),
                const_cast<Base*>(&object));  // NOLINT(*-const-cast)
  for (const TypeEntry<Base>& type : types) {
    if (type.name != object.type()) continue;
    names.put_ids(edit, type.fields(),
                  const_cast<void*>(object.settings()));  // NOLINT(*-const-cast)
  }
}

class AddBody final : public EditChange {
 public:
  static constexpr std::string_view type_name = "add_body";
  static constexpr std::string_view type_meaning =
      "adds a body at the place of its definition; later changes of the edit may name it";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"body", "as in scenes; position and velocity are those of now", false, &body_format(),
          true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member == json::no_node) return;
    body_ = reader.parts().read_body(member);
    reader.add_body(body_.name);
  }
  [[nodiscard]] std::size_t parts() const override { return 1 + body_.shapes.size(); }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    BodyDef body = body_;
    names.put_ids(edit, BodyDef::field_table(), &body);
    const BodyHandle handle = edit.add(body);
    names.add(handle, body);
    names.tell_part(part_path("bodies", handle), "/body");
    return {};
  }

 private:
  BodyDef body_;
};

class AddJoint final : public EditChange {
 public:
  static constexpr std::string_view type_name = "add_joint";
  static constexpr std::string_view type_meaning =
      "adds a joint of the bodies as they are now, at its coordinates' zero";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"joint", "as in scenes; points and directions are those of now", false, &joint_format(),
          true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member != json::no_node) joint_ = reader.parts().read_joint(member);
  }
  [[nodiscard]] std::size_t parts() const override { return 1; }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    put_ids_of(*joint_, joint_types(), edit, names);
    const JointHandle handle = edit.add(joint_);
    names.add(handle, joint_);
    names.tell_part(part_path("joints", handle), "/joint");
    return {};
  }

 private:
  std::shared_ptr<JointDef> joint_;
};

class AddCable final : public EditChange {
 public:
  static constexpr std::string_view type_name = "add_cable";
  static constexpr std::string_view type_meaning = "adds a cable between bodies as they are now";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"cable", "as in scenes", false, &cable_format(), true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member != json::no_node) cable_ = reader.parts().read_cable(member);
  }
  [[nodiscard]] std::size_t parts() const override { return 1 + cable_.links.size(); }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    for (const auto& link : cable_.links) put_ids_of(*link, link_types(), edit, names);
    const CableHandle handle = edit.add(cable_);
    names.add(handle, cable_.name);
    names.tell_part(part_path("cables", handle), "/cable");
    return {};
  }

 private:
  CableDef cable_;
};

class AddCollider final : public EditChange {
 public:
  static constexpr std::string_view type_name = "add_collider";
  static constexpr std::string_view type_meaning = "makes a body touch others";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"collider", "as in scenes", false, &collider_format(), true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member != json::no_node) collider_ = reader.parts().read_collider(member);
  }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    ColliderDef collider = collider_;
    names.put_ids(edit, ColliderDef::field_table(), &collider);
    edit.add(collider);
    const int body = collider.body.is_world() ? 0 : collider.body.index;
    names.tell_part("/colliders/" + std::to_string(body), "/collider");
    return {};
  }

 private:
  ColliderDef collider_;
};

class InsertLink final : public CableChange {
 public:
  int span = 0;

  static constexpr std::string_view type_name = "insert_link";
  static constexpr std::string_view type_meaning =
      "leads a span over another link; the cable on the link comes from the span";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&InsertLink::cable, InsertLink>("cable", "", {}, required, cable_meaning),
        field<&InsertLink::span>("span", "", at_least(0.0), required,
                                 "the span behind this link, counted from 0"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"link", "as in scenes", false, &link_format(), true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member != json::no_node) link_ = reader.parts().read_link(member);
  }
  [[nodiscard]] std::size_t parts() const override { return 1; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& names) const override {
    put_ids_of(*link_, link_types(), edit, names);
    edit.insert(handle, span, link_);
    return {};
  }

 private:
  std::shared_ptr<LinkDef> link_;
};

}  // namespace

TypeEntry<EditChange> add_body_change() { return change_entry<AddBody>(); }
TypeEntry<EditChange> add_joint_change() { return change_entry<AddJoint>(); }
TypeEntry<EditChange> add_cable_change() { return change_entry<AddCable>(); }
TypeEntry<EditChange> add_collider_change() { return change_entry<AddCollider>(); }
TypeEntry<EditChange> insert_link_change() { return change_entry<InsertLink>(); }

}  // namespace sheave::live
