#include "fuzz/machine.h"

#include <algorithm>

#include "fuzz/heap.h"
#include "fuzz/machine_change.h"
#include "tests/property/wide_machine.h"
#include "tests/scenes/random_scene.h"

namespace sheave::fuzz {
namespace {

using test::Machine;
using test::Random;

/// Takes up to `count` bytes from the front.
Bytes take(Bytes& bytes, std::size_t count) {
  const Bytes front = bytes.first(std::min(count, bytes.size()));
  bytes = bytes.subspan(front.size());
  return front;
}

std::uint64_t seed_of(Bytes bytes) {
  std::uint64_t seed = 0;
  for (const std::uint8_t byte : bytes) seed = seed << 8U | byte;
  return seed;
}

Machine any_fields(Random& random) {
  Scene scene = test::random_scene(static_cast<unsigned>(random.below(1 << 16)));
  return {std::move(scene.model), std::move(scene.cables)};
}

void choose_steps(Random& frame, StepSettings& step) {
  step.solver = frame.chance(0.6) ? SolverKind::direct : SolverKind::gauss_seidel;
  step.integrator = frame.chance(0.5) ? IntegratorKind::rattle : IntegratorKind::xpbd;
  step.substeps = 1 + (frame.chance(0.5) ? frame.below(4) : 0);
  step.iterations = 1 + frame.below(30);
  constexpr std::array<double, 8> lengths{1.0 / 60.0,  1.0 / 120.0, 1.0 / 240.0, 1.0 / 480.0,
                                          1.0 / 960.0, 1e-4,        1.0 / 30.0,  1.0 / 10.0};
  step.dt = lengths[static_cast<std::size_t>(frame.below(lengths.size()))];
}

/// Bounds the work of a run. Larger numbers would execute the same code.
void bound_work(StepSettings& step) {
  step.substeps = std::min(step.substeps, 4);
  step.iterations = std::min(step.iterations, 30);
}

}  // namespace

Trial trial_from(Bytes bytes) {
  const std::uint64_t seed = seed_of(take(bytes, 8));
  Random frame(seed, take(bytes, 64));
  Random random(~seed, bytes);
  Trial trial;
  const int kind = frame.below(16);
  if (kind < 9) {
    trial.machine = test::wide_machine(random);
  } else if (kind < 15) {
    trial.machine = heap(random);
  } else {
    trial.machine = any_fields(random);
    trial.changed = true;
  }
  choose_steps(frame, trial.machine.model.step);
  trial.pause = frame.below(run_steps);
  for (int changes = frame.below(3) * frame.below(4); changes > 0; --changes) {
    change_field(frame, trial.machine);
    trial.changed = true;
  }
  bound_work(trial.machine.model.step);
  return trial;
}

}  // namespace sheave::fuzz
