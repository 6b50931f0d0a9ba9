#include "fuzz/machine.h"
#include "fuzz/machine_run.h"

namespace sheave::fuzz {
namespace {

using test::Machine;

void check_refusal(const Errors& errors) {
  require(!errors.empty(), "refused without a fault");
  for (const Error& error : errors) require(!error.message.empty(), "a fault without a message");
}

/// Largest number of row solves of a run, counting every round and every trial of an active set. A
/// rope that uses all allowed rounds shows nothing new after some steps.
constexpr std::int64_t most_work = 100'000;

std::int64_t work_of(const StepStatistics& step) {
  return step.row_solves + step.rows * step.set_changes;
}

/// The states of a run at its pause and at its end.
struct Course {
  State middle;
  State end;
  int steps = 0;  ///< number of completed steps
  bool diverged = false;
};

/// One step with checks.
StepReport advance(Simulation& simulation) {
  StepReport report = simulation.world.step();
  if (!report.ok()) require(!report.divergence->message.empty(), "a divergence without a message");
  return report;
}

Course first_run(const Trial& trial, Simulation& simulation) {
  Course course;
  StepCheck check(simulation, !trial.changed);
  std::int64_t work = 0;
  while (course.steps < run_steps && work < most_work && !course.diverged) {
    if (course.steps == trial.pause) course.middle = simulation.world.state();
    const StepReport report = advance(simulation);
    ++course.steps;
    work += work_of(report.statistics);
    course.diverged = !report.ok();
    if (report.ok()) check.check(simulation);
  }
  course.end = simulation.world.state();
  return course;
}

/// Repeats the run from a state that is written and read at the pause.
void second_run(const Trial& trial, const Course& course) {
  Simulation again = test::start(trial.machine);
  bool going = true;
  for (int i = 0; i < course.steps && going; ++i) {
    if (i == trial.pause) {
      require(hash(again.world.state()) == hash(course.middle), "another state the second time");
      const Result<State> read = state_from_bytes(to_bytes(course.middle));
      require(read.ok(), "a state that was written is not read");
      require(again.world.restore(*read).empty(), "a state of the machine is not taken back");
    }
    going = advance(again).ok();
  }
  require(going == !course.diverged, "diverges only once");
  require(hash(again.world.state()) == hash(course.end), "goes on otherwise from a saved state");
}

}  // namespace

void try_machine(Bytes bytes) {
  const Trial trial = trial_from(bytes);
  const Machine& machine = trial.machine;
  const Errors found = Simulation::check(machine.model, machine.cables);
  Result<Simulation> simulation = Simulation::create(machine.model, machine.cables);
  require(simulation.ok() == found.empty(), "check() and create() do not agree");
  if (!simulation) return check_refusal(simulation.errors());
  require(trial.changed || simulation.ok(), "a generator's machine is refused");
  require(!simulation->certificate().has_value(), "a certificate of nothing");
  const Course course = first_run(trial, *simulation);
  second_run(trial, course);
}

}  // namespace sheave::fuzz
