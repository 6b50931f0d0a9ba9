// Changes of settings of existing parts.

#include <algorithm>
#include <array>
#include <vector>

#include "live/change.h"
#include "scenes/format_tables.h"

namespace sheave::live {
namespace {

/// The fields of a table except these.
std::vector<Field> without(std::span<const Field> table, std::span<const std::string_view> names) {
  std::vector<Field> fields;
  for (const Field& field : table) {
    if (std::find(names.begin(), names.end(), field.name) == names.end()) fields.push_back(field);
  }
  return fields;
}

/// All fields except the name, the pose and the mobility.
std::span<const Field> changeable_fields_of_body() {
  static constexpr std::array<std::string_view, 8> fixed{
      "name",     "mobility",    "axis",     "mount",
      "position", "orientation", "velocity", "angular_velocity"};
  static const std::vector<Field> fields = without(BodyDef::field_table(), fixed);
  return fields;
}

/// All fields except dt, in which the world counts its time.
std::span<const Field> changeable_fields_of_step() {
  static constexpr std::array<std::string_view, 1> fixed{"dt"};
  static const std::vector<Field> fields = without(StepSettings::field_table(), fixed);
  return fields;
}

const ObjectFormat& body_settings_format() {
  static const ObjectFormat format = [] {
    ObjectFormat made = body_format();
    made.name = "body change";
    made.meaning =
        "changed settings of a body: settings that are not given stay, null gives the default";
    made.named = false;
    made.partial = true;
    made.tables = {{changeable_fields_of_body(), std::make_shared<const BodyDef>()}};
    std::erase_if(made.members, [](const Member& member) { return member.name == "rotation"; });
    std::erase_if(made.exclusive, [](const auto& pair) { return pair.second == "rotation"; });
    return made;
  }();
  return format;
}

const ObjectFormat& step_settings_format() {
  static const ObjectFormat format{
      "step change",
      "changed settings of the step: settings that are not given stay, null gives the "
      "default",
      false,
      {{changeable_fields_of_step(), std::make_shared<const StepSettings>()}},
      {},
      {},
      {},
      true};
  return format;
}

/// The fields that an object contains.
std::vector<Field> given(const json::Document& document, json::NodeId object,
                         std::span<const Field> fields) {
  std::vector<Field> found;
  for (const Field& field : fields) {
    if (document.member(object, field.name) != json::no_node) found.push_back(field);
  }
  return found;
}

class ChangeBody final : public EditChange {
 public:
  std::string body;

  static constexpr std::string_view type_name = "change_body";
  static constexpr std::string_view type_meaning =
      "changes settings of a body; its pose and velocity stay";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ChangeBody::body>("body", "", {}, required, "name of the body"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"settings", "the settings that change", false, &body_settings_format(), true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member == json::no_node) return;
    const std::array<void*, 1> objects{&changed_};
    if (!reader.fields().read_object(member, body_settings_format(), objects)) return;
    fields_ = given(reader.document(), member, changeable_fields_of_body());
    has_shapes_ = reader.parts().read_shapes(member, changed_.shapes);
  }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    const Result<BodyHandle> handle = names.body(body);
    if (!handle) return handle.errors();
    edit.change(*handle, [&](BodyDef& definition) {
      for (const Field& field : fields_) copy_value(field, &changed_, &definition);
      if (has_shapes_) definition.shapes = changed_.shapes;
      names.change(definition);
    });
    names.tell_change(part_path("bodies", *handle), "/settings", true);
    return {};
  }

 private:
  BodyDef changed_;
  std::vector<Field> fields_;
  bool has_shapes_ = false;
};

class SetStep final : public EditChange {
 public:
  static constexpr std::string_view type_name = "set_step";
  static constexpr std::string_view type_meaning =
      "changes solver, integrator, substeps or iterations";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> list{
        {{"step", "the settings that change", false, &step_settings_format(), true}}};
    return list;
  }
  void read(json::NodeId node, EditReader& reader) override {
    const json::NodeId member = reader.fields().member(node, members().front());
    if (member == json::no_node) return;
    const std::array<void*, 1> objects{&changed_};
    if (!reader.fields().read_object(member, step_settings_format(), objects)) return;
    fields_ = given(reader.document(), member, changeable_fields_of_step());
  }
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const override {
    if (gives("substeps") && gives("tolerance") && changed_.tolerance > 0.0) {
      return {{"/step/substeps",
               "a tolerance chooses the substeps, so their number cannot be set beside it: remove "
               "either \"substeps\" or \"tolerance\""}};
    }
    // A number of substeps takes the place of a tolerance.
    if (gives("substeps")) names.step.tolerance = 0.0;
    for (const Field& field : fields_) copy_value(field, &changed_, &names.step);
    edit.set_step(names.step);
    names.tell_change("/step", "/step", true);
    return {};
  }

 private:
  [[nodiscard]] bool gives(std::string_view name) const {
    return std::any_of(fields_.begin(), fields_.end(),
                       [&](const Field& field) { return field.name == name; });
  }

  StepSettings changed_;
  std::vector<Field> fields_;
};

}  // namespace

TypeEntry<EditChange> change_body_change() { return change_entry<ChangeBody>(); }
TypeEntry<EditChange> set_step_change() { return change_entry<SetStep>(); }

}  // namespace sheave::live
