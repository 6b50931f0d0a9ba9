// Stored, hashed and saved states.

#include <fmt/format.h>

#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "scenes/saved_state.h"

namespace sheave::python {
namespace {

/// A snapshot and its simulation.
struct Snapshot {
  std::shared_ptr<Core> core;
  live::KeptSnapshot kept;
};

void restore(Core& core, const Snapshot& snapshot) {
  live::SessionState& session = core.session();
  check(session.world.restore(snapshot.kept.snapshot));
  session.revision = snapshot.kept.revision;
  session.refresh();
}

py::bytes save_state(Core& core) { return saved_state(core.simulation()); }

/// The text of the scene, from which a copy of the simulation can be made.
std::string scene_text(Core& core) {
  const live::SessionState& session = core.session();
  if (session.revision != session.snapshots.at("start").revision) {
    raise("Error",
          "a simulation that has been edited cannot be pickled or copied, because its scene no "
          "longer describes it; use snapshot() within this process");
  }
  return write_scene(core.scene());
}

void load_state(Core& core, const py::bytes& bytes) {
  State state;
  const std::vector<std::string> warnings =
      value_of(check_saved_state(core.simulation(), std::string(bytes), state), "StateError");
  const Errors errors = core.world().restore(state);
  if (!errors.empty()) raise("StateError", errors);
  for (const std::string& warning : warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw py::error_already_set();
  }
}

}  // namespace

void bind_state(py::module_& module, SimulationClass& simulation) {
  py::class_<Snapshot>(module, "Snapshot", "A state together with the parts of its world.")
      .def_property_readonly(
          "time", [](const Snapshot& snapshot) { return snapshot.kept.snapshot.state().time; },
          "[s]")
      .def_property_readonly(
          "steps", [](const Snapshot& snapshot) { return snapshot.kept.snapshot.state().steps; })
      .def_property_readonly("hash", [](const Snapshot& snapshot) {
        return fmt::format("{:016x}", hash(snapshot.kept.snapshot.state()));
      });
  simulation.def_property_readonly(
      "hash", [](Core& core) { return fmt::format("{:016x}", hash(core.world().state())); },
      "Hash of every bit of the state: 16 hexadecimal digits, as in `sheave run`.");
  simulation.def(
      "snapshot",
      [](const std::shared_ptr<Core>& core) {
        return Snapshot{core, core->session().keep()};
      },
      "A snapshot of the state, which can be restored also across edits.");
  simulation.def("restore", &restore, py::arg("snapshot"),
                 "Restores a snapshot, earlier or later.");
  simulation.def(
      "reset",
      [](Core& core) {
        live::SessionState& session = core.session();
        const live::KeptSnapshot start = session.snapshots.at("start");
        check(session.world.restore(start.snapshot));
        session.revision = start.revision;
        session.refresh();
        core.events.clear();
      },
      "Restores the state at the start of the scene.");
  simulation.def("_scene_text", &scene_text);
  simulation.def("state_bytes", &save_state,
                 "The state as bytes, as `sheave run --save-state` writes them.");
  simulation.def("set_state_bytes", &load_state, py::arg("state"),
                 "The inverse of state_bytes(), for the same bodies, joints and cables.");
}

}  // namespace sheave::python
