#include "scenes/observables_muscle.h"

#include <limits>

#include "engine/index.h"
#include "scenes/control/load_muscle.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/quantities.h"

namespace sheave {
namespace {

constexpr double no_muscle = std::numeric_limits<double>::quiet_NaN();

const SceneSupervisor* scene_supervisor_of(const Simulation& simulation) {
  return dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
}

}  // namespace

std::vector<std::string> muscle_names(std::span<const std::shared_ptr<const LoadDef>> loads) {
  std::vector<std::string> names;
  for (const auto& load : loads) {
    if (load->is_muscle()) names.push_back(load->name);
  }
  return names;
}

std::vector<std::string> muscle_names(const Simulation& simulation) {
  std::vector<std::string> names;
  const SceneSupervisor* const own = scene_supervisor_of(simulation);
  if (own == nullptr) return names;
  for (std::size_t i = 0; const LoadDef* const muscle = own->muscle(i); ++i) {
    names.push_back(muscle->name);
  }
  return names;
}

double MuscleSampler::value(int muscle, int quantity) {
  if (states_.empty()) {
    const SceneSupervisor* const own = scene_supervisor_of(simulation_);
    if (own != nullptr) states_ = own->muscles(simulation_.world.state());
  }
  if (static_cast<std::size_t>(muscle) >= states_.size()) return no_muscle;
  const MuscleState& state = states_[static_cast<std::size_t>(muscle)];
  return quantity == muscle_tension ? state.tension : state.activation;
}

double MuscleSampler::fibre(int muscle, int quantity, std::span<const CableReport> cables) const {
  const SceneSupervisor* const own = scene_supervisor_of(simulation_);
  const LoadDef* const load = own == nullptr ? nullptr : own->muscle(at(muscle));
  const auto* const definition = dynamic_cast<const MuscleLoad*>(load);
  if (definition == nullptr) return no_muscle;
  const std::optional<MuscleFibre> fibre = definition->fibre(simulation_.world, cables);
  if (!fibre) return no_muscle;
  return quantity == 0 ? fibre->length : fibre->velocity;
}

}  // namespace sheave
