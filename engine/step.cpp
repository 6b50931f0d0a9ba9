// The time step: the order of its stages is decided in this file alone.
//
// Cost of a substep: bodies x (predict + derive) + rows x (begin + finish), and for the rows in
// between
//   gauss-seidel:  iterations x rows x (evaluate + solve)
//   direct:        rounds x (rows x evaluate + assemble and factor), mostly 2 rounds; the
//                  factorisation of a chain is linear in its rows
// `rattle` evaluates the rows once more, solves once more (for velocities), and goes over the
// bodies once more. Machines whose row gradients are constant skip all stages where they can:
// engine/solvers/affine_motion.h.

#include "engine/step.h"

#include <algorithm>

#include "engine/instant_feature.h"
#include "engine/integrators/rattle.h"
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

/// Adds the stages that move bodies as their rows ask. `rattle`: the solver of that integrator,
/// null with `xpbd`.
void add_position_solver(std::vector<Stage>& stages, SolverKind kind,
                         const std::shared_ptr<RattleSolver>& rattle, Features features) {
  const bool direct = kind == SolverKind::direct;
  if (rattle != nullptr) {
    stages.push_back(
        {"solve positions", [=](Substep& substep) { rattle->solve_positions(substep, features); }});
  } else if (!features.empty() && direct) {
    stages.push_back({"solve by direct", [features, own = std::make_shared<DirectSolver>()](
                                             Substep& substep) { own->solve(substep, features); }});
  } else if (!features.empty()) {
    stages.push_back({"solve by gauss-seidel",
                      [features, sweeps = std::make_shared<GaussSeidelSolver>()](Substep& substep) {
                        sweeps->solve(substep, features);
                      }});
  }
  if (!features.empty() && direct) stages.push_back({"remember motion", remember_motion});
}

}  // namespace

std::vector<Stage> substep_stages(const Model& model,
                                  std::span<const std::unique_ptr<ConstraintBatch>> features) {
  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::function<void(Substep&)> run) {
    stages.push_back({std::move(name), std::move(run)});
  };

  const bool rattle = model.step.integrator == IntegratorKind::rattle;
  const bool moves_kinematic = has_kinematic_bodies(model);
  const bool mounted = has_mounted_rotors(model);
  const bool tolerant = model.step.tolerance > 0.0;
  const bool stiff = std::any_of(features.begin(), features.end(),
                                 [](const auto& feature) { return feature->is_stiff(); });
  // `rattle` sweeps over one system of all rows, which does not converge if some are stiff.
  const SolverKind at_once = stiff ? SolverKind::direct : model.step.solver;
  const auto solver = rattle ? std::make_shared<RattleSolver>(at_once) : nullptr;

  for (std::size_t i = 0; i < features.size(); ++i) {
    ConstraintBatch& feature = *features[i];
    add("begin " + std::string(feature.name()),
        [&feature, i](Substep& substep) { feature.begin(substep, substep.start.features[i]); });
  }
  if (std::any_of(features.begin(), features.end(),
                  [](const auto& feature) { return feature->limits_drives(); })) {
    add("limit drives", [=](Substep& substep) { limit_drives(substep, features); });
  }
  const auto add_impacts = [&](const char* name, auto method) {
    for (const auto& feature : features) {
      auto* const own = dynamic_cast<ImpactFeature*>(feature.get());
      if (!rattle || own == nullptr || (features.size() == 1 && !tolerant)) continue;
      add(name + std::string(feature->name()),
          [own, features, method](Substep& substep) { (own->*method)(substep, features); });
    }
  };
  add_impacts("await impacts of ", &ImpactFeature::await_impacts);
  if (rattle) add("keep the start", [=](Substep& substep) { solver->begin(substep, features); });
  if (moves_kinematic) add("move kinematic bodies", move_kinematic_bodies);
  add("predict", predict);
  add_position_solver(stages, model.step.solver, solver, features);
  add("derive velocities", derive_velocities);
  if (rattle) add("correct gyroscopic velocities", correct_gyroscopic_velocities);
  if (mounted) add("place mounted rotors", place_mounted_rotors);
  if (rattle) add("second half of the loads", add_second_half_of_loads);
  for (const auto& feature : features) {
    if (!feature->corrects_velocities()) continue;
    add("correct velocities of " + std::string(feature->name()),
        [&own = *feature, features](Substep& substep) {
          own.correct_velocities(substep, features);
        });
  }
  if (rattle) {
    add("solve velocities", [=](Substep& substep) { solver->solve_velocities(substep, features); });
  }
  add_impacts("impacts at the end of ", &ImpactFeature::land);
  for (std::size_t i = 0; i < features.size(); ++i) {
    ConstraintBatch& feature = *features[i];
    add("finish " + std::string(feature.name()),
        [&feature, i](Substep& substep) { feature.finish(substep, substep.next.features[i]); });
  }
  return stages;
}

}  // namespace sheave
