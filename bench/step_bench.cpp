#include "bench/step_bench.h"

#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/generators.h"
#include "scenes/scene.h"

namespace sheave::bench {
namespace {

// Steps per sample. A sample begins at time 0, so that falling weights never come far; before the
// first one a few steps warm up caches and branch predictors.
constexpr int steps_per_sample = 60;
constexpr int warm_up_steps = 10;

constexpr double most_length_error = 1e-12;

/// Why a simulation's numbers cannot be trusted; nothing if they can.
std::optional<std::string> physics_fault(const Simulation& simulation) {
  for (const BodyState& body : simulation.world.state().bodies) {
    const bool finite = body.position.allFinite() && body.velocity.allFinite() &&
                        body.orientation.coeffs().allFinite() && body.angular_velocity.allFinite();
    if (!finite) return "a body's state is not finite";
  }
  for (const CableReport& cable : simulation.cable_reports()) {
    // Written so that NaN fails.
    if (!(std::abs(cable.length_error) <= most_length_error)) {
      return fmt::format("cable length is wrong by {:.3g}", cable.length_error);
    }
  }
  return std::nullopt;
}

int span_count(const Scene& scene) {
  int count = 0;
  for (const CableDef& cable : scene.cables) count += cable.span_count();
  return count;
}

/// CPU time of this thread [s]. A step runs on one thread and never waits, so on a quiet machine
/// this is the wall time; on a busy one it leaves out the time that others took.
double thread_time() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Steps the simulation and returns the time it took [s]; the fault if it diverges.
double timed_steps(Simulation& simulation, int steps, std::optional<std::string>& fault) {
  bool ok = true;
  const double start = thread_time();
  for (int i = 0; i < steps; ++i) ok = simulation.step().ok() && ok;
  const double seconds = thread_time() - start;
  if (!ok) fault = "diverged";
  return seconds;
}

/// One sample per iteration of the benchmark. Reports no time at all unless every sample passes the
/// physics check.
void measure(benchmark::State& state, const Scene& scene) {
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) {
    state.SkipWithError(simulation.errors().front().message.c_str());
    return;
  }
  const State start = simulation->world.state();
  std::optional<std::string> fault;
  timed_steps(*simulation, warm_up_steps, fault);
  double total = 0.0;
  double samples = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    static_cast<void>(simulation->world.restore(start));
    const double seconds = timed_steps(*simulation, steps_per_sample, fault);
    if (!fault) fault = physics_fault(*simulation);
    if (fault) {
      state.SkipWithError(fault->c_str());
      return;
    }
    state.SetIterationTime(seconds);
    total += seconds;
    ++samples;
  }
  const StepSettings& step = scene.model.step;
  const double step_ns = 1e9 * total / (samples * steps_per_sample);
  const double span_substeps = static_cast<double>(span_count(scene)) * step.substeps;
  // Of Google Benchmark's columns, "Time" is the same per sample; "CPU" includes restoring the
  // start.
  state.counters["spans"] = span_count(scene);
  state.counters["us_per_step"] = 1e-3 * step_ns;
  state.counters["ns_per_span_substep"] = step_ns / span_substeps;
  state.counters["ns_per_span_iteration"] = step_ns / (span_substeps * step.iterations);
}

void add(const std::string& name, Scene scene, int iterations) {
  scene.model.step.iterations = iterations;
  // Shared, because the library keeps what it runs in a std::function.
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  benchmark::RegisterBenchmark(fmt::format("{}/iterations:{}", name, iterations).c_str(),
                               [shared](benchmark::State& state) { measure(state, *shared); })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

/// The direct solver with as many rounds as it wants.
void add_direct(const std::string& name, Scene scene) {
  scene.model.step.solver = SolverKind::direct;
  add(name + "/direct", std::move(scene), 10);
}

/// A benchmark that only reports why there is none.
void add_failure(const std::string& name, const std::string& reason) {
  benchmark::RegisterBenchmark(
      name.c_str(), [reason](benchmark::State& state) { state.SkipWithError(reason.c_str()); });
}

}  // namespace

void register_step_benchmarks() {
  constexpr int one = 1;
  constexpr int ten = 10;
  const SceneResult simple = load_scene(SHEAVE_SOURCE_DIR "/scenes/paper/simple.json");
  if (!simple) add_failure("step/simple", to_string(simple.errors.front()));
  for (const int iterations : {one, ten}) {
    if (simple) add("step/simple", *simple, iterations);
  }
  for (const int wheels : {16, 64, 256, 1024}) {
    WheelTrainOptions options;
    options.wheels = wheels;
    const Result<Scene> train = generate_wheel_train(options);
    const std::string name = fmt::format("step/wheel-train/wheels:{}", wheels);
    if (!train) add_failure(name, train.errors().front().message);
    for (const int iterations : {one, ten}) {
      if (train) add(name, *train, iterations);
    }
    if (train) add_direct(name, *train);
  }
}

}  // namespace sheave::bench
