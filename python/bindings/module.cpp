// The compiled part of the package `sheave`; python/sheave/ is the Python part.

#include "python/bindings/bind.h"
#include "sheave_version.h"

PYBIND11_MODULE(_sheave, module) {
  namespace own = sheave::python;
  namespace py = pybind11;
  module.doc() = "The compiled half of sheave; use the package `sheave`.";
  module.attr("__version__") = SHEAVE_VERSION;
  own::SimulationClass simulation(module, "Simulation", "A world that lives.");
  own::bind_simulation(module, simulation);
  own::bind_state(module, simulation);
  own::bind_views(simulation);
  own::bind_observables(simulation);
  own::bind_edit(simulation);
  own::bind_bodies(module, simulation);
  own::bind_joints(module, simulation);
  own::bind_cables(module, simulation);
  own::bind_robotics(simulation);
  own::bind_statics(simulation);
  own::bind_batch(module);
  own::bind_formats(module);
  own::bind_pictures(module, simulation);
}
