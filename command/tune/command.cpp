// sheave tune: the settings of a scene that make a measure least, greatest or equal to a number.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/share.h"
#include "command/sweep/row_run.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "command/tune/tune.h"

namespace sheave::command {
namespace {

struct TuneArguments {
  TuneOptions tune;
  std::vector<std::string> axes, keeps;
  std::string of, minimise, maximise, target, method, tolerance, trust;
  std::string out, csv, chart;
  bool json = false;
  bool strict = false;
};

const std::vector<std::string> tuned_kinds{sweep_kind_names.begin(), sweep_kind_names.end()};
const std::vector<std::string> method_names{tune_method_names.begin(), tune_method_names.end()};

/// The index of a word in a list that has been checked; 0 for an empty one.
std::size_t index_of(const std::vector<std::string>& words, const std::string& word) {
  const auto found = std::find(words.begin(), words.end(), word);
  return found == words.end() ? 0 : static_cast<std::size_t>(found - words.begin());
}

void read_goal(const TuneArguments& arguments, TuneOptions& options) {
  const int goals = (arguments.minimise.empty() ? 0 : 1) + (arguments.maximise.empty() ? 0 : 1) +
                    (arguments.target.empty() ? 0 : 1);
  if (goals != 1) {
    throw Failure(ExitCode::usage,
                  "a tune needs one goal: --minimise MEASURE, --maximise MEASURE or --target "
                  "'MEASURE = VALUE'");
  }
  SweepMeasure measure;
  const SweepKind kind = options.rows.kind;
  if (!arguments.target.empty()) {
    options.goal = parse_target(arguments.target, kind, measure);
  } else if (!arguments.maximise.empty()) {
    options.goal.sense = TuneGoal::Sense::maximise;
    measure = parse_measure(arguments.maximise, kind, "--maximise");
  } else {
    measure = parse_measure(arguments.minimise, kind, "--minimise");
  }
  options.rows.measures.push_back(measure);
  for (const std::string& text : arguments.keeps) {
    options.bounds.push_back(parse_bound(text, kind, measure));
    options.rows.measures.push_back(measure);
  }
}

TuneOptions read_options(const TuneArguments& arguments) {
  TuneOptions options = arguments.tune;
  SweepOptions& rows = options.rows;
  rows.kind = static_cast<SweepKind>(index_of(tuned_kinds, arguments.of));
  if (rows.kind != SweepKind::run && !arguments.trust.empty()) {
    throw Failure(ExitCode::usage,
                  fmt::format("--trust is for runs (--of run), not for --of {}", arguments.of));
  }
  for (const std::string& text : arguments.axes) rows.plan.axes.push_back(parse_axis(text));
  read_goal(arguments, options);
  if (!arguments.method.empty()) {
    options.method = static_cast<TuneMethod>(index_of(method_names, arguments.method));
  }
  if (!arguments.trust.empty()) rows.trust = positive_share("--trust", arguments.trust);
  if (!arguments.tolerance.empty()) {
    options.tolerance = positive_share("--tolerance", arguments.tolerance);
    if (options.tolerance < least_tune_tolerance || options.tolerance > 0.1) {
      throw Failure(ExitCode::usage, fmt::format("--tolerance {}: must be from 1e-8 to 0.1 (10%)",
                                                 arguments.tolerance));
    }
  }
  return options;
}

void check_outputs(const TuneArguments& arguments) {
  const SweepOptions& rows = arguments.tune.rows;
  if (!arguments.chart.empty()) static_cast<void>(chart_format(arguments.chart));
  if (arguments.out == "-") {
    throw Failure(ExitCode::usage, "-o -: standard output has the result; name a file");
  }
  if (arguments.json && arguments.csv == "-") {
    throw Failure(ExitCode::usage, "--json and --csv - would both write to standard output");
  }
  check_paths({{"the scene", rows.scene.path}, {"--load-state", rows.scene.load_state}},
              {{"--resume", rows.journal},
               {"-o", arguments.out},
               {"--csv", arguments.csv},
               {"--chart", arguments.chart}},
              arguments.csv != "-");
}

ExitCode code_of(TuneEnd end, bool strict) {
  if (end == TuneEnd::violated || end == TuneEnd::no_result) return ExitCode::check_failed;
  return strict && end != TuneEnd::converged ? ExitCode::doubtful : ExitCode::done;
}

ExitCode tune(const TuneArguments& arguments) {
  TuneOptions options = read_options(arguments);
  check_outputs(arguments);
  catch_interrupts();
  const TuneResult result = run_tune(options);
  const ExitCode code = code_of(result.end, arguments.strict);
  OutputFaults faults;
  faults.attempt([&] {
    if (arguments.csv == "-") {
      print(sweep_csv(result.table));
    } else {
      print(arguments.json ? showable_json(tune_json(options, result))
                           : printable(tune_text(options, result)));
    }
  });
  if (!arguments.csv.empty() && arguments.csv != "-") {
    faults.attempt([&] { write_file(arguments.csv, sweep_csv(result.table)); });
  }
  if (!arguments.chart.empty()) {
    faults.attempt([&] {
      draw_with_gnuplot(arguments.chart,
                        tune_chart_script(options, result, chart_format(arguments.chart)));
    });
  }
  if (!arguments.out.empty()) {
    if (code == ExitCode::check_failed) {
      print_warning(arguments.out + ": is not written, because no run is a solution");
    } else {
      faults.attempt([&] {
        const SweepRow& best = result.table.rows[*result.best];
        write_file(arguments.out, write_scene(load(with_values(options.rows, best.values))));
      });
    }
  }
  return faults.report(code);
}

void add_task(CLI::App& app, TuneArguments& arguments) {
  const char* const group = "Settings, goal and bounds";
  app.add_option("--vary", arguments.axes,
                 "a setting (/json/pointer) or a parameter of the scene and its range; with :log "
                 "the search is in its logarithm; may be repeated")
      ->group(group)
      ->option_text("NAME=LOW:HIGH")
      ->expected(1)
      ->take_all()
      ->required();
  app.add_option("--start", arguments.tune.starts,
                 "where the search starts; default: the middle of each range; may be repeated")
      ->group(group)
      ->option_text("NAME=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--of", arguments.of,
                 "run (default), statics: the equilibrium, or modes: its vibrations, too")
      ->check(CLI::IsMember(tuned_kinds))
      ->group(group)
      ->option_text("KIND");
  app.add_option("--minimise", arguments.minimise, "the measure to make least, as in sheave sweep")
      ->group(group)
      ->option_text("MEASURE");
  app.add_option("--maximise", arguments.maximise, "the measure to make greatest")
      ->group(group)
      ->option_text("MEASURE");
  app.add_option("--target", arguments.target, "the measure that is to have a value")
      ->group(group)
      ->option_text("'MEASURE = VALUE'");
  app.add_option("--keep", arguments.keeps,
                 "a bound of a measure, with < or >, which the result must keep; may be repeated")
      ->group(group)
      ->option_text("'MEASURE < VALUE'")
      ->expected(1)
      ->take_all();
}

void add_search(CLI::App& app, TuneArguments& arguments) {
  const char* const group = "Search";
  app.add_option(
         "--method", arguments.method,
         "cobyla: local, keeps bounds; bobyqa: local, exacter for two or more settings "
         "without --keep; direct: the whole range with half of the runs, then one of these. "
         "Default: bobyqa where it is possible, else cobyla")
      ->check(CLI::IsMember(method_names))
      ->group(group)
      ->option_text("NAME");
  app.add_option("--runs", arguments.tune.most_runs, "largest number of runs; default 200")
      ->check(CLI::Range(std::size_t{1}, most_tune_runs))
      ->group(group)
      ->option_text("N");
  app.add_option("--tolerance", arguments.tolerance,
                 "ends when no setting changes by more than this part of its range; default 0.01%")
      ->group(group)
      ->option_text("SHARE");
  app.add_option("--resume", arguments.tune.rows.journal,
                 "write each run to this file as soon as it has ended, and resume from the file")
      ->group(group)
      ->option_text("FILE");
  app.add_option("--trust", arguments.trust,
                 "largest relative error of a clean certificate, as in sheave run; default: 1%")
      ->group(group)
      ->option_text("SHARE");
}

}  // namespace

Action declare_tune(CLI::App& app) {
  auto arguments = std::make_shared<TuneArguments>();
  // Before the options of the scene, which leave out their own --tolerance then.
  add_search(app, *arguments);
  add_scene_options(app, arguments->tune.rows.scene);
  add_task(app, *arguments);
  app.add_option("-o,--out", arguments->out, "write the best scene")->option_text("FILE");
  app.add_option("--csv", arguments->csv, "write a line per run; - is standard output")
      ->option_text("FILE");
  app.add_option("--chart", arguments->chart,
                 "draw the goal and the settings over the runs with gnuplot: .png, .svg or .pdf")
      ->option_text("FILE");
  app.add_flag("--json", arguments->json, "print one JSON object instead of the text");
  app.add_flag("--strict", arguments->strict, "exit code 76 unless the search has converged");
  app.add_flag("-q,--quiet", arguments->tune.rows.quiet, "no progress");
  app.footer(R"(Examples:
  sheave tune crane.json --of statics --vary /bodies/hook/mass=500:8000 \
      --target 'max:luff cable.tension = 40e3' -o best.json
  sheave tune hoist.json --of modes --vary /cables/rope/axial_stiffness=1e5:1e8:log \
      --target 'frequency:1 = 2.5'
  sheave tune tower.jsonnet --vary boom=20:40 --vary counterweight=5e3:5e4 --maximise load.x \
      --keep 'max:hoist cable.0.tension < 5e4' --method direct --runs 400 --resume tower.tune

A run that is not done, or whose certificate is not clean, counts as worse than all others. Exit
codes: 0 done, 1 no run keeps all bounds, 2 wrong usage, 65 bad scene, 75 the start has no result,
130 interrupted; with --strict 76 if the search has not converged.)");
  return [arguments] { return tune(*arguments); };
}

}  // namespace sheave::command
