// Observables by name: once, and over many steps.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "engine/index.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::python {
namespace {

QuantityList list_of(Core& core, const std::vector<std::string>& names) {
  QuantityList list(core.session().quantities());
  for (const std::string& name : names) check(list.add(name), "UnknownNameError");
  return list;
}

py::object observe(Core& core, const py::object& names) {
  if (PyUnicode_Check(names.ptr())) {
    double value = 0.0;
    list_of(core, {text(names, "names")}).observe(core.simulation(), {&value, 1});
    return py::float_(value);
  }
  const QuantityList list = list_of(core, texts(names, "names"));
  py::array_t<double> values(static_cast<py::ssize_t>(list.size()));
  list.observe(core.simulation(), {values.mutable_data(), list.size()});
  return values;
}

/// Rows of (time, values...) from now on, one every `every` steps.
py::array_t<double> record(const py::object& self, const py::object& names, const py::object& steps,
                           const py::object& every, const py::object& before_step,
                           const py::object& before_substep) {
  Core& core = self.cast<Core&>();
  const QuantityList list = list_of(core, texts(names, "names"));
  constexpr std::int64_t most = 1'000'000'000;
  const std::int64_t count =
      steps.is_none() ? core.steps_until({}) : integer(steps, "steps", 0, most);
  const std::int64_t stride = integer(every, "every", 1, most);
  const std::int64_t revision = core.session().revision;
  const std::size_t width = list.size() + 1;
  std::vector<double> rows;
  const auto add = [&] {
    if (core.session().revision != revision) {
      raise("Error",
            "an edit has changed the recorded quantities; record before and after the edit "
            "separately");
    }
    rows.resize(rows.size() + width);
    double* const row = rows.data() + rows.size() - width;
    row[0] = core.world().time();
    list.observe(core.simulation(), {row + 1, list.size()});
  };
  add();
  for (std::int64_t done = 0; done < count;) {
    const std::int64_t next = std::min(stride, count - done);
    const bool goes_on = core.step(next, self, before_step, before_substep);
    done += next;
    if (next == stride || !goes_on) add();
    if (!goes_on) break;
  }
  const auto height = static_cast<py::ssize_t>(rows.size() / width);
  py::array_t<double> result({height, static_cast<py::ssize_t>(width)});
  std::copy(rows.begin(), rows.end(), result.mutable_data());
  return result;
}

std::string unit_of(Core& core, const py::object& name) {
  return list_of(core, {text(name, "name")}).unit(0);
}

ControlPoint control_called(Core& core, const py::object& name) {
  return value_of(find_control(text(name, "name"), core.simulation()), "UnknownNameError");
}

void set_control(Core& core, const py::object& name, const py::object& value,
                 const py::object& over) {
  const ControlPoint point = control_called(core, name);
  const double wanted = number(value, "value");
  const std::optional<double> time = optional_number(over, "over");
  const double step = core.simulation().world.model().step.dt;
  check(core.world().set_in_simulation(
      [&](Simulation& simulation) { return point.set(simulation, wanted, step, time); }));
}

py::dict muscles(Core& core) {
  py::dict result;
  const Simulation& simulation = core.simulation();
  const auto* supervisor = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
  if (supervisor == nullptr) return result;
  for (const MuscleState& muscle : supervisor->muscles(simulation.world.state())) {
    py::dict own;
    own["activation"] = muscle.activation;
    own["tension"] = muscle.tension;
    result[py::str(muscle.name)] = own;
  }
  return result;
}

void clear_control(Core& core, const py::object& name) {
  const ControlPoint point = control_called(core, name);
  check(core.world().set_in_simulation(
      [&](Simulation& simulation) { return point.clear(simulation); }));
}

}  // namespace

void bind_observables(SimulationClass& simulation) {
  simulation.def_property_readonly(
      "observables", [](Core& core) { return core.session().quantities()->set().names(); },
      "Names of all quantities of observe().");
  simulation.def("observe", &observe, py::arg("names"),
                 "A quantity by its name or an expression of quantities, or an array of several. "
                 "NaN: not known, such as forces before the first step.");
  simulation.def("unit", &unit_of, py::arg("name"),
                 "The unit of a quantity or expression: \"N\", \"rad/s\"; empty for a pure number. "
                 "The error of "
                 "a joint's drive has two: \"m, m/s\".");
  simulation.def("_record", &record, py::arg("names"), py::arg("steps"), py::arg("every"),
                 py::arg("before_step"), py::arg("before_substep"));
  simulation.def_property_readonly("muscles", &muscles,
                                   "Per muscle of the scene its activation, 0 ... 1, and its "
                                   "tension over the last substep [N].");
  simulation.def("set", &set_control, py::arg("name"), py::arg("value"),
                 py::arg("over") = py::none(),
                 "Sets a control by the name that controllers and triggers of scenes use, e.g. "
                 "\"winch.drive\", \"hook.force_x\".");
  simulation.def("clear", &clear_control, py::arg("name"),
                 "Returns the control to the value of the scene.");
}

}  // namespace sheave::python
