// Joints of a live world.

#include <algorithm>

#include <pybind11/stl.h>

#include "engine/joint_report.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "statics/place_joints.h"

namespace sheave::python {
namespace {

using JointClass = py::class_<LiveJoint>;

const JointDef& joint_definition(const LiveJoint& joint) {
  return *world_of(joint).definition(joint.handle);
}

/// A coordinate by its index or its name.
int coordinate_of(const LiveJoint& joint, const py::object& which) {
  const auto coordinates = joint_definition(joint).coordinates();
  std::string names;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (PyUnicode_Check(which.ptr()) && text(which, "coordinate") == coordinates[i].name) {
      return static_cast<int>(i);
    }
    names += (names.empty() ? "\"" : ", \"") + std::string(coordinates[i].name) + "\"";
  }
  if (coordinates.empty()) refuse("coordinate", which, "left out: this joint has none");
  if (PyUnicode_Check(which.ptr())) refuse("coordinate", which, "one of " + names);
  return static_cast<int>(
      integer(which, "coordinate", 0, static_cast<std::int64_t>(coordinates.size()) - 1));
}

JointReport report_of(const LiveJoint& joint) {
  const std::string name = joint_definition(joint).name;
  std::vector<JointReport> reports = joint_reports(world_of(joint).simulation().world);
  const auto found = std::find_if(reports.begin(), reports.end(),
                                  [&](const JointReport& report) { return report.name == name; });
  if (found == reports.end()) raise("Error", "joint \"" + name + "\" tells nothing");
  return std::move(*found);
}

py::dict report_dict(const LiveJoint& joint) {
  const JointReport report = report_of(joint);
  py::dict all;
  all["force"] = tuple_of(report.force);
  all["torque"] = tuple_of(report.torque);
  all["broken_at"] = report.broken_at ? py::object(py::float_(*report.broken_at)) : py::none();
  all["error"] = report.error;
  all["angle_error"] = report.angle_error;
  py::dict coordinates;
  for (const JointCoordinateReport& coordinate : report.coordinates) {
    py::dict one;
    one["value"] = coordinate.value;
    one["rate"] = coordinate.rate;
    one["friction_force"] = coordinate.friction_force;
    one["drive_force"] = coordinate.drive_force;
    one["drive_target"] = coordinate.drive_target;
    one["drive_error"] = coordinate.drive_error;
    coordinates[py::str(coordinate.name.data(), coordinate.name.size())] = one;
  }
  all["coordinates"] = coordinates;
  return all;
}

/// Raises AttributeError, as Python does for attributes that do not exist.
[[noreturn]] void lack(const LiveJoint& joint, const std::string& attribute) {
  const JointDef& definition = joint_definition(joint);
  std::string names;
  for (const JointCoordinateInfo& own : definition.coordinates()) {
    names += (names.empty() ? "" : ", ") + std::string(own.name);
  }
  throw py::attribute_error("joint \"" + definition.name + "\" has no " + attribute +
                            "; its type is " + std::string(definition.type()) +
                            ", and its coordinates are: " + (names.empty() ? "none" : names) +
                            " (see report())");
}

JointCoordinateReport coordinate_called(const LiveJoint& joint, const char* name) {
  const JointReport report = report_of(joint);
  for (const JointCoordinateReport& own : report.coordinates) {
    if (own.name == name) return own;
  }
  lack(joint, name);
}

/// The coordinate of a joint that has only one.
JointCoordinateReport only_coordinate(const LiveJoint& joint, const char* attribute) {
  const JointReport report = report_of(joint);
  if (report.coordinates.size() != 1) lack(joint, attribute);
  return report.coordinates.front();
}

std::vector<std::string> coordinates_of(const LiveJoint& joint) {
  std::vector<std::string> names;
  for (const JointCoordinateInfo& coordinate : joint_definition(joint).coordinates()) {
    names.emplace_back(coordinate.name);
  }
  return names;
}

void bind_joint_readers(JointClass& joint) {
  joint.def_property_readonly("name", [](const LiveJoint& own) {
    return value_of(own.core->world().name(own.handle), "StaleError");
  });
  joint.def_property_readonly(
      "alive", [](const LiveJoint& own) { return own.core->world().name(own.handle).ok(); },
      "Whether the joint is still part of the world.");
  joint.def_property_readonly(
      "type", [](const LiveJoint& own) { return std::string(joint_definition(own).type()); },
      "As scenes call it.");
  joint.def_property_readonly("coordinates", &coordinates_of, "Names of its coordinates.");
  joint.def_property_readonly(
      "force",
      [](const LiveJoint& own) {
        return tuple_of(value_of(world_of(own).force(own.handle)).force);
      },
      "Force on the second body in the last substep [N].");
  joint.def_property_readonly(
      "torque",
      [](const LiveJoint& own) {
        return tuple_of(value_of(world_of(own).force(own.handle)).torque);
      },
      "Torque on the second body about its anchor in the last substep [N m].");
  joint.def_property_readonly(
      "broken", [](const LiveJoint& own) { return report_of(own).broken_at.has_value(); },
      "Whether the joint has broken or been released.");
  joint.def("report", &report_dict, "Forces, errors, and the state of the coordinates.");
}

void bind_coordinate(JointClass& joint, const char* name, const char* text) {
  joint.def_property(
      name, [name](const LiveJoint& own) { return coordinate_called(own, name).value; },
      [name](const LiveJoint& own, const py::object& value) {
        static_cast<void>(coordinate_called(own, name));
        const std::string whole = joint_definition(own).name + "." + name;
        static_cast<void>(
            value_of(place_joints(world_of(own), {{whole, number(value, name)}}, Keep::length)));
      },
      text);
}

void bind_joint_coordinates(JointClass& joint) {
  bind_coordinate(joint, "angle",
                  "Angle since time 0, with whole turns [rad]. Setting it places "
                  "the machine, as Simulation.place() does.");
  bind_coordinate(joint, "travel", "Way since time 0 [m]; can be set.");
  bind_coordinate(joint, "extension", "Growth of the distance since time 0 [m]; can be set.");
  bind_coordinate(joint, "angle_a", "First angle of a universal joint or gear [rad]; can be set.");
  bind_coordinate(joint, "angle_b", "Second angle of a universal joint or gear [rad]; can be set.");
  bind_coordinate(joint, "twist", "Twist of a ball joint about its axis [rad].");
  bind_coordinate(joint, "swing", "Swing of the axis of a ball joint [rad].");
  joint.def_property(
      "velocity", [](const LiveJoint& own) { return only_coordinate(own, "velocity").rate; },
      [](const LiveJoint& own, const py::object& value) {
        const JointCoordinateReport coordinate = only_coordinate(own, "velocity");
        const std::string whole = joint_definition(own).name + "." + std::string(coordinate.name);
        check(set_joint_rates(world_of(own), {{whole, number(value, "velocity")}}));
      },
      "Rate of the only coordinate of a joint [rad/s or m/s]. Setting it sets the velocities of "
      "all bodies that the joint moves.");
  joint.def_property_readonly(
      "drive_force",
      [](const LiveJoint& own) { return only_coordinate(own, "drive_force").drive_force; },
      "Mean force or torque of the drive in the last substep [N or N m]; 0 without a drive.");
}

void bind_joint_controls(JointClass& joint) {
  const auto none = py::none();
  joint.def(
      "set_drive",
      [](const LiveJoint& own, const py::object& value, const py::object& over,
         const py::object& rate, const py::object& coordinate) {
        const int index = coordinate_of(own, coordinate);
        check(world_of(own).set_drive(own.handle, target(value, over, rate), index));
      },
      py::arg("value"), py::arg("over") = none, py::arg("rate") = none, py::arg("coordinate") = 0,
      "Target of the drive along a coordinate: a position, speed or force, by its kind.");
  joint.def(
      "set_drive_limit",
      [](const LiveJoint& own, const py::object& limit, const py::object& coordinate) {
        const int index = coordinate_of(own, coordinate);
        check(world_of(own).set_drive_limit(own.handle, number(limit, "limit"), index));
      },
      py::arg("limit"), py::arg("coordinate") = 0,
      "Limit of the drive's force or torque [N or N m].");
  joint.def(
      "clear_drive",
      [](const LiveJoint& own, const py::object& coordinate) {
        check(world_of(own).clear_drive(own.handle, coordinate_of(own, coordinate)));
      },
      py::arg("coordinate") = 0, "Returns target and limit to those of the definition.");
  joint.def(
      "release", [](const LiveJoint& own) { check(world_of(own).release_joint(own.handle)); },
      "Releases the joint, as if it had broken now.");
  joint.def(
      "lock", [](const LiveJoint& own) { check(world_of(own).lock_joint(own.handle)); },
      "Locks a joint that was released or has broken, at the present places of its bodies.");
}

LiveJoint joint_called(const std::shared_ptr<Core>& core, const py::object& name) {
  return {core, value_of(core->world().joint(text(name, "name")), "UnknownNameError")};
}

std::vector<LiveJoint> joints_of(const std::shared_ptr<Core>& core) {
  std::vector<LiveJoint> all;
  for (const JointHandle handle : core->world().joints()) all.push_back({core, handle});
  return all;
}

}  // namespace

void bind_joints(py::module_& module, SimulationClass& simulation) {
  JointClass joint(module, "LiveJoint",
                   "A joint of a simulation; the handle is stale once the joint is removed.");
  bind_joint_readers(joint);
  bind_joint_coordinates(joint);
  bind_joint_controls(joint);
  joint.def("__eq__", [](const LiveJoint& own, const py::object& other) {
    return py::isinstance<LiveJoint>(other) && own == other.cast<const LiveJoint&>();
  });
  joint.def("__hash__", [](const LiveJoint& own) {
    return py::hash(py::make_tuple(reinterpret_cast<std::uintptr_t>(own.core.get()),
                                   own.handle.slot, own.handle.generation));
  });
  joint.def("__repr__", [](const LiveJoint& own) {
    const Result<std::string> name = own.core->world().name(own.handle);
    return name ? "<LiveJoint \"" + *name + "\">" : std::string("<LiveJoint, removed>");
  });
  simulation.def("joint", &joint_called, py::arg("name"), "The joint with this name.");
  simulation.def("_joints", &joints_of);
}

}  // namespace sheave::python
