#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command/explain/explain.h"
#include "command/text/table.h"
#include "engine/body_mass.h"
#include "engine/body_set.h"
#include "engine/joints/coordinate.h"

namespace sheave::command {
namespace {

/// The value of a number or a choice among the settings of a joint; empty if it has its default.
std::string setting_text(const JointDef& joint, std::string_view name) {
  for (const auto& type : joint_types()) {
    if (type.name != joint.type()) continue;
    for (const Field& field : type.fields()) {
      if (field.name != name) continue;
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read
      const FieldSlot slot = field.slot(const_cast<void*>(joint.settings()));
      const std::string unit = field.unit.empty() ? "" : " " + std::string(field.unit);
      if (const auto* number = std::get_if<double*>(&slot)) {
        return **number == 0.0 ? "" : short_number(**number) + unit;
      }
      if (const auto* number = std::get_if<std::optional<double>*>(&slot)) {
        return **number ? short_number(***number) + unit : "";
      }
      if (const auto* choice = std::get_if<ChoiceSlot>(&slot)) {
        const int index = choice->get(choice->object);
        return index <= 0 ? "" : std::string(field.choices[static_cast<std::size_t>(index)]);
      }
    }
  }
  return "";
}

/// The drives, springs, stops and friction of a joint, each with its coordinate.
std::string effects_text(const JointDef& joint) {
  std::string text;
  const auto coordinates = joint.coordinates();
  for (const JointCoordinateInfo& coordinate : coordinates) {
    const std::string name(coordinate.name);
    const std::string prefix = coordinates.size() > 1 ? name + "_" : "";
    const auto value = [&](const char* key) { return setting_text(joint, prefix + key); };
    if (const std::string drive = value("drive"); !drive.empty()) {
      const std::string limit = value("drive_limit");
      text += fmt::format("; a drive gives its {} a {}{}", name, drive,
                          limit.empty() ? "" : " with at most " + limit);
    }
    if (const std::string spring = value("stiffness"); !spring.empty()) {
      text += fmt::format("; a spring of {} acts on its {}", spring, name);
    }
    if (const std::string friction = value("friction"); !friction.empty()) {
      text += fmt::format("; dry friction of {} resists its {}", friction, name);
    }
    const std::string lower = value("lower");
    const std::string upper = value("upper");
    if (!lower.empty() && !upper.empty()) {
      text += fmt::format("; stops keep its {} between {} and {}", name, lower, upper);
    } else if (!lower.empty() || !upper.empty()) {
      text += fmt::format("; a stop keeps its {} {} {}", name, lower.empty() ? "below" : "above",
                          lower + upper);
    }
  }
  return text;
}

std::string drive_text(const BodyDef& body) {
  if (body.drive == DriveKind::none) return "";
  const std::string kind(drive_names[static_cast<std::size_t>(body.drive)]);
  const char* unit = body.drive == DriveKind::speed   ? "rad/s"
                     : body.drive == DriveKind::angle ? "rad"
                                                      : "N m";
  if (body.drive_values.size() == 1) {
    return fmt::format("; its drive gives it a {} of {} {}", kind,
                       short_number(body.drive_values[0]), unit);
  }
  const auto [least, most] =
      std::minmax_element(body.drive_values.begin(), body.drive_values.end());
  if (body.drive_values.empty()) return fmt::format("; its drive gives it a {}", kind);
  return fmt::format("; its drive gives it a {} over time, through values from {} to {} {}", kind,
                     short_number(*least), short_number(*most), unit);
}

std::string mobility_text(const Model& model, const Simulation& simulation, int index) {
  const BodyDef& body = model.bodies[static_cast<std::size_t>(index)];
  const BodyProperties& properties = simulation.world.bodies()[index];
  switch (body.mobility) {
    case Mobility::free:
      return "can move in all six directions";
    case Mobility::planar:
      return "stays in a plane with the normal " + direction_text(properties.axis);
    case Mobility::slider:
      return "slides along " + direction_text(properties.axis);
    case Mobility::rotor:
      return body.mount ? "turns about an axle that " + body_text(model, *body.mount) + " carries"
                        : "turns about a fixed axle along " + direction_text(properties.axis);
    case Mobility::kinematic:
      return "moves as a function of time";
    case Mobility::knot:
      return "is a knot without mass, which the forces of its cables place";
    case Mobility::fixed:
      break;
  }
  return "is fixed";
}

/// Where the shapes of a body have placed its centre of mass; empty where that is its origin or
/// given.
std::string center_text(const BodyDef& body, const Vector3& center) {
  const bool moved = body.shapes.size() > 1 && !body.center_of_mass && center.norm() > 1e-9;
  if (!moved || body.mobility == Mobility::slider) return "";
  const auto number = [&](double value) {
    return short_number(std::abs(value) > 1e-9 * center.norm() ? value : 0.0);
  };
  return fmt::format(", its centre of mass, by its shapes, at ({}, {}, {}) of the body",
                     number(center.x()), number(center.y()), number(center.z()));
}

std::string mass_text(const Simulation& simulation, int index) {
  const BodyProperties& properties = simulation.world.bodies()[index];
  const BodyDef& body = simulation.world.bodies().definition(index);
  if (body.mobility == Mobility::kinematic || body.mobility == Mobility::knot) return "";
  const bool rotor = body.mobility == Mobility::rotor;
  if (rotor && properties.axis_inertia == 0.0) return ", without inertia";
  const MassProperties own = defined_mass_properties(body);
  const std::string mass = short_number(own.mass) + " kg";
  return rotor ? fmt::format(", {} with {} kg m2 about it", mass,
                             short_number(properties.axis_inertia))
               : ", " + mass + center_text(body, own.center_of_mass);
}

Sentences bodies_text(const Model& model, const Simulation& simulation) {
  Sentences sentences;
  std::vector<std::string> fixed;
  std::size_t moving = 0;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const BodyDef& body = model.bodies[static_cast<std::size_t>(i)];
    if (body.mobility == Mobility::fixed) {
      fixed.push_back("\"" + body.name + "\"");
      continue;
    }
    if (++moving > most_explained) continue;
    sentences.push_back(fmt::format("Body \"{}\" {}{}{}.", body.name,
                                    mobility_text(model, simulation, i), mass_text(simulation, i),
                                    drive_text(body)));
  }
  if (moving > most_explained) {
    sentences.push_back(fmt::format("There are {} more moving bodies.", moving - most_explained));
  }
  if (!fixed.empty()) {
    sentences.push_back(fmt::format("{} {} fixed to the world.", joined_names(fixed),
                                    fixed.size() == 1 ? "is" : "are"));
  }
  return sentences;
}

Sentences joints_text(const Model& model) {
  Sentences sentences;
  for (const auto& joint : model.joints) {
    if (sentences.size() == most_explained) {
      sentences.push_back(
          fmt::format("There are {} more joints.", model.joints.size() - most_explained));
      break;
    }
    const bool carried = !joint->carrier_body().is_world();
    sentences.push_back(fmt::format(
        "Joint \"{}\" ({}) joins {} and {}{}{}.", joint->name, joint->type(),
        body_text(model, joint->body_a), body_text(model, joint->body_b),
        carried ? " on " + body_text(model, joint->carrier_body()) : "", effects_text(*joint)));
  }
  return sentences;
}

std::string trigger_text(const TriggerDef& trigger) {
  const std::string when =
      trigger.at
          ? fmt::format("At {} s", short_number(*trigger.at))
          : fmt::format("Once {} is {} {}", trigger.quantity, trigger.above ? "above" : "below",
                        short_number(trigger.above ? *trigger.above : *trigger.below));
  const std::string action(trigger_action_names[static_cast<std::size_t>(trigger.action)]);
  const std::string value = trigger.value ? " to " + short_number(*trigger.value) : "";
  return fmt::format("{}, trigger \"{}\" does this: {}{}{}.", when, trigger.name, action,
                     trigger.target.empty() ? "" : " " + trigger.target, value);
}

Sentences control_text(const Scene& scene) {
  Sentences sentences;
  for (const auto& controller : scene.controllers) {
    if (sentences.size() == most_explained) break;
    sentences.push_back(fmt::format("Controller \"{}\" ({}) leads {} to its setpoint by {}{}.",
                                    controller->name, controller->type(), controller->measures,
                                    controller->control,
                                    controller->on ? "" : "; at first it is off"));
  }
  for (const TriggerDef& trigger : scene.triggers) {
    if (sentences.size() == 2 * most_explained) break;
    sentences.push_back(trigger_text(trigger));
  }
  const Model& model = scene.model;
  for (const auto& load : scene.loads) {
    if (sentences.size() == 3 * most_explained) break;
    sentences.push_back(fmt::format("Load \"{}\" ({}) acts on {} over time.", load->name,
                                    load->type(), body_text(model, load->body)));
  }
  if (!model.colliders.empty()) {
    sentences.push_back(
        fmt::format("{} can touch each other.", counted(model.colliders.size(), "body", "bodies")));
  }
  if (model.ground) sentences.emplace_back("There is a ground.");
  for (const ParameterDef& own : model.parameters) {
    if (sentences.size() >= 4 * most_explained) break;
    sentences.push_back(fmt::format("Parameter \"{}\" is {}{}{}{}.", own.name,
                                    short_number(own.value), own.unit.empty() ? "" : " ", own.unit,
                                    own.meaning.empty() ? "" : ": " + own.meaning));
  }
  return sentences;
}

}  // namespace

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string joined_names(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), most_explained);
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + names[i];
  }
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string direction_text(const Vector3& direction) {
  const auto part = [](double value) {
    return short_number(std::abs(value) < 1e-12 ? 0.0 : value);
  };
  return fmt::format("({}, {}, {})", part(direction.x()), part(direction.y()), part(direction.z()));
}

std::string body_text(const Model& model, BodyId body) {
  return body.is_world() ? "the world"
                         : "\"" + model.bodies[static_cast<std::size_t>(body.index)].name + "\"";
}

Sentences explain_parts(const Scene& scene, const Simulation& simulation) {
  Sentences sentences = bodies_text(scene.model, simulation);
  for (const Sentences& more : {joints_text(scene.model), control_text(scene)}) {
    sentences.insert(sentences.end(), more.begin(), more.end());
  }
  return sentences;
}

}  // namespace sheave::command
