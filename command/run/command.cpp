// sheave run: simulate a scene, write tables, print a summary.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/plot/data.h"
#include "command/registry.h"
#include "command/run/files.h"
#include "command/run/player.h"
#include "command/run/rope_files.h"
#include "command/run/summary.h"
#include "command/scene_options.h"
#include "command/share.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "engine/field_check.h"
#include "measure/error_estimate.h"
#include "measure/stress_judge.h"
#include "scenes/start_warnings.h"

namespace sheave::command {
namespace {

struct RunOptions {
  SceneOptions scene;
  RecordOptions record;
  std::optional<std::int64_t> steps;
  std::optional<double> time_limit;  // [s]
  std::string save_state;
  bool json = false;
  bool check = false;
  bool quiet = false;
  bool estimate_error = false;
  std::string trust;
  bool strict = false;
  PlotChoice plot;
  std::string plot_file = "plot.png";
  RopeOptions ropes;
};

std::vector<Warning> early_warnings(const RunOptions& options, const Scene& scene,
                                    const Simulation& simulation, std::int64_t last_step) {
  std::vector<Warning> warnings = magnitude_warnings(scene);
  const double end = static_cast<double>(last_step) * scene.model.step.dt;
  if (!options.steps && std::abs(end - scene.duration) > 1e-9 * scene.duration) {
    warnings.push_back(
        {"duration", "duration",
         fmt::format("the duration {} s is not a multiple of dt; the run ends at {} s",
                     number_text(scene.duration), number_text(end))});
  }
  if (!options.steps && simulation.world.state().steps >= last_step) {
    warnings.push_back({"nothing_to_do", "duration",
                        fmt::format("the loaded state is at {} s, and the run ends then or before; "
                                    "a longer --duration continues it",
                                    number_text(simulation.world.state().time))});
  }
  if (options.check && scene.checks.empty()) {
    warnings.push_back(
        {"no_checks", "checks",
         "the scene has no checks, so --check cannot fail; add \"checks\" to the scene"});
  }
  std::ranges::move(start_warnings(scene), std::back_inserter(warnings));
  return warnings;
}

ExitCode exit_code_of(const RunSummary& summary, bool strict) {
  switch (summary.outcome.status) {
    case RunStatus::diverged:
      return ExitCode::diverged;
    case RunStatus::interrupted:
      return ExitCode::interrupted;
    case RunStatus::time_limit:
      return ExitCode::time_limit;
    case RunStatus::done:
      break;
  }
  if (!summary.checks_passed()) return ExitCode::check_failed;
  return strict && summary.doubtful() ? ExitCode::doubtful : ExitCode::done;
}

/// Reports on standard error why a run ended early, and which output remains.
void explain_early_end(const RunOptions& options, const RunSummary& summary) {
  if (summary.outcome.status == RunStatus::done) return;
  std::string text = summary.outcome.divergence
                         ? "diverged: " + summary.outcome.divergence->message
                         : fmt::format("{} at {} s", name_of(summary.outcome.status),
                                       number_text(summary.simulation.world.state().time));
  for (const OutputSummary& table : summary.outputs) {
    if (table.kind != OutputSummary::Kind::table || !table.fault.empty()) continue;
    text += fmt::format("\n{}: partial, {} rows",
                        table.path == "-" ? "standard output" : table.path, table.rows);
  }
  if (!options.save_state.empty()) {
    text += "\n" + options.save_state +
            (summary.outcome.divergence ? ": not written, because the run diverged"
                                        : ": the state where the run stopped");
  }
  if (summary.outcome.status == RunStatus::diverged) {
    print_error(text);
  } else {
    print_warning(text);
  }
}

bool writes_to_stdout(const RunOptions& options) {
  return std::count(options.record.paths.begin(), options.record.paths.end(), "-") > 0;
}

bool is_summarised(const RunOptions& options) {
  return !options.json && !options.quiet && !writes_to_stdout(options);
}

/// Whether a run is useful even if all its tables fail.
bool has_other_output(const RunOptions& options) {
  return options.json || options.check || is_summarised(options) || !options.save_state.empty() ||
         !options.plot.lists.empty() || options.ropes.wanted();
}

void report(const RunOptions& options, const RunSummary& summary) {
  for (const Warning& warning : summary.warnings) print_warning(warning.message);
  explain_early_end(options, summary);
  const bool summarised = is_summarised(options);
  if (!summary.checks_passed() && !summarised) {
    print_error("checks failed\n" + checks_text(summary.checks));
  }
  if (!summarised && summary.doubtful()) {
    print_warning("doubtful: " + doubt_text(summary.outcome.certificate, summary.trust));
  }
  if (options.json) print(showable_json(to_json(summary)));
  if (summarised) print(printable(to_text(summary)));
}

/// The runs with shorter substeps for the comparison with this run.
std::optional<measure::ErrorEstimator> make_estimator(const RunOptions& options, const Scene& scene,
                                                      const State& start) {
  if (!options.estimate_error) return {};
  Result<measure::ErrorEstimator> estimator = measure::ErrorEstimator::create(scene, start);
  if (!estimator)
    throw Failure(ExitCode::usage, "--estimate-error: " + to_text(estimator.errors()));
  return std::move(estimator).value();
}

/// Whether the time limit, counted from now, is over; empty without a limit.
StopRequest limit_of(const RunOptions& options) {
  if (!options.time_limit) return {};
  using Clock = std::chrono::steady_clock;
  return [start = Clock::now(), limit = *options.time_limit] {
    return std::chrono::duration<double>(Clock::now() - start).count() >= limit;
  };
}

/// Reports an infinite energy: positions and speeds may be finite although their products are not.
void tell_infinite_energy(const Simulation& simulation, RunOutcome& outcome) {
  const double time = simulation.world.state().time;
  outcome.status = RunStatus::diverged;
  outcome.divergence = Divergence{
      BodyId::world(), time,
      fmt::format("the energy is not finite at time {} s; the scene's numbers are too large",
                  number_text(time)),
      "energy"};
}

void check_run_paths(const RunOptions& options) {
  std::vector<NamedPath> outputs;
  for (const std::string& path : options.record.paths) outputs.push_back({"--out", path});
  outputs.push_back({"--save-state", options.save_state});
  if (!options.plot.lists.empty()) {
    static_cast<void>(chart_format(options.plot_file));
    outputs.push_back({"--plot-file", options.plot_file});
  }
  std::vector<NamedPath> inputs{{"the scene", options.scene.path},
                                {"--load-state", options.scene.load_state}};
  check_rope_options(options.ropes, inputs, outputs);
  check_paths(inputs, outputs, options.json || is_summarised(options));
}

/// The title of the chart.
std::string scene_title(const RunSummary& summary) {
  return summary.scene.name.empty() ? std::string(summary.scene_path) : summary.scene.name;
}

void draw(const RunOptions& options, const PlotRun& run) {
  draw_with_gnuplot(options.plot_file,
                    plot_script({run}, run.label, chart_format(options.plot_file)));
  if (!options.quiet) print_note(options.plot_file + ": drawn");
}

std::int64_t last_step_of(const RunOptions& options, const Scene& scene,
                          const Simulation& simulation) {
  return options.steps ? simulation.world.state().steps + *options.steps : step_count(scene);
}

double trust_of(const RunOptions& options) {
  return options.trust.empty() ? default_trust : positive_share("--trust", options.trust);
}

/// Nothing without --plot.
std::optional<PlotRecorder> make_plot(const RunOptions& options, const Simulation& simulation) {
  if (options.plot.lists.empty()) return {};
  return std::make_optional<PlotRecorder>(simulation, options.plot);
}

void draw_plot(const RunOptions& options, const PlotRecorder& plot, const RunSummary& summary) {
  draw(options, plot.run(scene_title(summary), summary.simulation));
}

/// Nothing without --check. Throws if a check asks for values before the run begins.
std::optional<CheckRecorder> make_checks(const RunOptions& options, const Scene& scene,
                                         const Simulation& simulation) {
  if (!options.check) return {};
  const double start = simulation.world.state().time;
  for (const CheckDef& check : scene.checks) {
    const double first = check.statistic == Statistic::at ? check.at.value_or(scene.duration)
                                                          : check.from.value_or(0.0);
    if (first >= start) continue;
    throw Failure(ExitCode::usage,
                  fmt::format("--check: the check of {} begins at {} s, but the saved state is of "
                              "{} s; let the check begin later, or run from the start",
                              check.quantity, number_text(first), number_text(start)));
  }
  return std::make_optional<CheckRecorder>(scene, simulation);
}

bool has_life(const RunOptions& options) { return !options.ropes.life.empty(); }

/// Nothing if no history is kept.
std::vector<measure::CableHistory> ropes_of(const std::optional<measure::RopeHistory>& ropes) {
  return ropes ? ropes->history() : std::vector<measure::CableHistory>{};
}

void append(std::vector<Warning> more, std::vector<Warning>& warnings) {
  std::ranges::move(more, std::back_inserter(warnings));
}

/// Shows the state to those that record it.
void record(const Simulation& simulation, std::optional<CheckRecorder>& checks,
            std::optional<PlotRecorder>& plot, std::optional<measure::RopeHistory>& ropes) {
  if (checks) checks->record(simulation);
  if (plot) plot->observe(simulation);
  if (ropes) ropes->observe(simulation);
}

/// Called at each step's end, if there is an estimate; otherwise empty.
std::function<void()> look_of(std::optional<measure::ErrorEstimator>& estimator,
                              const Simulation& simulation) {
  if (!estimator) return {};
  return [&] { estimator->look(simulation); };
}

Scene load_for_run(SceneOptions source) {
  source.tells_strains = false;  // the summary does
  return load(source);
}

ExitCode run(const RunOptions& options) {
  check_run_paths(options);
  const double trust = trust_of(options);
  const StopRequest time_is_over = limit_of(options);
  const Scene scene = load_for_run(options.scene);
  Simulation simulation = make_simulation(scene);
  const std::int64_t last_step = last_step_of(options, scene, simulation);
  std::vector<Warning> warnings = early_warnings(options, scene, simulation, last_step);
  std::optional<measure::ErrorEstimator> estimator =
      make_estimator(options, scene, simulation.world.state());
  const std::int64_t first_step = simulation.world.state().steps;
  catch_interrupts();
  RunFiles files(options.record, options.save_state, has_other_output(options), simulation);
  RunMonitor monitor(last_step - simulation.world.state().steps);
  std::optional<measure::RopeHistory> ropes = watch_ropes(options.ropes);
  std::optional<CheckRecorder> checks = make_checks(options, scene, simulation);
  std::optional<PlotRecorder> plot = make_plot(options, simulation);
  Progress progress("run", static_cast<double>(simulation.world.state().steps),
                    static_cast<double>(last_step), options.quiet);
  const auto observe = [&](const RunStatistics& so_far) {
    monitor.observe(simulation, so_far);
    if (!monitor.is_finite()) return false;
    const bool wanted = files.observe(simulation, progress);
    record(simulation, checks, plot, ropes);
    const auto ends = [&] { return interrupted() || (time_is_over && time_is_over()); };
    const bool stepped = simulation.world.state().steps > first_step;
    if (estimator && stepped) estimator->observe(simulation, ends);
    return wanted;
  };
  const auto look = look_of(estimator, simulation);
  RunOutcome outcome = files.keep_on_throw(
      [&] { return simulate(simulation, last_step, progress, observe, time_is_over, look); });
  progress.clear();
  if (!monitor.is_finite()) tell_infinite_energy(simulation, outcome);
  monitor.finish(simulation, outcome.statistics, measure::is_conservative(scene));
  files.finish(simulation.world.state(), outcome.status);
  const std::vector<measure::CableHistory> histories = ropes_of(ropes);
  append(collect_warnings(scene, simulation, outcome.statistics, monitor), warnings);
  if (has_life(options)) append(wear_warnings(histories), warnings);
  std::vector<JointReport> joints = joint_reports(simulation.world);
  std::vector<RunEvent> events = collect_events(simulation, joints);
  const RunSummary summary{options.scene.path,
                           scene,
                           simulation,
                           monitor,
                           outcome,
                           std::move(joints),
                           std::move(events),
                           std::move(warnings),
                           options.check,
                           checks ? checks->results() : std::vector<CheckResult>{},
                           estimator ? std::optional(estimator->estimate()) : std::nullopt,
                           trust,
                           files.summary(),
                           has_life(options) ? most_worn(histories) : std::vector<RopeWear>{}};
  if (ropes) write_rope_files(options.ropes, histories, scene_title(summary), files.faults());
  files.faults().attempt([&] { report(options, summary); });
  if (plot) files.faults().attempt([&] { draw_plot(options, *plot, summary); });
  return files.faults().report(exit_code_of(summary, options.strict));
}

void add_output_options(CLI::App& app, RunOptions& options) {
  CLI::Option* out = app.add_option("-o,--out", options.record.paths,
                                    "write all quantities over time to a .csv or .npy file, or as "
                                    "CSV to standard output (-); may be repeated");
  out->option_text("FILE")->expected(1)->take_all();
  app.add_option("--every", options.record.every, "write a row every N steps to these files")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53))
      ->option_text("N")
      ->needs(out);
  app.add_option("--columns", options.record.columns,
                 "only these columns of the files, in this order after the time: names, patterns "
                 "with * and ?, and expressions such as hook.x - trolley.x")
      ->option_text("NAME,...")
      ->expected(1)
      ->take_all()
      ->needs(out);
  CLI::Option* const plot =
      app.add_option("--plot", options.plot.lists,
                     "draw these quantities over time: names, patterns with * and ?, and "
                     "expressions; see sheave plot for more")
          ->option_text("NAME,...")
          ->expected(1)
          ->take_all();
  app.add_option("--plot-file", options.plot_file,
                 "file of the picture: .png, .svg or .pdf; default: plot.png")
      ->option_text("FILE")
      ->needs(plot);
  app.add_flag("--json", options.json, "print the summary as one JSON object");
  app.add_flag("--check", options.check,
               "evaluate the checks of the scene; exit code 1 if one fails")
      ->option_text(" ");
  app.add_flag(
      "--estimate-error", options.estimate_error,
      "also run with 2 and 4 times the substeps, or with a quarter and a sixteenth of the "
      "tolerance, estimate the error by the step and its order, and tell how near decisions "
      "were; takes 7 times as "
      "long");
  app.add_option("--trust", options.trust,
                 "call a run doubtful if an item of its certificate has a larger relative error "
                 "than this, e.g. 0.1%; default: 1%")
      ->option_text("SHARE");
  app.add_flag("--strict", options.strict, "exit code 76 if the run is doubtful");
  app.add_flag("-q,--quiet", options.quiet, "print only requested data, warnings and errors");
}

void add_rope_options(CLI::App& app, RunOptions& options) {
  app.add_option("--rope-history", options.ropes.files,
                 "write the history of the ropes: bends over each sheave, tensions and their "
                 "cycles per section, as a .csv table or as JSON with slack and travel on drums, "
                 "too; may be repeated")
      ->option_text("FILE")
      ->expected(1)
      ->take_all();
  app.add_option("--rope-chart", options.ropes.chart,
                 "draw bends and tensions along the ropes: .png, .svg or .pdf")
      ->option_text("FILE");
  app.add_option("--rope-life", options.ropes.life,
                 "sum the damage of the bends by the formulas of this JSON file, and tell the most "
                 "worn section of each rope and how often the run can be repeated")
      ->option_text("FILE");
  app.add_option("--rope-sections", options.ropes.sections,
                 "number of sections of each cable for these options; default 100")
      ->check(CLI::Range(1, 10000))
      ->option_text("N");
  app.add_option("--rope-diameter", options.ropes.diameter,
                 "diameter of the ropes [m], for the ratio D/d of sheave and rope")
      ->check(number_between(1e-9, 1e3))
      ->option_text("D");
}

void add_state_options(CLI::App& app, RunOptions& options) {
  app.add_option("--steps", options.steps, "stop after N steps instead of at the duration")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53))
      ->option_text("N")
      ->excludes(app.get_option("--duration"));
  app.add_option("--time-limit", options.time_limit,
                 "stop after this wall time [s], even within a step, and keep the results up to "
                 "then; exit code 124")
      ->check(number_between(0.0, std::numeric_limits<double>::max()))
      ->option_text("SECONDS");
  app.add_option("--save-state", options.save_state, "write the final state to a file")
      ->option_text("FILE");
}

}  // namespace

Action declare_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  add_scene_options(app, options->scene);
  add_output_options(app, *options);
  add_rope_options(app, *options);
  add_state_options(app, *options);
  app.footer(R"(Examples:
  sheave run scenes/paper/simple.json
  sheave run crane.json --dt 0.001 --set /bodies/0/mass=2.5 --out crane.csv --every 10
  sheave run crane.json --json | jq .cables[0].spans[0].tension
  sheave run crane.json --columns 't,*.tension' --out crane.npy
  sheave run crane.json --steps 1000 --save-state half.state
  sheave run crane.json --load-state half.state
  sheave run crane.json --from-rest
  sheave run crane.json --estimate-error

The columns of the files, and the names that checks use, are
  t                                               time [s]
  <body>.x .y .z .qw .qx .qy .qz                  pose of the body frame [m]
  <body>.vx .vy .vz .wx .wy .wz .angle            velocity [m/s, rad/s], angle turned [rad]
  <cable>.<span>.tension .length .rest_length     [N, m, m]; spans count from 0
  <cable>.link<k>.stored_length .wrap_angle       cable on a link [m], as an angle [rad]
  <cable>.link<k>.slip                            cable that has slid over it, forwards [m]
  <cable>.link<k>.entry_x ... .exit_z             where the cable meets and leaves the body [m]
  <cable>.length_error                            relative error of the length invariant
  energy.kinetic .potential .elastic .total       [J]
Tensions at time 0 are unknown, and their cells are empty.

Exit codes: 0 done, 1 a check failed, 2 wrong usage, 65 bad scene, 66 no such file, 70 internal
error, 74 input or output failed (whatever else happened), 75 diverged, 76 doubtful
(with --strict), 124 time limit, 130 interrupted. After 74, 75, 124 and 130 the output so far
is kept, whole rows only, and outputs that did not fail are whole. A signal (Ctrl-C) ends the run
within the step; a third one ends the command at once.)");
  return [options] {
    if (options->json && writes_to_stdout(*options)) {
      throw Failure(ExitCode::usage, "--json and --out - would both write to standard output");
    }
    return run(*options);
  };
}

}  // namespace sheave::command
