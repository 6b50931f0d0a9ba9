// Bodies of a live world.

#include <pybind11/stl.h>

#include "engine/body_set.h"
#include "engine/index.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"

namespace sheave::python {

template <class Tag>
LiveWorld& world_of(const Thing<Tag>& thing) {
  LiveWorld& world = thing.core->world();
  const Result<std::string> name = world.name(thing.handle);
  if (!name) raise("StaleError", name.errors());
  return world;
}
template LiveWorld& world_of(const LiveBody&);
template LiveWorld& world_of(const LiveJoint&);
template LiveWorld& world_of(const LiveCable&);

namespace {

constexpr std::array<std::string_view, 7> mobility_words{"static", "free",      "planar", "slider",
                                                         "rotor",  "kinematic", "knot"};

BodyPose pose_of(const LiveBody& body) { return value_of(world_of(body).pose(body.handle)); }

const BodyDef& definition_of(const LiveBody& body) {
  return world_of(body).simulation().world.model().bodies[at(body.handle.slot)];
}

using Set = Errors (LiveWorld::*)(BodyHandle, const DriveTarget&);

template <Set Setter>
void set_drive(const LiveBody& body, const py::object& value, const py::object& over,
               const py::object& rate) {
  check((world_of(body).*Setter)(body.handle, target(value, over, rate)));
}

void set_force(const LiveBody& body, const py::object& force, const py::object& torque,
               const py::object& point, const py::object& frame) {
  PointForce set;
  set.force = vector(force, "force");
  set.torque = vector(torque, "torque");
  set.point = optional_vector(point, "point");
  const std::string word = text(frame, "frame");
  if (word != "world" && word != "body") refuse("frame", frame, "\"world\" or \"body\"");
  set.frame = word == "world" ? ForceFrame::world : ForceFrame::body;
  check(world_of(body).set_force(body.handle, set));
}

void set_motion(const LiveBody& body, const py::object& position, const py::object& orientation,
                const py::object& velocity, const py::object& angular_velocity,
                const py::object& over) {
  MotionTarget set;
  set.position = vector(position, "position");
  set.orientation = optional_quaternion(orientation, "orientation");
  set.velocity = optional_vector(velocity, "velocity");
  set.angular_velocity = optional_vector(angular_velocity, "angular_velocity");
  set.over = optional_number(over, "over");
  check(world_of(body).set_motion(body.handle, set));
}

py::dict place(const LiveBody& body, const py::object& position, const py::object& orientation,
               const py::object& keep) {
  const std::string word = text(keep, "keep");
  if (word != "length" && word != "tension") refuse("keep", keep, "\"length\" or \"tension\"");
  LiveWorld& world = world_of(body);
  const Placement placed = value_of(world.place(body.handle, vector(position, "position"),
                                                optional_quaternion(orientation, "orientation"),
                                                word == "length" ? Keep::length : Keep::tension));
  return placement_dict(world, placed);
}

using BodyClass = py::class_<LiveBody>;

void bind_readers(BodyClass& body) {
  body.def_property_readonly("name", [](const LiveBody& own) {
    return value_of(own.core->world().name(own.handle), "StaleError");
  });
  body.def_property_readonly(
      "alive", [](const LiveBody& own) { return own.core->world().name(own.handle).ok(); },
      "Whether the body is still part of the world.");
  body.def_property_readonly(
      "index",
      [](const LiveBody& own) { return static_cast<void>(world_of(own)), own.handle.slot; },
      "Row of the body in the views of the simulation.");
  body.def_property_readonly("mobility", [](const LiveBody& own) {
    return std::string(mobility_words[static_cast<std::size_t>(definition_of(own).mobility)]);
  });
  body.def_property_readonly(
      "mass",
      [](const LiveBody& own) {
        const BodySet& bodies = world_of(own).simulation().world.bodies();
        return bodies[own.handle.slot].mass;
      },
      "Mass [kg]; infinite for a static or kinematic body.");
  body.def_property_readonly(
      "position", [](const LiveBody& own) { return tuple_of(pose_of(own).position); },
      "Position of the origin of the body's frame [m].");
  body.def_property_readonly(
      "orientation", [](const LiveBody& own) { return tuple_of(pose_of(own).orientation); },
      "Of its frame: w, x, y, z.");
  body.def_property_readonly(
      "velocity", [](const LiveBody& own) { return tuple_of(pose_of(own).velocity); },
      "Velocity of the origin of the body's frame [m/s].");
  body.def_property_readonly(
      "angular_velocity",
      [](const LiveBody& own) { return tuple_of(pose_of(own).angular_velocity); }, "[rad/s]");
  body.def_property_readonly(
      "angle",
      [](const LiveBody& own) { return world_of(own).state().bodies[at(own.handle.slot)].angle; },
      "Angle turned since time 0 [rad], of rotors and planar bodies.");
  body.def(
      "point",
      [](const LiveBody& own, const py::object& local) {
        return tuple_of(value_of(world_of(own).point(own.handle, vector(local, "local"))));
      },
      py::arg("local"), "World position of a point of the body's frame [m].");
}

void bind_controls(BodyClass& body) {
  const auto none = py::none();
  body.def("set_speed", &set_drive<&LiveWorld::set_speed>, py::arg("value"), py::arg("over") = none,
           py::arg("rate") = none,
           "Target speed of a rotor's drive [rad/s], reached in `over` seconds, by "
           "default in a step.");
  body.def("set_angle", &set_drive<&LiveWorld::set_angle>, py::arg("value"), py::arg("over") = none,
           py::arg("rate") = none, "[rad], in `over` > 0 seconds, to arrive with `rate` [rad/s].");
  body.def("set_torque", &set_drive<&LiveWorld::set_torque>, py::arg("value"),
           py::arg("over") = none, py::arg("rate") = none, "[N m], at once.");
  body.def(
      "clear_drive", [](const LiveBody& own) { check(world_of(own).clear_drive(own.handle)); },
      "Returns the drive to its table.");
  const auto zero = py::make_tuple(0.0, 0.0, 0.0);
  body.def("set_force", &set_force, py::arg("force") = zero, py::arg("torque") = zero,
           py::arg("point") = none, py::arg("frame") = "world",
           "A force [N] at a point of its frame [m], by default the centre of mass, and a torque "
           "[N m]. Force and torque act until they are set again.");
  body.def(
      "clear_force", [](const LiveBody& own) { check(world_of(own).clear_force(own.handle)); },
      "Removes the force and the torque that were set.");
  body.def("set_motion", &set_motion, py::arg("position"), py::arg("orientation") = none,
           py::arg("velocity") = none, py::arg("angular_velocity") = none, py::arg("over") = none,
           "Target of a kinematic body, reached in `over` seconds.");
  body.def(
      "clear_motion",
      [](const LiveBody& own, const py::object& over) {
        check(world_of(own).clear_motion(own.handle, optional_number(over, "over")));
      },
      py::arg("over") = none, "Returns the body to the motion of its definition.");
  body.def("place", &place, py::arg("position"), py::arg("orientation") = none,
           py::arg("keep") = "length",
           "Puts a free, planar or slider body elsewhere; cables keep their length, or their "
           "tension. Returns the increases of energy [J] and of lengths [m].");
}

LiveBody body_called(const std::shared_ptr<Core>& core, const py::object& name) {
  return {core, value_of(core->world().body(text(name, "name")), "UnknownNameError")};
}

std::vector<LiveBody> bodies_of(const std::shared_ptr<Core>& core) {
  std::vector<LiveBody> all;
  for (const BodyHandle handle : core->world().bodies()) all.push_back({core, handle});
  return all;
}

}  // namespace

py::dict placement_dict(LiveWorld& world, const Placement& placed) {
  py::dict cables;
  for (const Placement::Cable& cable : placed.cables) {
    cables[py::str(*world.name(cable.cable))] = cable.added;
  }
  py::dict done;
  done["energy"] = placed.energy;
  done["cables"] = cables;
  return done;
}

void bind_bodies(py::module_& module, SimulationClass& simulation) {
  BodyClass body(module, "LiveBody",
                 "A body of a simulation; the handle is stale once the body is removed.");
  bind_readers(body);
  bind_controls(body);
  body.def("__eq__", [](const LiveBody& own, const py::object& other) {
    return py::isinstance<LiveBody>(other) && own == other.cast<const LiveBody&>();
  });
  body.def("__hash__", [](const LiveBody& own) {
    return py::hash(py::make_tuple(reinterpret_cast<std::uintptr_t>(own.core.get()),
                                   own.handle.slot, own.handle.generation));
  });
  body.def("__repr__", [](const LiveBody& own) {
    const Result<std::string> name = own.core->world().name(own.handle);
    return name ? "<LiveBody \"" + *name + "\">" : std::string("<LiveBody, removed>");
  });
  simulation.def("body", &body_called, py::arg("name"), "The body with this name.");
  simulation.def("_bodies", &bodies_of);
}

}  // namespace sheave::python
