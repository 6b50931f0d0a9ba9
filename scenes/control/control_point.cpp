#include "scenes/control/control_point.h"

#include <array>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/joints/coordinate.h"
#include "engine/number_text.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

using ControlKind = ControlPoint::Kind;

constexpr std::array<Quantity, 7> body_controls{{
    {"drive", "rad/s, rad, N m", "target of the rotor's drive, in the unit of its kind"},
    {"force_x", "N", "force at its centre of mass, in addition to that of its definition"},
    {"force_y", "N", "the same"},
    {"force_z", "N", "the same"},
    {"torque_x", "N m", "torque, in addition to that of its definition"},
    {"torque_y", "N m", "the same"},
    {"torque_z", "N m", "the same"},
}};
constexpr std::array<Quantity, 2> joint_controls{{
    {"drive", "m, m/s, N, rad, rad/s, N m",
     "target of its drive; <coordinate>_drive where a joint has two coordinates"},
    {"drive_limit", "N, N m",
     "largest force or torque of its drive, >= 0; <coordinate>_drive_limit likewise. A brake is a "
     "drive "
     "to the speed 0 whose limit is set, 0 where it is open"},
}};
constexpr std::array<Quantity, 2> cable_controls{{
    {"compliance", "m/N", "of a cable that has one, > 0"},
    {"breaking_tension", "N", "> 0"},
}};
constexpr std::array<Quantity, 2> link_controls{{
    {"feed_speed", "m/s", "of an attachment that has one"},
    {"friction", "", "of a link that has one, > 0; that of a sheath stays"},
}};
constexpr std::array<Quantity, 3> gravity_controls{{
    {"x", "m/s2", "acceleration of free fall"},
    {"y", "m/s2", "the same"},
    {"z", "m/s2", "the same"},
}};
constexpr std::array<Quantity, 1> muscle_controls{{
    {"excitation", "", "of a muscle, 0 ... 1, in place of its excitations"},
}};
constexpr std::array<QuantityGroup, 6> groups{{
    {"<body>.", body_controls},
    {"<joint>.", joint_controls},
    {"<cable>.", cable_controls},
    {"<cable>.link<k>.", link_controls},
    {"<load>.", muscle_controls},
    {"gravity.", gravity_controls},
}};

/// The drives of a joint's coordinates, found by their field names: "<prefix>drive".
struct JointDrive {
  std::string prefix;
  int choice = 0;  // index among the kinds of drives
};
std::vector<JointDrive> drives_of(const JointDef& joint) {
  std::vector<JointDrive> drives;
  for (const auto& entry : joint_types()) {
    if (entry.name != joint.type()) continue;
    for (const Field& field : entry.fields()) {
      if (field.name != "drive" && !field.name.ends_with("_drive")) continue;
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read
      const FieldSlot slot = field.slot(const_cast<void*>(joint.settings()));
      const auto* choice = std::get_if<ChoiceSlot>(&slot);
      if (choice == nullptr) continue;
      drives.push_back(
          {std::string(field.name.substr(0, field.name.size() - 5)), choice->get(choice->object)});
    }
  }
  return drives;
}

using Visit = std::function<void(const std::string&, const ControlPoint&)>;

void visit_bodies(const Model& model, const Visit& visit) {
  constexpr std::array<char, 3> axes{'x', 'y', 'z'};
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const BodyDef& body = model.bodies[static_cast<std::size_t>(i)];
    if (body.drive != DriveKind::none) {
      visit(body.name + ".drive", {ControlKind::body_drive, i, 0, body.drive == DriveKind::angle});
    }
    if (!yields(body.mobility)) continue;
    if (body.drive == DriveKind::speed || body.drive == DriveKind::angle) continue;
    for (int k = 0; k < 3; ++k) {
      const char axis = axes[static_cast<std::size_t>(k)];
      visit(fmt::format("{}.force_{}", body.name, axis), {ControlKind::force, i, k});
      visit(fmt::format("{}.torque_{}", body.name, axis), {ControlKind::torque, i, k});
    }
  }
  for (int k = 0; k < 3; ++k) {
    visit(fmt::format("gravity.{}", axes[static_cast<std::size_t>(k)]),
          {ControlKind::gravity, 0, k});
  }
}

void visit_joints(const Model& model, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(model.joints.size()); ++i) {
    const JointDef& joint = *model.joints[static_cast<std::size_t>(i)];
    const std::vector<JointDrive> drives = drives_of(joint);
    for (int k = 0; k < static_cast<int>(drives.size()); ++k) {
      const JointDrive& drive = drives[static_cast<std::size_t>(k)];
      if (drive.choice == static_cast<int>(CoordinateDrive::none)) continue;
      const bool position = drive.choice == static_cast<int>(CoordinateDrive::position);
      visit(fmt::format("{}.{}drive", joint.name, drive.prefix),
            {ControlKind::joint_drive, i, k, position});
      if (drive.choice == static_cast<int>(CoordinateDrive::force)) continue;
      visit(fmt::format("{}.{}drive_limit", joint.name, drive.prefix),
            {ControlKind::joint_limit, i, k});
    }
  }
}

void visit_cables(const std::vector<CableDef>& cables, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(cables.size()); ++i) {
    const CableDef& cable = cables[static_cast<std::size_t>(i)];
    visit(cable.name + ".compliance", {ControlKind::compliance, i});
    visit(cable.name + ".breaking_tension", {ControlKind::breaking_tension, i});
    for (int k = 0; k < static_cast<int>(cable.links.size()); ++k) {
      visit(fmt::format("{}.link{}.feed_speed", cable.name, k), {ControlKind::feed_speed, i, k});
      visit(fmt::format("{}.link{}.friction", cable.name, k), {ControlKind::link_friction, i, k});
    }
  }
}

void visit_muscles(std::span<const std::shared_ptr<const LoadDef>> loads, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(loads.size()); ++i) {
    const LoadDef& load = *loads[at(i)];
    if (load.is_muscle()) visit(load.name + ".excitation", {ControlKind::excitation, i, -1});
  }
}

Errors set_excitation(World& world, int place, double value) {
  if (!(value >= 0.0 && value <= 1.0)) {
    return {{"", fmt::format("the excitation of a muscle must be between 0 and 1, not {}",
                             number_text(value))}};
  }
  if (place >= 0) world.memory()[at(place)] = value;
  return {};
}

/// The force that is set on a body now; the caller changes one of its components.
PointForce force_now(const Simulation& simulation, int body) {
  const ForceControl* set = simulation.world.state().controls.forces.find(body);
  PointForce force;
  if (set != nullptr) {
    force.force = set->force;
    force.torque = set->torque;
  }
  return force;
}

}  // namespace

bool ControlPoint::can_take_time() const {
  return kind == ControlKind::body_drive || kind == ControlKind::joint_drive ||
         kind == ControlKind::feed_speed;
}

Errors ControlPoint::set(Simulation& simulation, double value, double interval,
                         std::optional<double> over) const {
  World& world = simulation.world;
  if (over && !can_take_time()) {
    return {{"",
             "only a drive or a feed reaches its value over a time; other controls are set at "
             "once"}};
  }
  if (!over && takes_time) over = interval;
  const DriveTarget target = over ? DriveTarget(value, *over) : DriveTarget(value);
  switch (kind) {
    case ControlKind::body_drive:
      return world.set_drive(BodyId{entity}, target);
    case ControlKind::joint_drive:
      return world.set_joint_drive(entity, item, target);
    case ControlKind::joint_limit:
      return world.set_joint_drive_limit(entity, item, value);
    case ControlKind::force:
    case ControlKind::torque: {
      PointForce force = force_now(simulation, entity);
      (kind == ControlKind::force ? force.force : force.torque)[item] = value;
      return world.set_force(BodyId{entity}, force);
    }
    case ControlKind::gravity: {
      const Controls& set = world.state().controls;
      Vector3 gravity = set.has_gravity ? set.gravity : world.model().gravity;
      gravity[item] = value;
      return world.set_gravity(gravity);
    }
    case ControlKind::feed_speed:
      return simulation.set_feed_speed(entity, item, target);
    case ControlKind::link_friction:
      return simulation.set_friction(entity, item, value);
    case ControlKind::compliance:
      return simulation.set_compliance(entity, value);
    case ControlKind::breaking_tension:
      return simulation.set_breaking_tension(entity, value);
    case ControlKind::excitation:
      return set_excitation(world, item, value);
  }
  return {};
}

Errors ControlPoint::clear(Simulation& simulation) const {
  World& world = simulation.world;
  switch (kind) {
    case ControlKind::body_drive:
      return world.clear_drive(BodyId{entity});
    case ControlKind::joint_drive:
    case ControlKind::joint_limit:
      return world.clear_joint_drive(entity, item);
    case ControlKind::force:
    case ControlKind::torque:
      return world.clear_force(BodyId{entity});
    case ControlKind::gravity:
      world.clear_gravity();
      return {};
    case ControlKind::feed_speed:
      return simulation.clear_feed_speed(entity, item);
    case ControlKind::link_friction:
      return simulation.clear_friction(entity, item);
    case ControlKind::compliance:
      return simulation.clear_compliance(entity);
    case ControlKind::breaking_tension:
      return simulation.clear_breaking_tension(entity);
    case ControlKind::excitation:
      if (item >= 0) world.memory()[at(item)] = ActingLoad::no_memory;
      return {};
  }
  return {};
}

std::span<const QuantityGroup> control_groups() { return groups; }

Result<ControlPoint> find_control(std::string_view name, const Model& model,
                                  const std::vector<CableDef>& cables,
                                  std::span<const std::shared_ptr<const LoadDef>> loads) {
  std::optional<ControlPoint> found;
  std::vector<std::string> names;
  const auto visit = [&](const std::string& candidate, const ControlPoint& point) {
    if (candidate == name && !found) found = point;
    names.push_back(candidate);
  };
  visit_bodies(model, visit);
  visit_joints(model, visit);
  visit_cables(cables, visit);
  visit_muscles(loads, visit);
  if (found) return *found;
  const std::vector<std::string_view> near = nearest(name, {names.begin(), names.end()}, 5);
  return Error{
      "", fmt::format("there is no control \"{}\"; {}", name,
                      near.empty() ? std::string("allowed are <driven rotor>.drive, "
                                                 "<driven joint>.drive, <body>.force_x, "
                                                 "<cable>.link<k>.feed_speed and alike")
                                   : fmt::format("near it are \"{}\"", fmt::join(near, "\", \"")))};
}

}  // namespace sheave
