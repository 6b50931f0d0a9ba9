// Creating and stepping simulations, and functions of the whole world.

#include <pybind11/stl.h>

#include "engine/body_set.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "python/bindings/overrides.h"
#include "python/bindings/warnings.h"

namespace sheave::python {

std::vector<Override> overrides_of(const py::dict& texts) {
  std::vector<Override> overrides;
  for (const auto& [pointer, value] : texts) {
    const std::string path = text(pointer, "set");
    overrides.push_back({path, text(value, "set"), "set " + path});
  }
  return overrides;
}

namespace {

constexpr std::int64_t most_steps = std::int64_t{1} << 53;

bool step(const py::object& self, const py::object& n, const py::object& before_step,
          const py::object& before_substep) {
  return self.cast<Core&>().step(integer(n, "n", 0, most_steps), self, before_step, before_substep);
}

bool run(const py::object& self, const py::object& until, const py::object& before_step,
         const py::object& before_substep) {
  Core& core = self.cast<Core&>();
  const std::int64_t steps = core.steps_until(optional_number(until, "until"));
  return core.step(steps, self, before_step, before_substep);
}

py::dict energy_of(Core& core) {
  const Energy energy = core.world().energy();
  py::dict all;
  all["kinetic"] = energy.kinetic;
  all["potential"] = energy.potential;
  all["elastic"] = energy.elastic;
  all["total"] = energy.total();
  return all;
}

py::tuple gravity_of(Core& core) {
  const Controls& controls = core.world().state().controls;
  return tuple_of(controls.has_gravity ? controls.gravity
                                       : core.simulation().world.model().gravity);
}

py::list event_list(Core& core) {
  static_cast<void>(core.world());
  py::list events;
  for (const Event& event : core.events) {
    py::dict one;
    one["time"] = event.time;
    one["kind"] = event.kind;
    one["name"] = event.name;
    one["link"] = event.link;
    one["body"] = event.body;
    events.append(std::move(one));
  }
  return events;
}

py::list warning_list(Core& core) {
  const Simulation& simulation = core.simulation();
  std::vector<Warning> warnings = core.start();
  append_run_warnings(simulation, core.troubles, warnings);
  return warning_dicts(warnings);
}

py::list items_of(const Certificate& certificate) {
  py::list items;
  for (const CertificateItem& item : certificate.items) {
    py::dict one;
    one["kind"] = std::string(certificate_kind_names[static_cast<std::size_t>(item.kind)]);
    one["name"] = item.name;
    one["value"] = item.value;
    one["unit"] = std::string(item.unit);
    one["scale"] = item.scale;
    one["relative"] = item.relative;
    one["time"] = item.time;
    one["advice"] = item.advice;
    one["sentence"] = item.sentence();
    items.append(std::move(one));
  }
  return items;
}

py::object certificate_of(Core& core) {
  const std::optional<Certificate> certificate = core.simulation().certificate();
  if (!certificate) return py::none();
  return items_of(*certificate);
}

py::list contacts_of(Core& core) {
  const World& world = core.simulation().world;
  py::list all;
  const auto name = [&](BodyId body) {
    return body.is_world() ? std::string("world") : world.bodies().name(body.index);
  };
  for (const ContactReport& contact : world.contacts()) {
    py::dict one;
    one["body_a"] = name(contact.body_a);
    one["body_b"] = name(contact.body_b);
    one["point"] = tuple_of(contact.point);
    one["normal"] = tuple_of(contact.normal);
    one["gap"] = contact.gap;
    one["normal_force"] = contact.normal_force;
    one["friction_force"] = tuple_of(contact.friction_force);
    one["sticks"] = contact.sticks;
    all.append(std::move(one));
  }
  return all;
}

}  // namespace

void bind_simulation(py::module_& /*module*/, SimulationClass& simulation) {
  simulation.def(py::init([](const py::object& source, const py::object& name, bool is_file,
                             const py::dict& overrides) {
                   return Core::load(text(source, "source"), text(name, "name"), is_file,
                                     overrides_of(overrides));
                 }),
                 py::arg("source"), py::arg("name"), py::arg("is_file"), py::arg("overrides"));
  simulation.def(
      "step", &step, py::arg("n") = 1, py::kw_only(), py::arg("before_step") = py::none(),
      py::arg("before_substep") = py::none(),
      "Makes n steps. Returns False if a trigger of the scene has stopped the run; there may be "
      "fewer steps then. `before_step` and `before_substep` are called with the "
      "simulation and may set controls; an exception from them ends the step.");
  simulation.def("run", &run, py::arg("until") = py::none(), py::kw_only(),
                 py::arg("before_step") = py::none(), py::arg("before_substep") = py::none(),
                 "Steps until this time [s], or for the scene's duration. False if a trigger has "
                 "stopped the run.");
  simulation.def_property_readonly(
      "time", [](Core& core) { return core.world().time(); }, "[s]");
  simulation.def_property_readonly(
      "steps", [](Core& core) { return core.world().state().steps; }, "How many there have been.");
  simulation.def_property_readonly(
      "dt", [](Core& core) { return core.simulation().world.model().step.dt; },
      "Time of a step [s].");
  simulation.def_property_readonly(
      "duration", [](Core& core) { return core.scene().duration; }, "Duration of the scene [s].");
  simulation.def_property_readonly(
      "title", [](Core& core) { return core.scene().name; }, "Title of the scene.");
  simulation.def_property_readonly("stopped", &Core::has_stopped,
                                   "Whether a trigger has stopped the run.");
  simulation.def_property_readonly("energy", &energy_of,
                                   "Kinetic, potential, elastic and total energy [J].");
  simulation.def_property(
      "gravity", &gravity_of,
      [](Core& core, const py::object& value) {
        check(core.world().set_gravity(vector(value, "gravity")));
      },
      "Acceleration of free fall [m/s2]; part of the state if it is set.");
  simulation.def(
      "clear_gravity", [](Core& core) { core.world().clear_gravity(); },
      "Returns gravity to the value of the scene.");
  simulation.def_property_readonly("events", &event_list,
                                   "Events of cables and joints, oldest first.");
  simulation.def_readonly("dropped_events", &Core::dropped_events,
                          "Number of earlier events that `events` no longer has.");
  simulation.def(
      "clear_events", [](Core& core) { core.events.clear(); }, "Forgets the events.");
  simulation.def_property_readonly(
      "warnings", &warning_list,
      "Warnings of the scene and of the run, as of `sheave run`: dicts with kind, subject and "
      "message. Those of kind \"import\" name what an imported model had and the scene lacks. "
      "Warnings of cables in the run begin at the last edit.");
  simulation.def("certificate", &certificate_of,
                 "Certificate of the last substep, item by item; None before the first step.");
  simulation.def(
      "run_certificate", [](Core& core) { return items_of(core.world().run_certificate()); },
      "Certificate of the run so far, item by item: of the substeps that were checked, as in "
      "`sheave run`, and of the energy of all steps.");
  simulation.def_property_readonly(
      "doubtful", [](Core& core) { return !core.world().run_certificate().clean(); },
      "Whether `sheave run` would call the run so far doubtful.");
  simulation.def("contacts", &contacts_of, "Contacts of bodies that touch or are about to touch.");
}

}  // namespace sheave::python
