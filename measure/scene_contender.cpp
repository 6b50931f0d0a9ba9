#include "measure/scene_contender.h"

#include <memory>
#include <utility>

#include "cable/simulation.h"
#include "measure/trajectory.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::measure {

Result<Contender> scene_contender(std::string name, const Scene& scene, StopRequest stop) {
  Result<Simulation> created = create_simulation(scene);
  if (!created) return created.errors();
  // Shared, because std::function copies its captures.
  const auto simulation = std::make_shared<Simulation>(std::move(created).value());
  const auto start = std::make_shared<const State>(simulation->world.state());
  return Contender{std::move(name),
                   [simulation, start] { static_cast<void>(simulation->world.restore(*start)); },
                   [simulation, stop = std::move(stop)] { return simulation->step(stop).ok(); },
                   frame_count(scene)};
}

}  // namespace sheave::measure
