#pragma once
// One function per topic; each adds its part to the module.

#include <memory>

#include <pybind11/pybind11.h>

#include "python/bindings/core.h"

namespace sheave::python {

using SimulationClass = py::class_<Core, std::shared_ptr<Core>>;

void bind_simulation(py::module_& module, SimulationClass& simulation);
void bind_state(py::module_& module, SimulationClass& simulation);
void bind_views(SimulationClass& simulation);
void bind_observables(SimulationClass& simulation);
void bind_edit(SimulationClass& simulation);
void bind_bodies(py::module_& module, SimulationClass& simulation);
void bind_joints(py::module_& module, SimulationClass& simulation);
void bind_robotics(SimulationClass& simulation);
void bind_statics(SimulationClass& simulation);
void bind_cables(py::module_& module, SimulationClass& simulation);
void bind_batch(py::module_& module);
void bind_formats(py::module_& module);
void bind_pictures(py::module_& module, SimulationClass& simulation);

/// Effects of a placement: "energy" [J], and "cables" with the increase of each length [m].
[[nodiscard]] py::dict placement_dict(LiveWorld& world, const Placement& placed);

/// The handle of a body, joint or cable of a simulation, given by name or number.
template <class Tag>
struct Thing {
  std::shared_ptr<Core> core;
  Handle<Tag> handle;
  [[nodiscard]] bool operator==(const Thing& other) const {
    return core == other.core && handle == other.handle;
  }
};
using LiveBody = Thing<BodyTag>;
using LiveJoint = Thing<JointTag>;
using LiveCable = Thing<CableTag>;

/// The world of an entity that still exists; raises StaleError if it does not.
template <class Tag>
LiveWorld& world_of(const Thing<Tag>& thing);

}  // namespace sheave::python
