// Writes a scene as text, by the tables with which the loader reads it.

#include "scenes/field_json.h"
#include "scenes/format.h"
#include "scenes/json/pretty.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

using Json = nlohmann::ordered_json;

class SceneWriter {
 public:
  explicit SceneWriter(const Scene& scene)
      : scene_(scene), name_of_([this](BodyId body) { return body_name(body); }) {}

  [[nodiscard]] Json write() const {
    const Model& model = scene_.model;
    Json root = Json::object();
    add_fields(root, scene_format().tables[0], &scene_);
    Json step = write_step();
    if (!step.empty()) root["step"] = std::move(step);
    add_list(root, "parameters", model.parameters,
             [&](const ParameterDef& own) { return plain(parameter_format(), &own); });
    add_list(root, "bodies", model.bodies, [&](const BodyDef& body) { return write_body(body); });
    add_list(root, "joints", model.joints, [&](const std::shared_ptr<const JointDef>& joint) {
      return typed(joint_format(), joint->type(), joint.get(), joint->settings());
    });
    add_list(root, "cables", scene_.cables,
             [&](const CableDef& cable) { return write_cable(cable); });
    add_list(root, "controllers", scene_.controllers,
             [&](const std::shared_ptr<const ControllerDef>& controller) {
               return typed(controller_format(), controller->type(), controller.get(),
                            controller->settings());
             });
    add_list(root, "triggers", scene_.triggers,
             [&](const TriggerDef& trigger) { return plain(trigger_format(), &trigger); });
    add_list(root, "loads", scene_.loads, [&](const std::shared_ptr<const LoadDef>& load) {
      return typed(load_format(), load->type(), load.get(), load->settings());
    });
    add_list(root, "colliders", model.colliders,
             [&](const ColliderDef& collider) { return plain(collider_format(), &collider); });
    if (model.ground) root["ground"] = plain(ground_format(), &*model.ground);
    if (scene_.camera) root["camera"] = plain(camera_format(), &*scene_.camera);
    add_list(root, "camera_path", scene_.camera_path,
             [&](const CameraKeyDef& key) { return plain(camera_key_format(), &key); });
    add_list(root, "annotations", scene_.annotations,
             [&](const AnnotationDef& text) { return plain(annotation_format(), &text); });
    add_list(root, "paint", scene_.paint,
             [&](const PaintDef& paint) { return plain(paint_format(), &paint); });
    add_list(root, "checks", scene_.checks,
             [&](const CheckDef& check) { return plain(check_format(), &check); });
    return root;
  }

 private:
  [[nodiscard]] std::string body_name(BodyId body) const {
    const auto index = static_cast<std::size_t>(body.index);
    return body.is_world() || index >= scene_.model.bodies.size() ? "world"
                                                                  : scene_.model.bodies[index].name;
  }

  /// Adds the fields that are required or differ from their defaults.
  void add_fields(Json& object, const TableFormat& table, const void* values) const {
    add_fields(object, table, values, table.defaults.get());
  }
  void add_fields(Json& object, const TableFormat& table, const void* values,
                  const void* defaults) const {
    for (const Field& field : table.fields) {
      const FieldSlot slot = slot_of(field, values);
      if (field.presence == Presence::optional) {
        if (is_absent(slot) || same_value(field, values, defaults)) continue;
      }
      object[std::string(field.name)] = field_json(field, slot, name_of_);
    }
  }
  [[nodiscard]] Json plain(const ObjectFormat& format, const void* values) const {
    Json object = Json::object();
    add_fields(object, format.tables[0], values);
    return object;
  }
  /// An object of one of several types. `common` has the type of the format's table, `settings` the
  /// derived type.
  [[nodiscard]] Json typed(const ObjectFormat& format, std::string_view type, const void* common,
                           const void* settings) const {
    Json object = Json::object();
    object["type"] = type;
    add_fields(object, format.tables[0], common);
    const Variant* variant = format.variant(type);
    if (variant != nullptr) add_fields(object, variant->table, settings);
    return object;
  }
  template <class Element, class Write>
  static void add_list(Json& object, const char* key, const std::vector<Element>& elements,
                       const Write& write) {
    if (elements.empty()) return;
    Json& list = object[key] = Json::array();
    for (const Element& element : elements) list.push_back(write(element));
  }

  [[nodiscard]] Json write_step() const {
    Json object = Json::object();
    StepSettings preset = StepSettings::of(scene_.step_preset.preset);
    // The text cannot have both.
    if (scene_.model.step.tolerance > 0.0) preset.substeps = scene_.model.step.substeps;
    add_fields(object, step_format().tables[0], &scene_.step_preset);
    add_fields(object, step_format().tables[1], &scene_.model.step, &preset);
    return object;
  }
  [[nodiscard]] Json write_body(const BodyDef& body) const {
    Json object = plain(body_format(), &body);
    const auto write_shape = [&](const PlacedShape& placed) {
      return typed(shape_format(), placed.shape->type(), &placed, placed.shape->settings());
    };
    if (body.shapes.size() == 1) {
      object["shape"] = write_shape(body.shapes.front());
    } else {
      add_list(object, "shapes", body.shapes, write_shape);
    }
    return object;
  }
  [[nodiscard]] Json write_cable(const CableDef& cable) const {
    Json object = plain(cable_format(), &cable);
    add_list(object, "links", cable.links, [&](const std::shared_ptr<const LinkDef>& link) {
      return typed(link_format(), link->type(), link.get(), link->settings());
    });
    return object;
  }

  const Scene& scene_;
  BodyNamer name_of_;
};

}  // namespace

std::string write_scene(const Scene& scene) { return json::pretty(SceneWriter(scene).write()); }

}  // namespace sheave
