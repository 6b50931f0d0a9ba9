// The time step: the order of its stages is decided here and nowhere else.
//
// Cost of a substep: bodies x (predict + derive) + rows x begin + iterations x rows x (evaluate +
// solve) + rows x finish.

#include "engine/step.h"

#include <algorithm>

#include "engine/solvers/direct.h"
#include "engine/solvers/gauss_seidel.h"
#include "engine/stages.h"

namespace sheave {
namespace {

bool has_kinematic_bodies(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const BodyDef& body) { return body.mobility == Mobility::kinematic; });
}

bool has_mounted_rotors(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const BodyDef& body) { return body.mount.has_value(); });
}

}  // namespace

std::vector<Stage> substep_stages(const Model& model,
                                  std::span<const std::unique_ptr<ConstraintBatch>> features) {
  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::function<void(Substep&)> run) {
    stages.push_back({std::move(name), std::move(run)});
  };

  for (std::size_t i = 0; i < features.size(); ++i) {
    ConstraintBatch& feature = *features[i];
    add("begin " + std::string(feature.name()),
        [&feature, i](Substep& substep) { feature.begin(substep, substep.start.features[i]); });
  }
  if (has_kinematic_bodies(model)) add("move kinematic bodies", move_kinematic_bodies);
  add("predict", predict);
  if (!features.empty()) {
    const std::string name(solver_names[static_cast<std::size_t>(model.step.solver)]);
    if (model.step.solver == SolverKind::direct) {
      add("solve by " + name, [features, solver = std::make_shared<DirectSolver>()](
                                  Substep& substep) { solver->solve(substep, features); });
    } else {
      add("solve by " + name,
          [features](Substep& substep) { solve_gauss_seidel(substep, features); });
    }
  }
  add("derive velocities", derive_velocities);
  if (has_mounted_rotors(model)) add("place mounted rotors", place_mounted_rotors);
  for (std::size_t i = 0; i < features.size(); ++i) {
    ConstraintBatch& feature = *features[i];
    add("finish " + std::string(feature.name()),
        [&feature, i](Substep& substep) { feature.finish(substep, substep.next.features[i]); });
  }
  return stages;
}

}  // namespace sheave
