// Loads a scene from text: syntax, overrides, structure by the field tables, then combinations of
// settings.

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/import/import.h"
#include "scenes/jsonnet/evaluate.h"
#include "scenes/part_reader.h"
#include "scenes/scene.h"
#include "scenes/suggestion.h"
#include "scenes/validate.h"

namespace sheave {
namespace {

using json::no_node;
using json::NodeId;

/// Objects that a scene has even if its text omits them, so that overrides may set a member.
constexpr std::array<std::string_view, 1> implied_objects{"/step"};

/// Reads the structure of one document.
class SceneReader {
 public:
  SceneReader(const json::Document& document, json::Faults& faults)
      : document_(document), faults_(faults), parts_(document, faults), reader_(parts_.fields()) {}

  Scene read() {
    Scene scene;
    const NodeId root = document_.root();
    if (!reader_.read_object(root, scene_format(), pointers(&scene))) return scene;
    declare_bodies();
    read_step(scene);
    for (const NodeId node : list("parameters")) {
      reader_.read_object(node, parameter_format(),
                          pointers(&scene.model.parameters.emplace_back()));
    }
    read_model(scene);
    for (const NodeId node : list("controllers")) {
      auto controller = parts_.read_typed(node, controller_format(), controller_types(),
                                          [](ControllerDef& common) { return &common; });
      if (controller) scene.controllers.push_back(std::move(controller));
    }
    for (const NodeId node : list("triggers")) {
      reader_.read_object(node, trigger_format(), pointers(&scene.triggers.emplace_back()));
    }
    for (const NodeId node : list("loads")) {
      auto load = parts_.read_typed(node, load_format(), load_types(),
                                    [](LoadDef& common) { return &common; });
      if (load) scene.loads.push_back(std::move(load));
    }
    for (const NodeId node : list("colliders")) {
      scene.model.colliders.push_back(parts_.read_collider(node));
    }
    if (has("ground")) read_plain("ground", ground_format(), &scene.model.ground.emplace());
    if (has("camera")) read_plain("camera", camera_format(), &scene.camera.emplace());
    for (const NodeId node : list("camera_path")) {
      reader_.read_object(node, camera_key_format(), pointers(&scene.camera_path.emplace_back()));
    }
    for (const NodeId node : list("annotations")) {
      reader_.read_object(node, annotation_format(), pointers(&scene.annotations.emplace_back()));
    }
    for (const NodeId node : list("paint")) {
      reader_.read_object(node, paint_format(), pointers(&scene.paint.emplace_back()));
    }
    for (const NodeId node : list("checks")) {
      reader_.read_object(node, check_format(), pointers(&scene.checks.emplace_back()));
    }
    for (const char* key : {"parameters", "joints", "cables", "controllers", "triggers", "loads"}) {
      reader_.unique_names(list(key), key);
    }
    return scene;
  }

 private:
  static std::array<void*, 1> pointers(void* object) { return {object}; }
  [[nodiscard]] bool has(std::string_view key) const {
    return document_.member(document_.root(), key) != no_node;
  }
  /// The elements of a list of the scene. Faults of the list itself are reported once, at its first
  /// use.
  std::span<const NodeId> list(std::string_view key) {
    const auto known = lists_.find(key);
    if (known != lists_.end()) return known->second;
    return lists_[key] = reader_.list(document_.root(), *scene_format().member(key));
  }
  void read_plain(std::string_view key, const ObjectFormat& format, void* object) {
    if (has(key)) {
      reader_.read_object(document_.member(document_.root(), key), format, pointers(object));
    }
  }

  /// A body's number is its place in the list.
  void declare_bodies() {
    const std::span<const NodeId> bodies = list("bodies");
    const auto first = reader_.unique_names(bodies, "bodies");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const NodeId name = document_.member(bodies[i], "name");
      if (name == no_node || document_.kind(name) != json::Kind::string) continue;
      const int number = first.at(document_.string(name));
      if (number == static_cast<int>(i)) reader_.declare_body(document_.string(name), number);
    }
  }

  void read_model(Scene& scene) {
    Model& model = scene.model;
    model.bodies.reserve(list("bodies").size());
    std::vector<std::optional<BodyId>> relative_to;
    for (const NodeId node : list("bodies")) {
      BodyPlacementDef placement;
      model.bodies.push_back(parts_.read_body(node, &placement));
      relative_to.push_back(placement.relative_to);
    }
    PlacementResolver(document_, reader_).place_bodies(list("bodies"), relative_to, model.bodies);
    for (const NodeId node : list("joints")) {
      if (auto joint = parts_.read_joint(node, &model.bodies)) {
        model.joints.push_back(std::move(joint));
      }
    }
    for (const NodeId node : list("cables")) scene.cables.push_back(parts_.read_cable(node));
  }

  /// Reads the preset first, because given settings replace those of the preset.
  void read_step(Scene& scene) {
    const NodeId node = document_.member(document_.root(), "step");
    if (node == no_node) return;
    StepPresetDef& named = scene.step_preset;
    StepSettings given;
    const std::array<void*, 2> objects{&named, &given};
    if (!reader_.read_object(node, step_format(), objects)) return;
    scene.model.step = StepSettings::of(named.preset);
    const NodeId substeps = document_.member(node, "substeps");
    if (given.tolerance > 0.0 && substeps != no_node) {
      faults_.add({document_.offset(substeps),
                   "/step/substeps",
                   "a tolerance chooses the substeps, so their number cannot be set beside it: "
                   "remove either \"substeps\" or \"tolerance\"",
                   document_.excerpt(substeps),
                   {}});
    }
    for (const Field& field : StepSettings::field_table()) {
      if (document_.member(node, field.name) != no_node) {
        copy_value(field, &given, &scene.model.step);
      }
    }
  }

  const json::Document& document_;
  json::Faults& faults_;
  PartReader parts_;
  FieldReader& reader_;
  std::unordered_map<std::string_view, std::span<const NodeId>> lists_;
};

void add_errors(const Errors& errors, const json::Document& document, json::Faults& faults) {
  for (const Error& error : errors) {
    const std::string pointer = pointer_in_text(document, error.path);
    const json::Document::Target target = document.find(pointer);
    const bool scalar = target.exact && document.kind(target.node) != json::Kind::object;
    faults.add({document.offset(target.node),
                pointer,
                error.message,
                scalar ? document.excerpt(target.node) : std::string(),
                {}});
  }
}

/// Removes a member that the text itself has, not one that an override has set.
void drop_member(json::Document& document, std::string_view pointer, const std::string& file_name) {
  const json::Document::Target target = document.find(pointer);
  if (!target.exact) return;
  if (document.location(document.offset(target.node)).file == file_name) {
    document.remove(target.node);
  }
}

/// Removes from the text `substeps` where an override sets a tolerance, and the other way round, and
/// the settings of a drive that it cannot have any more when an override
/// changes its kind: its times, values and limits if it becomes "none". Settings by overrides
/// themselves stay, and are reported if they do not fit.
void drop_companions(json::Document& document, const Override& changed,
                     const std::string& file_name) {
  const std::string_view pointer = changed.pointer;
  if (pointer == "/step/tolerance") return drop_member(document, "/step/substeps", file_name);
  if (pointer == "/step/substeps") return drop_member(document, "/step/tolerance", file_name);
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

SceneResult load_json(std::string_view text, const std::string& file_name,
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
  // The tree of a large scene is as large as the scene. Only errors need it, so it is parsed again
  // for them.
  document.reset();
  const Errors errors = validate_scene(scene, overridden("/duration", overrides));
  if (errors.empty()) return {std::move(scene), {}, SceneStatus::ok};
  document = parsed();
  add_errors(errors, *document, faults);
  return failure(faults, &*document, file_name);
}

/// The names of the parameters in a text that may be no scene.
std::vector<std::string> parameter_names(std::string_view text) {
  const auto scene = nlohmann::json::parse(text, nullptr, false, true);
  std::vector<std::string> names;
  if (!scene.is_object() || !scene.contains("parameters")) return names;
  for (const auto& own : scene["parameters"]) {
    if (own.is_object() && own.contains("name") && own["name"].is_string()) {
      names.push_back(own["name"].get<std::string>());
    }
  }
  return names;
}

SceneResult no_parameter(const std::string& file_name, const std::string& name,
                         const std::vector<std::string>& names) {
  Suggestion suggestion(name);
  for (const std::string& known : names) suggestion.consider(known);
  const std::string message =
      names.empty() ? "has no parameter \"" + name +
                          "\": a scene has those of its list \"parameters\", and one in Jsonnet "
                          "(.jsonnet) those of its function; a setting is named by its JSON "
                          "pointer, such as /bodies/load/mass"
                    : fmt::format("has no parameter \"{}\"{}; it has \"{}\"", name,
                                  suggestion.question(), fmt::join(names, "\", \""));
  SceneResult result;
  result.status = SceneStatus::invalid;
  result.errors.push_back({file_name, 0, 0, "", message, {}, {}, FaultCode::meaning});
  return result;
}

SceneResult load_model(std::string_view text, const std::string& file_name,
                       const std::vector<Override>& overrides) {
  import::Outcome made = import::import_model(text, file_name);
  if (!made.errors.empty()) return {std::nullopt, std::move(made.errors), SceneStatus::invalid};
  SceneResult result = load_json(made.json, file_name, overrides);
  import::locate(result.errors, file_name, made);
  result.notice = import::notice(made, file_name);
  return result;
}

}  // namespace

SceneResult load_scene_text(std::string_view text, const std::string& file_name,
                            const std::vector<Override>& overrides, const JsonnetOptions& jsonnet) {
  if (!jsonnet::is_program(file_name)) {
    const bool is_model = import::is_model(text);
    std::vector<Override> all;
    for (const SceneParameter& parameter : jsonnet.parameters) {
      const auto names = is_model ? std::vector<std::string>() : parameter_names(text);
      if (std::find(names.begin(), names.end(), parameter.name) == names.end()) {
        return no_parameter(file_name, parameter.name, names);
      }
      all.push_back({"/parameters/" + parameter.name + "/value", parameter.value,
                     "--param " + parameter.name});
    }
    // Settings by pointers are the more special ones, so they are the last word.
    all.insert(all.end(), overrides.begin(), overrides.end());
    return is_model ? load_model(text, file_name, all) : load_json(text, file_name, all);
  }
  jsonnet::Outcome made = jsonnet::evaluate(text, file_name, jsonnet);
  if (!made.errors.empty()) {
    return {std::nullopt, std::move(made.errors), SceneStatus::invalid};
  }
  SceneResult result = load_json(made.json, file_name, overrides);
  jsonnet::locate(result.errors, file_name, made);
  return result;
}

SceneText read_scene_text(const std::string& path) {
  const auto failed = [&](SceneStatus status, std::string message) {
    SceneText result;
    result.failure = file_error(path, status, std::move(message));
    return result;
  };
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) {
    return failed(SceneStatus::not_found, "there is no such file");
  }
  if (std::filesystem::is_directory(status)) {
    return failed(SceneStatus::unreadable, "is a directory, not a scene file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return failed(SceneStatus::unreadable, "cannot be opened for reading");
  // One byte more than allowed shows that the file is too long.
  const std::size_t most = json::Limits{}.bytes + 1;
  SceneText result;
  const std::uintmax_t size = std::filesystem::file_size(path, code);  // a pipe has no size
  if (!code) result.text.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(size, most)));
  std::vector<char> block(std::size_t{1} << 16U);
  while (file && result.text.size() < most) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    result.text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) return failed(SceneStatus::unreadable, "cannot be read");
  return result;
}

SceneResult load_scene(const std::string& path, const std::vector<Override>& overrides,
                       const JsonnetOptions& jsonnet) {
  SceneText read = read_scene_text(path);
  if (!read.failure.errors.empty()) return std::move(read.failure);
  return load_scene_text(read.text, path, overrides, jsonnet);
}

}  // namespace sheave
