// Equilibrium and vibrations of a simulation.

#include <optional>

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "cable/cable_system.h"
#include "engine/index.h"
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "statics/equilibrium.h"
#include "statics/joint_space.h"
#include "statics/modes.h"
#include "statics/supports.h"

namespace sheave::python {
namespace {

/// Another simulation of the same machine in the same state.
Simulation copy_of(const Simulation& own) {
  static const std::vector<CableDef> none;
  const std::vector<CableDef>& cables = own.cable_definitions ? *own.cable_definitions : none;
  Simulation copy = value_of(Simulation::create(own.world.model(), cables));
  copy.world.memory() = own.world.state().memory;
  check(copy.world.restore(own.world.state()));
  return copy;
}

std::vector<std::string> names_of_spans(const Simulation& simulation,
                                        std::vector<double>& tensions) {
  std::vector<std::string> names;
  if (simulation.cables == nullptr) return names;
  const std::vector<double>& reals = simulation.world.state().features.back().reals;
  for (const CompiledCable& cable : simulation.cables->cables()) {
    for (int k = 0; k < cable.span_count; ++k) {
      names.push_back(k < cable.listed_spans
                          ? cable.name + "." + std::to_string(k)
                          : cable.name + ".wrap" + std::to_string(k - cable.listed_spans));
      tensions.push_back(reals[simulation.cables->tension_index(cable.first_span + k)]);
    }
  }
  return names;
}

const char* stability_name(Stability stability) {
  switch (stability) {
    case Stability::stable:
      return "stable";
    case Stability::neutral:
      return "neutral";
    case Stability::unstable:
      break;
  }
  return "unstable";
}

py::dict support_dict(Simulation& simulation, const Equilibrium& rest) {
  py::dict forces;
  for (const SupportReaction& support : support_reactions(simulation, rest.forces)) {
    const std::string name = support.body.is_world()
                                 ? std::string("world")
                                 : simulation.world.bodies().name(support.body.index);
    forces[py::str(name)] = tuple_of(support.force);
  }
  return forces;
}

ModalMatrix pose_rows(const State& state, bool orientations) {
  ModalMatrix rows(static_cast<Eigen::Index>(state.bodies.size()), orientations ? 4 : 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const BodyState& body = state.bodies[static_cast<std::size_t>(i)];
    if (orientations) {
      rows.row(i) = body.orientation.coeffs().transpose();
    } else {
      rows.row(i) = body.position.transpose();
    }
  }
  return rows;
}

py::dict statics(Core& core, const py::object& move, const py::object& load_steps) {
  const bool moves = truth(move, "move");
  EquilibriumSettings settings;
  constexpr std::int64_t most_load_steps = 10'000;
  settings.load_steps = static_cast<int>(integer(load_steps, "load_steps", 1, most_load_steps));
  Simulation copy = copy_of(core.simulation());
  Equilibrium rest;
  {
    const py::gil_scoped_release unlocked;
    rest = find_equilibrium(copy, settings);
  }
  if (!rest.converged) raise("Error", rest.message);
  Result<JointSpace> space = JointSpace::create(copy);
  std::vector<double> tensions;
  const std::vector<std::string> spans = names_of_spans(copy, tensions);
  py::dict all;
  all["stability"] = stability_name(rest.stability);
  all["eigenvalues"] = rest.eigenvalues;
  all["force_error"] = rest.force_error;
  all["length_error"] = rest.length_error;
  all["redundant"] = rest.redundant;
  all["friction_holds"] = rest.friction_holds;
  all["tensions"] = tensions;
  all["positions"] = array_of(pose_rows(copy.world.state(), false));
  all["orientations_xyzw"] = array_of(pose_rows(copy.world.state(), true));
  all["qpos"] = space ? py::object(array_of(space->positions())) : py::none();
  all["supports"] = support_dict(copy, rest);
  py::dict slack;
  for (const SlackSpan& span : rest.slack_spans) {
    const int first = copy.cables->cables()[at(span.cable)].first_span;
    slack[py::str(spans[at(first + span.span)])] = span.slack;
  }
  all["slack_spans"] = slack;
  if (moves) check(core.world().restore(copy.world.state()));
  return all;
}

py::dict modes(Core& core) {
  std::optional<Modes> found;
  Errors faults;
  py::dict all;
  check(core.world().examine([&](Simulation& simulation) {
    found.emplace(find_modes(simulation));
    Result<JointSpace> space = JointSpace::create(simulation);
    faults = space.errors();
    if (space) all["joint_shapes"] = array_of(space->along_coordinates(found->motions));
    all["freedom_names"] = freedom_names(simulation);
  }));
  check(faults);
  ModalVector frequencies(static_cast<Eigen::Index>(found->modes.size()));
  ModalVector ratios = frequencies;
  ModalVector eigenvalues = frequencies;
  std::vector<std::string> bodies;
  for (Eigen::Index i = 0; i < frequencies.size(); ++i) {
    const Mode& mode = found->modes[static_cast<std::size_t>(i)];
    frequencies[i] = mode.frequency;
    ratios[i] = mode.damping_ratio;
    eigenvalues[i] = mode.eigenvalue;
    bodies.push_back(mode.body < 0 ? std::string()
                                   : core.simulation().world.bodies().name(mode.body));
  }
  all["frequencies"] = array_of(frequencies);
  all["damping_ratios"] = array_of(ratios);
  all["eigenvalues"] = array_of(eigenvalues);
  all["bodies"] = bodies;
  all["poles"] = found->poles;
  all["shapes"] = array_of(found->motions);
  all["imbalance"] = found->imbalance;
  all["error"] = found->error;
  all["friction_slides"] = found->friction_slides;
  return all;
}

}  // namespace

void bind_statics(SimulationClass& simulation) {
  simulation.def("_statics", &statics, py::arg("move"), py::arg("load_steps"));
  simulation.def("_modes", &modes);
}

}  // namespace sheave::python
