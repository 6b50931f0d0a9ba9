#include "command/run/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "command/run/remedy.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/integrators/loads.h"
#include "measure/stress_judge.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::command {

bool RunSummary::checks_passed() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const CheckResult& check) { return check.passed; });
}

bool RunSummary::doubtful() const {
  return outcome.status == RunStatus::done && !outcome.certificate.clean(trust);
}

std::string_view RunSummary::status() const {
  return doubtful() ? "doubtful" : name_of(outcome.status);
}

namespace {

/// Warns of joints that did not hold. A rigid joint is as exact as the solver; an opening of more
/// than a thousandth of the scene's size, or of 0.01 rad, is a failure.
void append_joint_warnings(const Simulation& simulation, const RunStatistics& statistics,
                           const RunMonitor& monitor, std::vector<Warning>& warnings) {
  const double most_open = 1e-3 * simulation.world.bodies().scale();
  constexpr double most_tilted = 1e-2;
  constexpr double share_limit = 0.05;
  std::size_t worst = 0;
  double worst_share = 1.0;
  std::size_t count = 0;
  const auto& joints = monitor.joints();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double share = std::max(joints[i].error / most_open, joints[i].angle_error / most_tilted);
    if (share <= 1.0) continue;
    ++count;
    if (share <= worst_share) continue;
    worst = i;
    worst_share = share;
  }
  const std::string why = statistics.compromises > 0
                              ? "joints, drives or cables contradict each other, and all of them "
                                "gave way; remove one of them or make it elastic"
                              : "the solver did not converge (more substeps may help), or joints "
                                "and drives contradict each other";
  const auto& names = simulation.world.model().joints;
  if (count > 0) {
    const JointCourse& course = joints[worst];
    const bool tilted = course.angle_error / most_tilted > course.error / most_open;
    warnings.push_back(
        {"joint_open", names[worst]->name,
         fmt::format("joint {} was off by {:.3g} {} at {} s{}: {}", names[worst]->name,
                     tilted ? course.angle_error : course.error, tilted ? "rad" : "m",
                     number_text(tilted ? course.angle_error_time : course.error_time),
                     count > 1 ? fmt::format(", and {} more were", count - 1) : "", why)});
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointCourse& course = joints[i];
    if (course.drive_error <= share_limit * course.drive_asked) continue;
    // A brake asks for 0, of which there is no part.
    const std::string off =
        course.drive_asked > 0.0
            ? fmt::format("{:.3g} of the target", course.drive_error / course.drive_asked)
            : fmt::format("{:.3g} (m/s or rad/s; the target is 0)",
                          course.drive_error / static_cast<double>(course.drive_samples));
    warnings.push_back({"drive_off", names[i]->name,
                        fmt::format("the drive of joint {} missed its target by {} in the mean: {}",
                                    names[i]->name, off, why)});
  }
}

/// Warns of rigid cables that did not keep their length.
/// A cable that is much too long at the end has wrong positions of bodies.
/// A cable whose length changes by a considerable part of the path of its bodies does not hold
/// them: the solver has not converged, and accelerations and tensions are wrong by about that
/// share. A constant excess is harmless, because the forces are right. Unconverged sweeps act like
/// a spring, so the excess may increase and decrease. Changes below 1e-7 of the cable's length are
/// ignored.
void append_stretch_warnings(const Simulation& simulation, const RunStatistics& statistics,
                             const RunMonitor& monitor, std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.05;
  constexpr double length_limit = 0.05;
  constexpr double negligible_share = 1e-7;
  const StepSettings& step = simulation.world.model().step;
  const std::string way_out = remedy(step, StepFault::unconverged);
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t i = 0; i < monitor.cables().size(); ++i) {
    const CableCourse& course = monitor.cables()[i];
    if (course.excess > length_limit * course.length) {
      std::string name(reports[i].name);
      // If the constraints leave no motion, no solver can help: the warnings "impossible" and
      // "dead_end" give the details.
      const std::string cause =
          statistics.impossible + statistics.dead_ends > 0
              ? "bodies with a prescribed motion have drawn it apart, or the solver did not "
                "converge"
              : fmt::format("the solver did not converge; {} may avoid that", way_out);
      std::string message = fmt::format("cable {} is {:.3g} m longer than it can be at the end: {}",
                                        name, course.excess, cause);
      warnings.push_back({"stretched", std::move(name), std::move(message)});
      continue;
    }
    const double negligible = negligible_share * course.length;
    const auto gives_way = [&](double stretching, double way) {
      return stretching > std::max(share_limit * way, negligible);
    };
    const double stretching = course.stretching[0] + course.stretching[1];
    const double way = course.way[0] + course.way[1];
    // Stretching in the first half matters only if the motion goes on in the second half. Otherwise
    // the cable only sagged into place, and no other motion was wrong.
    const bool moves_on = course.way[1] > stretching;
    if (!gives_way(course.stretching[1], course.way[1]) &&
        !(moves_on && gives_way(stretching, way))) {
      continue;
    }
    std::string name(reports[i].name);
    std::string message = fmt::format(
        "cable {} did not keep its length: the length changed by {:.3g} m in total while no body "
        "on it moved by more than {:.3g} m; the solver did not converge, and motion and tensions "
        "have about this relative error; {} may avoid that",
        name, stretching, way, way_out);
    warnings.push_back({"stretched", std::move(name), std::move(message)});
  }
}

/// xpbd damps a vibration of angular frequency w at the rate w^2 h / 2; rattle does not damp.
void append_damping_warning(const StepSettings& step, const RunStatistics& statistics,
                            const RunMonitor& monitor, std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.1;  // of the energy, i.e. 5 % of the speeds
  const double energy = monitor.most_vivid_energy();
  if (!(statistics.numerical_damping > share_limit * energy)) return;
  std::string message = fmt::format(
      "the step is too long for the vibration of elastic cables: xpbd took {:.3g} J from the "
      "vibration, and kinetic and elastic energy were {:.3g} J at most; {} may avoid that",
      statistics.numerical_damping, energy, remedy(step, StepFault::long_step));
  warnings.push_back({"damped_vibration", "", std::move(message)});
}

/// xpbd removes energy from every motion that is not straight and uniform
/// (cable/certificate/integrator_loss.h).
void append_loss_warning(const StepSettings& step, const RunMonitor& monitor,
                         std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.01;
  constexpr double rounding = 1e-12;  // of the potential energy
  const bool said = std::any_of(warnings.begin(), warnings.end(), [](const Warning& warning) {
    return warning.kind == "damped_vibration";
  });
  const double loss = monitor.integrator_loss();
  const double flow = monitor.energy_flow();
  const double least = rounding * std::abs(monitor.initial_energy().potential);
  // If an energy overflows, the share is NaN, and the condition is false.
  if (said || !(loss > share_limit * flow + least)) return;
  std::string message = fmt::format(
      "xpbd took about {:.3g} J from the motion, {:.2g} % of the energy that flowed: the step is "
      "too long for this motion; {} may avoid that",
      loss, 100.0 * loss / flow, remedy(step, StepFault::long_step));
  warnings.push_back({"integrator_loss", "", std::move(message)});
}

/// Without a source the energy never exceeds its initial value. Two errors create energy: a step
/// that is too long for a swinging or spinning body (a light weight on a taut cable, pulled round a
/// wheel; the gyroscopic motion of long bodies), and unconverged sweeps that leave springs
/// stretched without a force.
void append_energy_warning(const Scene& scene, const Simulation& simulation,
                           const RunMonitor& monitor, std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.1;
  constexpr double rounding = 1e-12;  // of the potential energy
  if (!measure::is_conservative(scene)) return;
  const double size = monitor.most_vivid_energy();
  const double gain = monitor.max_energy_gain();
  // Rounding is relative to the potential energy at heights of the scene's size: the energy at the
  // present heights may be 0.
  const BodySet& bodies = simulation.world.bodies();
  double potential = std::abs(monitor.initial_energy().potential);
  for (int i = 0; i < bodies.count(); ++i) {
    potential += bodies[i].mass * bodies.gravity().norm() * bodies.scale();
  }
  if (!(gain > share_limit * size + rounding * (size + potential))) return;
  std::string message = fmt::format(
      "there was {:.3g} J more energy than at the start, and nothing puts energy into the scene; "
      "kinetic and elastic energy were {:.3g} J at most: the step is too long or the solver did "
      "not converge, and the "
      "motion is not reliable; {} may avoid that",
      gain, size, remedy(scene.model.step, StepFault::either));
  warnings.push_back({"energy_gain", "", std::move(message)});
}

/// The spacing of doubles at a position [m] along the axis of the largest acceleration, divided by
/// a h^2, the displacement by that acceleration in a substep; 0 without acceleration.
double rounding_of_motion(const World& world, int body) {
  const BodySet& bodies = world.bodies();
  const BodyProperties& properties = bodies[body];
  if (!(properties.mass > 0.0) || properties.mobility == Mobility::kinematic) return 0.0;
  const Vector3 given = bodies.definition(body).force / properties.mass;
  const Vector3 loads = bodies.gravity() + given;
  // Loads that cancel each other leave their rounding.
  if (loads.norm() <= 1e-12 * given.norm()) return 0.0;
  const Vector3 acceleration = allowed_velocity(properties, loads);
  Eigen::Index axis = 0;
  const double most = acceleration.cwiseAbs().maxCoeff(&axis);
  if (!(most > 0.0)) return 0.0;
  const StepSettings& step = world.model().step;
  const double h = step.dt / step.substeps;
  const double position =
      std::abs(world.state().bodies[static_cast<std::size_t>(body)].position[axis]);
  const double digit = std::nextafter(position, std::numeric_limits<double>::infinity()) - position;
  return digit / (most * h * h);
}

/// Velocities are differences of positions, which loads change by a h^2 per substep. A position is
/// rounded by up to half the spacing of doubles, so accelerations have a relative error of half the
/// ratio of that spacing to a h^2.
void append_rounding_warning(const World& world, std::vector<Warning>& warnings) {
  constexpr double share_limit = 0.1;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const double share = rounding_of_motion(world, i);
    if (share <= share_limit) continue;
    const std::string& name = world.bodies().name(i);
    std::string message = fmt::format(
        "the substep is too short: in a substep, loads move body {} by little more than the "
        "rounding of its position, which is {:.2g} of that motion; the velocity has about this "
        "relative error; use fewer substeps or a longer dt",
        name, share);
    warnings.push_back({"rounding", name, std::move(message)});
    return;  // the other bodies probably have the same problem
  }
}

/// The controllers and triggers of the simulation's scene, if it has any.
const SceneSupervisor* supervisor_of(const Simulation& simulation) {
  return dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get());
}

void append_control_warning(const Simulation& simulation, std::vector<Warning>& warnings) {
  const SceneSupervisor* supervisor = supervisor_of(simulation);
  if (supervisor == nullptr) return;
  const std::int64_t refusals = supervisor->refusals(simulation.world.state());
  if (refusals == 0) return;
  warnings.push_back(
      {"control_refused", "",
       fmt::format(
           "{} times a controller or trigger could not set its control, because the value "
           "was not finite or not allowed, or could not cut its cable, because the place lies on a "
           "wheel or beyond the end; give the controller limits, or the cut another place",
           refusals)});
}

/// The part of a run's statistics that single steps have, too.
StepStatistics step_statistics(const RunStatistics& run) {
  StepStatistics statistics;
  statistics.solver_fallbacks = run.solver_fallbacks;
  statistics.impossible = run.impossible;
  statistics.dead_ends = run.dead_ends;
  statistics.most_impossible = run.most_impossible;
  statistics.integrator_fallbacks = run.integrator_fallbacks;
  statistics.cut_substeps = run.cut_substeps;
  statistics.substep_parts = run.substep_parts;
  statistics.unconverged = run.unconverged;
  statistics.exhausted = run.exhausted;
  statistics.unknown_forces = run.unknown_forces;
  return statistics;
}

}  // namespace

std::vector<Warning> collect_warnings(const Scene& scene, const Simulation& simulation,
                                      const RunStatistics& statistics, const RunMonitor& monitor) {
  std::vector<Warning> warnings;
  if (simulation.cables != nullptr) {
    constexpr double ever = -std::numeric_limits<double>::infinity();
    append_cable_warnings(*simulation.cables, simulation.world.bodies(), ever, warnings);
    append_stretch_warnings(simulation, statistics, monitor, warnings);
  }
  append_joint_warnings(simulation, statistics, monitor, warnings);
  append_damping_warning(scene.model.step, statistics, monitor, warnings);
  append_loss_warning(scene.model.step, monitor, warnings);
  append_energy_warning(scene, simulation, monitor, warnings);
  append_rounding_warning(simulation.world, warnings);
  append_solver_warnings(step_statistics(statistics), warnings);
  append_control_warning(simulation, warnings);
  return warnings;
}

std::vector<RunEvent> collect_events(const Simulation& simulation,
                                     const std::vector<JointReport>& joints) {
  std::vector<RunEvent> events;
  if (simulation.cables != nullptr) {
    for (const CableEvent& event : simulation.cables->events()) {
      events.push_back({event.time, RunEvent::Source::cable, event.cable, event.link, event.body,
                        cable_event_names[static_cast<std::size_t>(event.kind)]});
    }
  }
  for (const JointReport& joint : joints) {
    if (!joint.broken_at) continue;
    events.push_back({*joint.broken_at, RunEvent::Source::joint, joint.name, -1, "", "break"});
  }
  if (const SceneSupervisor* supervisor = supervisor_of(simulation)) {
    const auto times = supervisor->acted_at(simulation.world.state());
    for (std::size_t i = 0; i < times.size(); ++i) {
      const TriggerDef& trigger = supervisor->trigger(i);
      if (!times[i]) continue;
      events.push_back({*times[i], RunEvent::Source::trigger, trigger.name, -1, "",
                        trigger_action_names[static_cast<std::size_t>(trigger.action)]});
    }
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const RunEvent& a, const RunEvent& b) { return a.time < b.time; });
  return events;
}

double time_per_step(const RunOutcome& outcome) {
  if (outcome.steps == 0) return std::numeric_limits<double>::quiet_NaN();
  return outcome.step_time / static_cast<double>(outcome.steps);
}

}  // namespace sheave::command
