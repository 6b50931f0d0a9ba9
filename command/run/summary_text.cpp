#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "command/run/error_estimate_text.h"
#include "command/run/summary.h"
#include "command/terminal.h"
#include "command/text/table.h"
#include "engine/body_set.h"

namespace sheave::command {
namespace {

// Longer lists are left to the JSON output.
constexpr std::size_t max_rows = 24;
constexpr std::size_t max_events = 10;

std::string omitted(std::size_t count, const char* what, std::size_t shown = max_rows) {
  if (count <= shown) return "";
  return fmt::format("  ... and {} more {}; --json lists all\n", count - shown, what);
}

/// The work of the direct solver; empty for gauss-seidel, whose work is fixed by the settings.
std::string direct_solver(const RunSummary& summary) {
  const RunOutcome& outcome = summary.outcome;
  const StepSettings& step = summary.scene.model.step;
  // The number of substeps in a diverged step is unknown.
  if (step.solver != SolverKind::direct || outcome.steps == 0 || outcome.divergence) return "";
  const RunStatistics& statistics = outcome.statistics;
  const double substeps = step.tolerance > 0.0 ? static_cast<double>(statistics.kept_substeps)
                                               : static_cast<double>(outcome.steps) * step.substeps;
  std::string text = fmt::format(
      "{} rows: {} rounds per substep, {} substeps done by Gauss-Seidel, at most {} redundant\n",
      statistics.rows, short_number(static_cast<double>(statistics.rounds) / substeps),
      statistics.solver_fallbacks, statistics.redundant_rows);
  if (statistics.cut_substeps > 0) {
    text += fmt::format("{} {} cut into {} parts\n", statistics.cut_substeps,
                        statistics.cut_substeps == 1 ? "substep" : "substeps",
                        statistics.substep_parts);
  }
  return text;
}

std::string head(const RunSummary& summary) {
  const RunOutcome& outcome = summary.outcome;
  const StepSettings& step = summary.scene.model.step;
  std::string text = printable_line(
      summary.scene.name.empty() ? std::string(summary.scene_path)
                                 : fmt::format("{} ({})", summary.scene.name, summary.scene_path));
  text += fmt::format("\n{}: {} steps to t = {} s", summary.status(), outcome.steps,
                      short_number(summary.simulation.world.state().time));
  if (outcome.steps > 0) {
    text += fmt::format(", {} us per step", short_number(1e6 * time_per_step(outcome)));
  }
  const RunStatistics& done = outcome.statistics;
  const std::string lengths =
      step.tolerance > 0.0
          ? fmt::format("tolerance {} m per second: {} substeps and {} undone",
                        short_number(step.tolerance), done.kept_substeps, done.undone_substeps)
          : fmt::format("{} substeps", step.substeps);
  text += fmt::format("\ndt {} s, {}, {} iterations, {}, {}\n", short_number(step.dt), lengths,
                      step.iterations, solver_names[static_cast<std::size_t>(step.solver)],
                      integrator_names[static_cast<std::size_t>(step.integrator)]);
  text += direct_solver(summary);
  if (outcome.divergence) text += outcome.divergence->message + "\n";
  return text;
}

std::string body_lines(const World& world) {
  TextTable table({"body", "x [m]", "y [m]", "z [m]", "speed [m/s]", "turning [rad/s]"}, 1);
  const auto count = static_cast<std::size_t>(world.bodies().count());
  for (std::size_t i = 0; i < std::min(count, max_rows); ++i) {
    const BodyId id{static_cast<int>(i)};
    const Vector3 x = world.position(id);
    table.add({world.bodies().name(id.index), short_number(x.x()), short_number(x.y()),
               short_number(x.z()), short_number(world.velocity(id).norm()),
               short_number(world.angular_velocity(id).norm())});
  }
  if (count == 0) return "";
  return "\n" + table.text() + omitted(count, "bodies");
}

const std::string& body_name(const RunSummary& summary, BodyId id) {
  return summary.simulation.world.model().bodies[static_cast<std::size_t>(id.index)].name;
}

std::string cable_lines(const RunSummary& summary) {
  TextTable table({"span", "tension [N]", "length [m]", "rest length [m]"}, 1);
  const bool known = summary.simulation.world.state().steps > 0;
  const std::vector<CableReport> reports = summary.simulation.cable_reports();
  std::size_t count = 0;
  const auto add = [&](std::string name, const SpanReport& span) {
    if (++count > max_rows) return;
    table.add({std::move(name), known ? short_number(span.tension) : "unknown",
               short_number(span.length), short_number(span.rest_length)});
  };
  for (const CableReport& report : reports) {
    std::size_t wrap = 0;
    for (std::size_t k = 0; k < report.spans.size(); ++k) {
      add(fmt::format("{}.{}", report.name, k), report.spans[k]);
      // The spans that begin at a wrap.
      for (; wrap < report.wraps.size() && report.wraps[wrap].after == static_cast<int>(k);
           ++wrap) {
        const WrapReport& on = report.wraps[wrap];
        add(fmt::format("{}, on \"{}\"", report.name, body_name(summary, on.link.body)), on.span);
      }
    }
  }
  if (count == 0) return "";
  return "\n" + table.text() + omitted(count, "spans");
}

/// One line per joint and free coordinate.
std::string joint_lines(const RunSummary& summary) {
  if (summary.joints.empty()) return "";
  TextTable table({"joint", "force [N]", "torque [N m]", "coordinate", "value", "rate", "drive"},
                  1);
  const bool known = summary.simulation.world.state().steps > 0;
  const std::string unknown = "unknown";
  std::size_t lines = 0;
  for (const JointReport& joint : summary.joints) {
    if (++lines > max_rows) break;
    std::vector<std::string> line{joint.name};
    if (joint.broken_at) {
      line.insert(line.end(), {"broken", ""});
    } else {
      line.push_back(known ? short_number(joint.force.norm()) : unknown);
      line.push_back(known ? short_number(joint.torque.norm()) : unknown);
    }
    if (joint.coordinates.empty()) line.insert(line.end(), {"", "", "", ""});
    for (const JointCoordinateReport& coordinate : joint.coordinates) {
      if (line.empty()) line.assign({"", "", ""});
      const std::string_view unit = coordinate.angle ? "rad" : "m";
      line.push_back(fmt::format("{} [{}]", coordinate.name, unit));
      line.push_back(short_number(coordinate.value));
      line.push_back(short_number(coordinate.rate));
      line.push_back(known ? short_number(coordinate.drive_force) : unknown);
      table.add(std::exchange(line, {}));
    }
    if (!line.empty()) table.add(std::move(line));
  }
  return "\n" + table.text() + omitted(summary.joints.size(), "joints");
}

std::string event_lines(const RunSummary& summary) {
  if (summary.events.empty()) return "";
  TextTable table({"time [s]", "subject", "body", "event"}, 4);
  for (std::size_t i = 0; i < std::min(summary.events.size(), max_events); ++i) {
    const RunEvent& event = summary.events[i];
    const std::string body =
        event.source != RunEvent::Source::cable || !event.body.empty() ? event.body : "world";
    table.add({short_number(event.time), event.subject, body, std::string(event.kind)});
  }
  return "\n" + table.text() + omitted(summary.events.size(), "events", max_events);
}

std::string invariants(const RunSummary& summary) {
  const RunMonitor& monitor = summary.monitor;
  TextTable energy({"energy [J]", "start", "end", "largest drift"}, 1);
  const auto joules = [](double value) {
    return std::isfinite(value) ? short_number(value) : std::string("not finite");
  };
  energy.add({"total", joules(monitor.initial_energy().total()),
              joules(monitor.final_energy().total()), joules(monitor.max_energy_drift())});
  std::string text = "\n" + energy.text();
  text += fmt::format("  the integrator took {} J of {} J\n",
                      short_number(monitor.integrator_loss()), short_number(monitor.energy_flow()));
  const std::vector<CableReport> reports = summary.simulation.cable_reports();
  double creep = 0.0;
  double sheaths = 0.0;
  double hysteresis = 0.0;
  double floors = 0.0;
  for (const CableReport& report : reports) {
    creep += report.creep_loss;
    sheaths += report.sheath_loss;
    hysteresis += report.hysteresis_loss;
    floors += report.floor_loss;
  }
  // A smaller loss explains no digit of the energies above.
  if (creep > 1e-6 * monitor.energy_flow()) {
    text += fmt::format("  the creep of ropes over wheels took {} J\n", short_number(creep));
  }
  if (sheaths > 1e-6 * monitor.energy_flow()) {
    text += fmt::format("  the friction of ropes in sheaths took {} J\n", short_number(sheaths));
  }
  if (floors > 1e-6 * monitor.energy_flow()) {
    text += fmt::format("  the friction of ropes on floors took {} J\n", short_number(floors));
  }
  if (hysteresis > 1e-6 * monitor.energy_flow()) {
    text += fmt::format("  the stretching of ropes took {} J by their tables\n",
                        short_number(hysteresis));
  }
  if (reports.empty()) return text;
  TextTable lengths({"cable", "length [m]", "relative error", "largest stretch"}, 1);
  for (std::size_t i = 0; i < std::min(reports.size(), max_rows); ++i) {
    const auto& cable = monitor.cables()[i];
    // The column for a rigid cable is its error, for an elastic one its strain.
    lengths.add({std::string(reports[i].name), short_number(reports[i].total_length),
                 short_number(cable.length_error),
                 short_number(std::max(cable.max_stretch, cable.max_strain))});
  }
  return text + "\n" + lengths.text() + omitted(reports.size(), "cables");
}

}  // namespace

std::string checks_text(const std::vector<CheckResult>& checks) {
  std::string text;
  for (const CheckResult& check : checks) {
    text += fmt::format("  {}  {}{}{}\n", check.passed ? "ok  " : "FAIL", check.message,
                        check.check.because.empty() ? "" : "; ", check.check.because);
  }
  const auto passed = std::count_if(checks.begin(), checks.end(),
                                    [](const CheckResult& check) { return check.passed; });
  return text + fmt::format("  {} of {} checks passed\n", passed, checks.size());
}

std::string to_text(const RunSummary& summary) {
  std::string text = head(summary) + body_lines(summary.simulation.world) + cable_lines(summary) +
                     joint_lines(summary) + event_lines(summary) + invariants(summary);
  text += "\n" + certificate_text(summary.outcome.certificate, summary.trust) + "\n";
  if (summary.error_estimate) text += "\n" + error_estimate_text(*summary.error_estimate);
  if (!summary.ropes.empty()) text += "\n" + wear_text(summary.ropes);
  if (summary.checked) text += "\n" + checks_text(summary.checks);
  return text;
}

}  // namespace sheave::command
