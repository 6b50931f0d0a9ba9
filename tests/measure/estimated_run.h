#pragma once
// Runs with the estimate of their step's error.

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "measure/error_estimate.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/support/builders.h"

namespace sheave::test {

/// A run with its estimate.
struct Estimated {
  measure::ErrorEstimate estimate;
  std::vector<double> times;
  std::vector<measure::Frame> frames;  ///< of the bodies that move, one per time

  [[nodiscard]] const measure::Frame& at(double time) const {
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] == time) return frames[i];
    }
    throw std::runtime_error("no such frame");
  }
};

inline Estimated estimated(const Scene& scene) {
  Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) throw std::runtime_error(text(simulation.errors()));
  Result<measure::ErrorEstimator> estimator =
      measure::ErrorEstimator::create(scene, simulation->world.state());
  if (!estimator) throw std::runtime_error(text(estimator.errors()));
  const std::vector<measure::TrackedBody> bodies =
      measure::tracked_bodies(simulation->world.bodies());
  Estimated run;
  for (std::int64_t i = 0; i < measure::frame_count(scene); ++i) {
    EXPECT_TRUE(simulation->step({}, [&] { estimator->look(*simulation); }, {}).ok());
    estimator->observe(*simulation);
    run.times.push_back(simulation->world.state().time);
    run.frames.push_back(measure::frame_of(*simulation, bodies));
  }
  run.estimate = estimator->estimate();
  return run;
}

inline Scene scene_of(const Machine& machine, IntegratorKind integrator, int substeps) {
  Scene scene;
  scene.model = machine.model;
  scene.cables = machine.cables;
  scene.duration = 2.0;
  scene.model.step = settings(1.0 / 60.0, substeps, 30);
  scene.model.step.solver = SolverKind::direct;
  scene.model.step.integrator = integrator;
  return scene;
}

}  // namespace sheave::test
