#include "scenes/validate.h"

#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "cable/simulation.h"
#include "engine/field_check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/format.h"
#include "scenes/quantity_list.h"
#include "scenes/validate_parameters.h"
#include "scenes/validate_pictures.h"

namespace sheave {
namespace {

/// Sine of the smallest angle between directions that count as not parallel.
constexpr double least_sine = 1e-6;

bool parallel(const Vector3& a, const Vector3& b) {
  return !(a.normalized().cross(b.normalized()).norm() > least_sine);
}

void check_camera(const CameraDef& camera, Errors& errors) {
  check_fields(CameraDef::field_table(), &camera, "/camera", errors);
  const auto fail = [&](std::string_view field, std::string message) {
    errors.push_back({fmt::format("/camera{}", field), "camera: " + std::move(message)});
  };
  const bool orthographic = camera.projection == Projection::orthographic;
  if (camera.position.has_value() != camera.target.has_value()) {
    fail(camera.position ? "/position" : "/target", "position and target need each other");
  }
  if (camera.direction && camera.position) {
    fail("/direction", "direction excludes position and target; leave one out");
  }
  if (camera.vertical_fov && orthographic) {
    fail("/vertical_fov", "only a perspective picture has an opening angle; give height instead");
  }
  if (camera.height && !orthographic) {
    fail("/height",
         "only an orthographic picture has a height in metres; give vertical_fov or "
         "projection \"orthographic\"");
  } else if (camera.height && !camera.position) {
    fail("/height", "height needs position and target; without them all bodies are in view");
  }
  if (camera.direction && !(camera.direction->norm() > 0.0)) {
    fail("/direction", "direction must not be zero");
    return;
  }
  if (camera.up && !(camera.up->norm() > 0.0)) {
    fail("/up", "up must not be zero");
    return;
  }
  Vector3 view = camera.direction.value_or(Vector3::Zero());
  if (camera.position && camera.target) {
    view = *camera.target - *camera.position;
    if (!(view.norm() > 0.0)) {
      fail("/target", "target must not be the position of the eye");
      return;
    }
  }
  // Without an explicit `up` a view along gravity is allowed; another up direction is then chosen.
  const bool looks = view.norm() > 0.0;
  if (looks && camera.up && parallel(view, *camera.up)) {
    fail("/up", "up must not be parallel to the direction of view");
  }
}

void check_paint(const Scene& scene, Errors& errors) {
  std::unordered_set<int> painted;
  for (std::size_t i = 0; i < scene.paint.size(); ++i) {
    const std::string path = fmt::format("/paint/{}", i);
    const BodyId body = scene.paint[i].body;
    check_fields(PaintDef::field_table(), &scene.paint[i], path, errors);
    if (body.is_world() || static_cast<std::size_t>(body.index) >= scene.model.bodies.size()) {
      errors.push_back({path + "/body", "paint: there must be a body to be painted"});
    } else if (!painted.insert(body.index).second) {
      const std::string& name = scene.model.bodies[static_cast<std::size_t>(body.index)].name;
      errors.push_back({path + "/body", fmt::format("\"{}\" has been painted already", name)});
    }
  }
}

/// Checks a check of the scene, except for the name of its quantity.
void check_check(const CheckDef& check, const std::string& path, double duration, bool may_end_late,
                 Errors& errors) {
  check_fields(CheckDef::field_table(), &check, path, errors);
  const auto fail = [&](std::string_view field, std::string message) {
    errors.push_back({fmt::format("{}{}", path, field),
                      fmt::format("check of \"{}\": {}", check.quantity, message)});
  };
  if (!check.tolerance && !check.relative_tolerance) {
    fail("", "needs tolerance or relative_tolerance");
  } else if (!check.tolerance && check.equals == 0.0) {
    fail("/relative_tolerance", "nothing passes a relative tolerance of 0; give tolerance");
  }
  const bool window = check.from || check.to;
  if (check.statistic == Statistic::at && window) {
    fail(check.from ? "/from" : "/to", "the statistic at has no window; give at");
  }
  if (check.statistic != Statistic::at && check.at) {
    fail("/at", fmt::format("the statistic {} has a window; give from and to",
                            statistic_names[static_cast<std::size_t>(check.statistic)]));
  }
  const bool has_end = check.to || !may_end_late;
  if (check.from && has_end && !(*check.from < check.to.value_or(duration))) {
    fail("/from", fmt::format("the window must not be empty; it ends at {} s",
                              number_text(check.to.value_or(duration))));
  }
  if (may_end_late) return;
  if (check.at && *check.at > duration) {
    fail("/at", fmt::format("must be at most the duration, {} s", number_text(duration)));
  }
  if (check.to && *check.to > duration) {
    fail("/to", fmt::format("must be at most the duration, {} s", number_text(duration)));
  }
}

void check_names(const Scene& scene, Errors& errors) {
  const auto check = [&](const std::string& name, std::string_view list, std::size_t i) {
    if (is_name(name)) return;
    errors.push_back({fmt::format("/{}/{}/name", list, i),
                      fmt::format("a name must consist of {}; this is \"{}\"", name_rule, name)});
  };
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    check(scene.model.bodies[i].name, "bodies", i);
  }
  for (std::size_t i = 0; i < scene.model.joints.size(); ++i) {
    check(scene.model.joints[i]->name, "joints", i);
  }
  for (std::size_t i = 0; i < scene.cables.size(); ++i) check(scene.cables[i].name, "cables", i);
  for (std::size_t i = 0; i < scene.controllers.size(); ++i) {
    check(scene.controllers[i]->name, "controllers", i);
  }
  for (std::size_t i = 0; i < scene.triggers.size(); ++i) {
    check(scene.triggers[i].name, "triggers", i);
  }
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    check(scene.loads[i]->name, "loads", i);
  }
}

/// A body and a joint may have the same name if they have no quantity in common.
void check_shared_names(const Model& model, Errors& errors) {
  std::unordered_map<std::string_view, const BodyDef*> bodies;
  for (const BodyDef& body : model.bodies) bodies.emplace(body.name, &body);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointDef& joint = *model.joints[i];
    const auto body = bodies.find(joint.name);
    if (body == bodies.end()) continue;
    const std::string shared = shared_quantity(joint, *body->second);
    if (shared.empty()) continue;
    errors.push_back({fmt::format("/joints/{}/name", i),
                      fmt::format("a body is called \"{0}\" too, so {0}.{1} could be that of "
                                  "either; choose another name",
                                  joint.name, shared)});
  }
}

void check_checks(const Scene& scene, bool may_end_late, Errors& errors) {
  if (scene.checks.empty()) return;
  std::vector<std::string> quantities;
  for (const CheckDef& check : scene.checks) quantities.push_back(check.quantity);
  const auto index = QuantityIndex::of(scene, quantities);
  for (std::size_t i = 0; i < scene.checks.size(); ++i) {
    const std::string path = fmt::format("/checks/{}", i);
    check_check(scene.checks[i], path, scene.duration, may_end_late, errors);
    const Result<Expression> quantity = index->compile(scene.checks[i].quantity);
    if (!quantity) errors.push_back({path + "/quantity", quantity.errors().front().message});
  }
}

void check_settings_of_controls(const Scene& scene, Errors& errors) {
  const auto append = [&](Errors found) {
    for (Error& error : found) errors.push_back(std::move(error));
  };
  for (std::size_t i = 0; i < scene.controllers.size(); ++i) {
    const ControllerDef& controller = *scene.controllers[i];
    const std::string path = fmt::format("/controllers/{}", i);
    check_fields(ControllerDef::common_field_table(), &controller, path, errors);
    for (const auto& type : controller_types()) {
      if (type.name != controller.type()) continue;
      check_fields(type.fields(), controller.settings(), path, errors);
    }
    append(controller.validate(path));
  }
  for (std::size_t i = 0; i < scene.triggers.size(); ++i) {
    const std::string path = fmt::format("/triggers/{}", i);
    check_fields(TriggerDef::field_table(), &scene.triggers[i], path, errors);
    append(scene.triggers[i].validate(path));
  }
  append(validate_loads({scene.model, scene.cables}, scene.loads));
}

}  // namespace

Errors validate_scene(const Scene& scene) { return validate_scene(scene, false); }

Errors validate_scene(const Scene& scene, bool checks_may_end_late) {
  Errors errors;
  check_fields(Scene::field_table(), &scene, "", errors);
  check_names(scene, errors);
  check_shared_names(scene.model, errors);
  if (scene.camera) check_camera(*scene.camera, errors);
  for (Error& error : validate_pictures(scene)) errors.push_back(std::move(error));
  for (Error& error : validate_parameters(scene)) errors.push_back(std::move(error));
  check_paint(scene, errors);
  check_checks(scene, checks_may_end_late, errors);
  check_settings_of_controls(scene, errors);
  if (scene.controllers.empty() && scene.triggers.empty() && scene.loads.empty()) {
    for (Error& error : Simulation::check(scene.model, scene.cables)) {
      errors.push_back(std::move(error));
    }
    return errors;
  }
  const bool sound = errors.empty();
  const Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) {
    // Making the simulation checks loads, triggers and controllers, too.
    for (const Error& error : simulation.errors()) {
      const auto is_same = [&](const Error& known) {
        return known.path == error.path && known.message == error.message;
      };
      if (std::none_of(errors.begin(), errors.end(), is_same)) errors.push_back(error);
    }
  } else if (sound) {
    errors = try_controls(scene);
  }
  return errors;
}

}  // namespace sheave
