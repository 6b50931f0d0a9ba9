// Structural changes of the world, in the protocol of live sessions.

#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"

namespace sheave::python {

void bind_edit(SimulationClass& simulation) {
  simulation.def(
      "_answer",
      [](Core& core, const py::object& request) { return core.answer(text(request, "request")); },
      py::arg("request"), "The answer to a line of the protocol of live sessions, without steps.");
}

}  // namespace sheave::python
