// Coordinates of joints, and the questions of robotics.

#include <optional>

#include <pybind11/stl.h>

#include "engine/joint_report.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "statics/joint_space.h"
#include "statics/place_joints.h"

namespace sheave::python {
namespace {

ModalVector vector_of(const std::vector<double>& values) {
  return Eigen::Map<const ModalVector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The answer of the joint space at the present state.
template <class Question>
auto ask(Core& core, const Question& question) {
  using Answer = decltype(question(std::declval<JointSpace&>()));
  std::optional<Answer> answer;
  Errors faults;
  check(core.world().examine([&](Simulation& simulation) {
    Result<JointSpace> space = JointSpace::create(simulation);
    faults = space.errors();
    if (space) answer.emplace(question(*space));
  }));
  check(faults);
  return std::move(*answer);
}

std::vector<std::string> coordinate_names(Core& core) {
  return ask(core, [](JointSpace& space) {
    std::vector<std::string> names;
    for (const MachineCoordinate& own : space.coordinates()) names.push_back(own.name);
    return names;
  });
}

Keep keep_of(const py::object& keep) {
  const std::string word = text(keep, "keep");
  if (word != "length" && word != "tension") refuse("keep", keep, "\"length\" or \"tension\"");
  return word == "length" ? Keep::length : Keep::tension;
}

py::dict place_machine(Core& core, const py::object& joints, const py::object& keep) {
  if (!py::isinstance<py::dict>(joints)) {
    refuse("joints", joints, "a dict from names of joints or coordinates to values");
  }
  std::vector<CoordinateTarget> targets;
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(joints)) {
    const std::string own = text(name, "joints");
    targets.push_back({own, number(value, own.c_str())});
  }
  LiveWorld& world = core.world();
  return placement_dict(world, value_of(place_joints(world, targets, keep_of(keep))));
}

/// All coordinates with one value each.
std::vector<CoordinateTarget> targets_of(Core& core, const py::object& values, const char* name) {
  const std::vector<std::string> names = coordinate_names(core);
  const std::vector<double> given = numbers(values, name, names.size(), "coordinates");
  std::vector<CoordinateTarget> targets;
  for (std::size_t i = 0; i < names.size(); ++i) targets.push_back({names[i], given[i]});
  return targets;
}

void set_positions(Core& core, const py::object& values) {
  static_cast<void>(
      value_of(place_joints(core.world(), targets_of(core, values, "qpos"), Keep::length)));
}

void set_rates(Core& core, const py::object& values) {
  check(set_joint_rates(core.world(), targets_of(core, values, "qvel")));
}

py::array_t<double> jacobian(Core& core, const py::object& body, const py::object& point) {
  const BodyHandle handle = value_of(core.world().body(text(body, "body")), "UnknownNameError");
  const Vector3 local = vector(point, "point");
  const PointJacobian found =
      ask(core, [&](JointSpace& space) { return space.jacobian({handle.slot}, local); });
  ModalMatrix both(6, found.linear.cols());
  both << found.linear, found.angular;
  return array_of(both);
}

using Dynamics = Result<ModalVector> (JointSpace::*)(const ModalVector&);
py::array_t<double> dynamics(Core& core, const py::object& values, const char* name,
                             Dynamics question) {
  const std::size_t count = coordinate_names(core).size();
  const ModalVector given = vector_of(numbers(values, name, count, "coordinates"));
  return array_of(value_of(ask(core, [&](JointSpace& space) { return (space.*question)(given); })));
}

py::tuple linearised(Core& core) {
  const LinearMotion motion =
      value_of(ask(core, [](JointSpace& space) { return space.linearise(); }));
  return py::make_tuple(array_of(motion.state_matrix), array_of(motion.input_matrix));
}

CableArms cable_arms(Core& core) {
  return ask(core, [](JointSpace& space) { return space.cable_arms(); });
}

py::array_t<double> moment_arms(Core& core, const py::object& spans) {
  const bool each = truth(spans, "spans");
  const CableArms found = cable_arms(core);
  return array_of(each ? found.span_arms : found.arms);
}

template <ModalVector (JointSpace::*Question)() const>
py::array_t<double> read(Core& core) {
  return array_of(ask(core, [](JointSpace& space) { return (space.*Question)(); }));
}
template <ModalVector (JointSpace::*Question)()>
py::array_t<double> forces(Core& core) {
  return array_of(ask(core, [](JointSpace& space) { return (space.*Question)(); }));
}

void bind_coordinates(SimulationClass& simulation) {
  simulation.def_property_readonly(
      "coordinate_names", &coordinate_names,
      "Names of the n independent coordinates: \"elbow.angle\", \"base.x\", ...: those of joints "
      "in the order of the model, then those of bodies that joints leave free.");
  simulation.def_property("qpos", &read<&JointSpace::positions>, &set_positions,
                          "Values of the coordinates [m or rad], (n,): a copy. Assigning an array "
                          "places the machine; cables keep their length.");
  simulation.def_property("qvel", &read<&JointSpace::rates>, &set_rates,
                          "Rates of the coordinates [m/s or rad/s], (n,): a copy. Assigning an "
                          "array sets the velocities of all bodies.");
  simulation.def(
      "place", &place_machine, py::arg("joints"), py::arg("keep") = "length",
      "Moves all bodies so that these coordinates have these values [m or rad]: {\"elbow\": 0.3}. "
      "Others stay as far as loops let them. Cables keep their length, or their tension. Returns "
      "the increases of energy [J] and of lengths [m].");
}

void bind_questions(SimulationClass& simulation) {
  simulation.def(
      "mass_matrix",
      [](Core& core) {
        return array_of(ask(core, [](JointSpace& space) { return space.mass_matrix(); }));
      },
      "Mass matrix along the coordinates, (n, n) [kg, kg m, kg m2].");
  simulation.def("bias_forces", &forces<&JointSpace::bias_forces>,
                 "Forces along the coordinates that gravity and velocities demand, (n,) [N, N m].");
  simulation.def("passive_forces", &forces<&JointSpace::passive_forces>,
                 "Forces of springs, dampers, drag and set forces along the coordinates, (n,) [N, "
                 "N m]. Without cables.");
  simulation.def(
      "inverse_dynamics",
      [](Core& core, const py::object& values) {
        return dynamics(core, values, "accelerations", &JointSpace::inverse_dynamics);
      },
      py::arg("accelerations"),
      "Forces along the coordinates that cause these accelerations, (n,) [N, N m]: M a + bias - "
      "passive.");
  simulation.def(
      "forward_dynamics",
      [](Core& core, const py::object& values) {
        return dynamics(core, values, "forces", &JointSpace::forward_dynamics);
      },
      py::arg("forces"), "Accelerations under these forces along the coordinates, (n,).");
  simulation.def("jacobian", &jacobian, py::arg("body"),
                 py::arg("point") = py::make_tuple(0.0, 0.0, 0.0),
                 "Velocity of a body's point, in its own frame [m], and angular velocity of the "
                 "body per rate of each coordinate, (6, n), in world axes.");
  simulation.def(
      "cable_lengths", [](Core& core) { return array_of(cable_arms(core).lengths); },
      "Stretched lengths of the cables, with the cable on wheels, (cables,) [m].");
  simulation.def(
      "cable_velocities", [](Core& core) { return array_of(cable_arms(core).rates); },
      "Rates of cable_lengths(), (cables,) [m/s].");
  simulation.def(
      "moment_arms", &moment_arms, py::arg("spans") = false,
      "Derivatives of cable_lengths() by the coordinates, (cables, n) [m/m, m/rad]. With "
      "`spans`, of the stretch of each span in span_names, (spans, n): the forces along "
      "the coordinates are -moment_arms(True).T @ tensions.");
  simulation.def("linearised", &linearised,
                 "The motion near rest, x' = A x + B f with x = (qpos - now, qvel) and forces f "
                 "along the coordinates: A (2n, 2n) and B (2n, n).");
}

}  // namespace

void bind_robotics(SimulationClass& simulation) {
  bind_coordinates(simulation);
  bind_questions(simulation);
}

}  // namespace sheave::python
