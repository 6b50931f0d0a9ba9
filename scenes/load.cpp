// From text to a scene: syntax, overrides, structure by the field tables, then what the settings
// mean together.

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "scenes/field_reader.h"
#include "scenes/scene.h"
#include "scenes/validate.h"

namespace sheave {
namespace {

using json::no_node;
using json::NodeId;

/// Objects that a scene has even if it does not mention them, so that overrides may set a member.
constexpr std::array<std::string_view, 1> implied_objects{"/step"};

/// Reads the structure of one document.
class SceneReader {
 public:
  SceneReader(const json::Document& document, json::Faults& faults)
      : document_(document), reader_(document, faults) {}

  Scene read() {
    Scene scene;
    const NodeId root = document_.root();
    if (!reader_.read_object(root, scene_format(), pointers(&scene))) return scene;
    reader_.declare_bodies(list(root, scene_format(), "bodies"));
    read_step(scene);
    scene.model.bodies.reserve(list(root, scene_format(), "bodies").size());
    for (const NodeId node : list(root, scene_format(), "bodies")) read_body(node, scene.model);
    for (const NodeId node : list(root, scene_format(), "joints")) read_joint(node, scene.model);
    for (const NodeId node : list(root, scene_format(), "cables")) {
      read_cable(node, scene.cables.emplace_back());
    }
    for (const NodeId node : list(root, scene_format(), "controllers")) {
      auto controller = read_typed(node, controller_format(), controller_types(),
                                   [](ControllerDef& common) { return &common; });
      if (controller) scene.controllers.push_back(std::move(controller));
    }
    for (const NodeId node : list(root, scene_format(), "triggers")) {
      reader_.read_object(node, trigger_format(), pointers(&scene.triggers.emplace_back()));
    }
    for (const NodeId node : list(root, scene_format(), "colliders")) {
      reader_.read_object(node, collider_format(), pointers(&scene.model.colliders.emplace_back()));
    }
    if (has("ground")) read_plain("ground", ground_format(), &scene.model.ground.emplace());
    if (has("camera")) read_plain("camera", camera_format(), &scene.camera.emplace());
    for (const NodeId node : list(root, scene_format(), "paint")) {
      reader_.read_object(node, paint_format(), pointers(&scene.paint.emplace_back()));
    }
    for (const NodeId node : list(root, scene_format(), "checks")) {
      reader_.read_object(node, check_format(), pointers(&scene.checks.emplace_back()));
    }
    reader_.unique_names(list(root, scene_format(), "joints"), "joints");
    reader_.unique_names(list(root, scene_format(), "cables"), "cables");
    reader_.unique_names(list(root, scene_format(), "controllers"), "controllers");
    reader_.unique_names(list(root, scene_format(), "triggers"), "triggers");
    return scene;
  }

 private:
  static std::array<void*, 1> pointers(void* object) { return {object}; }
  [[nodiscard]] bool has(std::string_view key) const {
    return document_.member(document_.root(), key) != no_node;
  }
  /// The elements of a list; faults of the list itself are reported once, with its first use.
  std::span<const NodeId> list(NodeId object, const ObjectFormat& format, std::string_view key) {
    const NodeId node = document_.member(object, key);
    const auto known = lists_.find(node);
    if (known != lists_.end()) return known->second;
    return lists_[node] = reader_.list(object, *format.member(key));
  }
  void read_plain(std::string_view key, const ObjectFormat& format, void* object) {
    if (has(key)) {
      reader_.read_object(document_.member(document_.root(), key), format, pointers(object));
    }
  }

  /// The preset first, because the settings that are given replace its own.
  void read_step(Scene& scene) {
    const NodeId node = document_.member(document_.root(), "step");
    if (node == no_node) return;
    StepPresetDef& named = scene.step_preset;
    StepSettings given;
    const std::array<void*, 2> objects{&named, &given};
    if (!reader_.read_object(node, step_format(), objects)) return;
    scene.model.step = StepSettings::of(named.preset);
    for (const Field& field : StepSettings::field_table()) {
      if (document_.member(node, field.name) != no_node) {
        copy_value(field, &given, &scene.model.step);
      }
    }
  }

  /// A new object of the type that the node's key "type" chooses, with its settings; null if it
  /// chooses none. `common` gives the object of the table that all types share.
  template <class Base, class Common>
  std::shared_ptr<const Base> read_typed(NodeId node, const ObjectFormat& format,
                                         std::span<const TypeEntry<Base>> types,
                                         const Common& common) {
    const Variant* variant = reader_.read_type(node, format);
    if (variant == nullptr) return nullptr;
    const auto entry = std::find_if(types.begin(), types.end(), [&](const TypeEntry<Base>& type) {
      return type.name == variant->name;
    });
    std::shared_ptr<Base> object = entry->make();
    // The object is ours and not constant; settings() is only the way to its own type.
    void* settings = const_cast<void*>(object->settings());  // NOLINT(*-const-cast)
    reader_.read_object(node, format, pointers(common(*object)), variant, settings);
    return object;
  }

  void read_shape(NodeId node, BodyDef& body) {
    PlacedShape placed;
    placed.shape = read_typed(node, shape_format(), shape_types(), [&](Shape&) { return &placed; });
    if (placed.shape) body.shapes.push_back(std::move(placed));
  }

  void read_body(NodeId node, Model& model) {
    BodyDef& body = model.bodies.emplace_back();
    if (!reader_.read_object(node, body_format(), pointers(&body))) return;
    const NodeId single = document_.member(node, "shape");
    if (single != no_node) read_shape(single, body);
    for (const NodeId shape : list(node, body_format(), "shapes")) read_shape(shape, body);
  }

  void read_joint(NodeId node, Model& model) {
    auto joint =
        read_typed(node, joint_format(), joint_types(), [](JointDef& common) { return &common; });
    if (joint) model.joints.push_back(std::move(joint));
  }

  void read_cable(NodeId node, CableDef& cable) {
    if (!reader_.read_object(node, cable_format(), pointers(&cable))) return;
    for (const NodeId child : list(node, cable_format(), "links")) {
      auto link =
          read_typed(child, link_format(), link_types(), [](LinkDef& common) { return &common; });
      if (link) cable.links.push_back(std::move(link));
    }
  }

  const json::Document& document_;
  FieldReader reader_;
  std::unordered_map<NodeId, std::span<const NodeId>> lists_;
};

/// The pointer by which the file knows a setting: a body's only shape may be written in two ways.
std::string pointer_in_file(const json::Document& document, const std::string& path) {
  if (document.find(path).exact) return path;
  for (const auto& [ours, other] : {std::pair<std::string, std::string>{"/shape", "/shapes/0"},
                                    std::pair<std::string, std::string>{"/shapes/0", "/shape"}}) {
    const std::size_t at = path.find(ours);
    if (at == std::string::npos) continue;
    const std::size_t end = at + ours.size();
    if (end < path.size() && path[end] != '/') continue;  // "/shape" is no part of "/shapes/1"
    const std::string replaced = path.substr(0, at) + other + path.substr(end);
    const std::string shape = path.substr(0, at) + other;
    if (document.find(shape).exact) return replaced;
  }
  return path;
}

void add_errors(const Errors& errors, const json::Document& document, json::Faults& faults) {
  for (const Error& error : errors) {
    const std::string pointer = pointer_in_file(document, error.path);
    const json::Document::Target target = document.find(pointer);
    const bool scalar = target.exact && document.kind(target.node) != json::Kind::object;
    faults.add({document.offset(target.node),
                pointer,
                error.message,
                scalar ? document.excerpt(target.node) : std::string(),
                {}});
  }
}

/// Takes out of the text what a drive has beside it and cannot have as the kind that an override makes it: its times, values
/// and limits if it is none now. What overrides themselves have set stays, and is told if it does not fit.
void drop_companions(json::Document& document, const Override& changed,
                     const std::string& file_name) {
  const std::string_view pointer = changed.pointer;
  const std::string_view key = pointer.substr(std::min(pointer.rfind('/') + 1, pointer.size()));
  if (key != "drive" && !key.ends_with("_drive")) return;
  const json::Document::Target parent = document.find(pointer.substr(0, pointer.rfind('/')));
  const json::Document::Target drive = document.find(pointer);
  if (!drive.exact || document.kind(drive.node) != json::Kind::string) return;
  const std::string kind = document.string(drive.node);
  const auto fits = [&](std::string_view companion) {
    if (kind == "none") return false;
    if (kind == "force" || kind == "torque") {
      return companion != "limit" && companion != "compliance";
    }
    return kind != "speed" || companion != "compliance";
  };
  const std::string prefix = std::string(key) + "_";
  const std::span<const NodeId> members = document.children(parent.node);
  for (const NodeId member : std::vector<NodeId>(members.begin(), members.end())) {
    const std::string& name = document.key(member);
    if (!name.starts_with(prefix) || fits(std::string_view(name).substr(prefix.size()))) continue;
    if (document.location(document.offset(member)).file == file_name) document.remove(member);
  }
}

bool overridden(std::string_view pointer, const std::vector<Override>& overrides) {
  return std::any_of(overrides.begin(), overrides.end(),
                     [&](const Override& o) { return o.pointer == pointer; });
}

SceneResult failure(const json::Faults& faults, const json::Document* document,
                    const std::string& file_name) {
  SceneResult result;
  result.status = SceneStatus::invalid;
  for (json::Fault& fault : faults.in_order()) {
    json::Location location{file_name, 0, 0};
    if (document != nullptr) location = document->location(fault.offset);
    result.errors.push_back({std::string(location.file), location.line, location.column,
                             std::move(fault.pointer), std::move(fault.message),
                             std::move(fault.value), std::move(fault.allowed), fault.code});
  }
  if (faults.omitted() > 0) {
    result.errors.push_back({file_name,
                             0,
                             0,
                             "",
                             fmt::format("{} further faults are not listed", faults.omitted()),
                             {},
                             {},
                             FaultCode::too_large});
  }
  return result;
}

SceneResult file_error(const std::string& path, SceneStatus status, std::string message) {
  const FaultCode code =
      status == SceneStatus::not_found ? FaultCode::not_found : FaultCode::unreadable;
  return {std::nullopt, {{path, 0, 0, "", std::move(message), {}, {}, code}}, status};
}

}  // namespace

SceneResult load_scene_text(std::string_view text, const std::string& file_name,
                            const std::vector<Override>& overrides) {
  const json::Limits limits;
  json::Faults faults(limits.faults);
  const auto parsed = [&] {
    json::Document document = json::Document::parse(text, file_name, limits, faults);
    if (document.root() == no_node) return document;
    for (const Override& o : overrides) {
      const std::string origin = o.origin.empty() ? "--set " + o.pointer : o.origin;
      document.set(o.pointer, o.value, origin, implied_objects, limits, faults);
    }
    for (const Override& o : overrides) drop_companions(document, o, file_name);
    return document;
  };
  std::optional<json::Document> document = parsed();
  if (document->root() == no_node) return failure(faults, &*document, file_name);
  Scene scene = SceneReader(*document, faults).read();
  if (!faults.empty()) return failure(faults, &*document, file_name);
  // The tree of a large scene is as large as the scene; only errors need it, and they can wait.
  document.reset();
  const Errors errors = validate_scene(scene, overridden("/duration", overrides));
  if (errors.empty()) return {std::move(scene), {}, SceneStatus::ok};
  document = parsed();
  add_errors(errors, *document, faults);
  return failure(faults, &*document, file_name);
}

SceneResult load_scene(const std::string& path, const std::vector<Override>& overrides) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) {
    return file_error(path, SceneStatus::not_found, "there is no such file");
  }
  if (std::filesystem::is_directory(status)) {
    return file_error(path, SceneStatus::unreadable, "is a directory, not a scene file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return file_error(path, SceneStatus::unreadable, "cannot be opened for reading");
  // One byte more than allowed is enough to see that there are too many.
  const std::size_t most = json::Limits{}.bytes + 1;
  std::string text;
  const std::uintmax_t size = std::filesystem::file_size(path, code);  // of no pipe
  if (!code) text.reserve(std::min<std::uintmax_t>(size, most));
  std::vector<char> block(std::size_t{1} << 16U);
  while (file && text.size() < most) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) return file_error(path, SceneStatus::unreadable, "cannot be read");
  return load_scene_text(text, path, overrides);
}

}  // namespace sheave
