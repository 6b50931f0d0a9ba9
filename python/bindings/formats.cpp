// The field tables of the scene format, for the classes of python/sheave/parts.py.

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "live/change.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "python/bindings/overrides.h"
#include "scenes/field_json.h"
#include "scenes/format.h"
#include "scenes/placement.h"

namespace sheave::python {
namespace {

/// The kind of a slot's value in Python.
struct KindOf {
  const char* operator()(const double*) const { return "number"; }
  const char* operator()(const std::optional<double>*) const { return "number"; }
  const char* operator()(const int*) const { return "integer"; }
  const char* operator()(const bool*) const { return "boolean"; }
  const char* operator()(const std::string*) const { return "text"; }
  const char* operator()(const Vector3*) const { return "vector"; }
  const char* operator()(const std::optional<Vector3>*) const { return "vector"; }
  const char* operator()(const Quaternion*) const { return "quaternion"; }
  const char* operator()(const BodyId*) const { return "body"; }
  const char* operator()(const std::optional<BodyId>*) const { return "body"; }
  const char* operator()(const std::vector<double>*) const { return "numbers"; }
  const char* operator()(const std::vector<Vector3>*) const { return "vectors"; }
  const char* operator()(const std::vector<std::string>*) const { return "texts"; }
  const char* operator()(const ChoiceSlot&) const { return "choice"; }
};

py::dict field_dict(const Field& field, const void* defaults) {
  const FieldSlot slot = slot_of(field, defaults);
  py::dict one;
  one["name"] = std::string(field.name);
  one["kind"] = std::visit(KindOf{}, slot);
  one["unit"] = std::string(field.unit);
  one["allowed"] = describe(field, slot);
  one["required"] = field.presence == Presence::required;
  one["meaning"] = std::string(field.meaning);
  std::vector<std::string> choices(field.choices.begin(), field.choices.end());
  one["choices"] = choices;
  one["default"] =
      is_absent(slot) ? std::string()
                      : field_json(field, slot, [](BodyId) { return std::string("world"); }).dump();
  return one;
}

py::list fields_of(const TableFormat& table) {
  py::list fields;
  for (const Field& field : table.fields) fields.append(field_dict(field, table.defaults.get()));
  return fields;
}

py::list members_of(std::span<const Member> members) {
  py::list all;
  for (const Member& member : members) {
    py::dict one;
    one["name"] = std::string(member.name);
    one["meaning"] = std::string(member.meaning);
    one["list"] = member.list;
    one["format"] = std::string(member.format->name);
    one["required"] = member.required;
    all.append(std::move(one));
  }
  return all;
}

py::dict format_dict(const ObjectFormat& format) {
  py::dict all;
  all["name"] = std::string(format.name);
  all["meaning"] = std::string(format.meaning);
  py::list fields;
  for (const TableFormat& table : format.tables) {
    for (const py::handle field : fields_of(table)) fields.append(field);
  }
  all["fields"] = fields;
  all["members"] = members_of(format.members);
  py::list variants;
  for (const Variant& variant : format.variants) {
    py::dict one;
    one["name"] = std::string(variant.name);
    one["meaning"] = std::string(variant.meaning);
    one["fields"] = fields_of(variant.table);
    one["members"] = members_of(variant.members);
    variants.append(std::move(one));
  }
  all["variants"] = variants;
  return all;
}

py::dict formats() {
  py::dict all;
  for (const ObjectFormat* format :
       {&scene_format(), &step_format(),   &parameter_format(),  &body_format(),
        &shape_format(), &joint_format(),  &collider_format(),   &ground_format(),
        &cable_format(), &link_format(),   &controller_format(), &trigger_format(),
        &load_format(),  &camera_format(), &camera_key_format(), &annotation_format(),
        &paint_format(), &check_format(),  &rotation_format(),   &live::change_format()}) {
    all[py::str(std::string(format->name))] = format_dict(*format);
  }
  return all;
}

/// The scene in the library's own notation.
std::string canonical(const py::object& source, const py::object& name, bool is_file,
                      const py::dict& overrides) {
  const std::vector<Override> set = overrides_of(overrides);
  const SceneResult scene = is_file
                                ? load_scene(text(source, "source"), set)
                                : load_scene_text(text(source, "source"), text(name, "name"), set);
  if (!scene) raise_scene_error(scene.errors);
  return write_scene(*scene);
}

}  // namespace

void bind_formats(py::module_& module) {
  module.def("formats", &formats, "The tables that scenes are read with.");
  module.def("canonical", &canonical, py::arg("source"), py::arg("name"), py::arg("is_file"),
             py::arg("overrides"), "The scene as JSON, with all that is not a default.");
}

}  // namespace sheave::python
