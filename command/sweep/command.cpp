// sheave sweep and sheave merge: many runs of one scene and their results.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/input/load_cases.h"
#include "command/interrupt.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/share.h"
#include "command/sweep/journal.h"
#include "command/sweep/run.h"
#include "command/terminal.h"
#include "command/text/one_line.h"

namespace sheave::command {
namespace {

/// The destination of a table.
struct SweepOutputs {
  std::string csv, chart;
  bool json = false;
  bool strict = false;
};

struct SweepArguments {
  SweepOptions sweep;
  std::vector<std::string> axes, measures;
  CaseOptions cases;
  std::string of, design, shard, trust;
  SweepOutputs outputs;
};

struct MergeArguments {
  std::vector<std::string> journals;
  SweepOutputs outputs;
};

const std::vector<std::string> kind_names{sweep_kind_names.begin(), sweep_kind_names.end()};
const std::vector<std::string> design_names{"grid", "list", "random", "latin-hypercube"};

SweepKind sweep_kind(const std::string& word) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), word);
  return found == kind_names.end() ? SweepKind::run
                                   : static_cast<SweepKind>(found - kind_names.begin());
}

ExitCode write_outputs(const SweepOutputs& outputs, const SweepTable& table) {
  OutputFaults faults;
  faults.attempt([&] {
    if (outputs.csv == "-") {
      print(sweep_csv(table));
    } else {
      print(outputs.json ? showable_json(sweep_json(table)) : printable(sweep_text(table)));
    }
  });
  if (!outputs.csv.empty() && outputs.csv != "-") {
    faults.attempt([&] { write_file(outputs.csv, sweep_csv(table)); });
  }
  if (!outputs.chart.empty()) {
    faults.attempt([&] {
      draw_with_gnuplot(outputs.chart, sweep_chart_script(table, chart_format(outputs.chart)));
    });
  }
  const bool all_done = std::all_of(table.rows.begin(), table.rows.end(), [](const SweepRow& row) {
    return row.status == SweepStatus::done;
  });
  return faults.report(outputs.strict && !all_done ? ExitCode::doubtful : ExitCode::done);
}

void check_outputs(const SweepOutputs& outputs, const std::vector<NamedPath>& inputs,
                   const std::string& journal) {
  if (!outputs.chart.empty()) static_cast<void>(chart_format(outputs.chart));
  if (outputs.json && outputs.csv == "-") {
    throw Failure(ExitCode::usage, "--json and --csv - would both write to standard output");
  }
  check_paths(inputs, {{"--resume", journal}, {"--csv", outputs.csv}, {"--chart", outputs.chart}},
              outputs.csv != "-");
}

ExitCode run_and_tell(const SweepArguments& arguments) {
  SweepOptions options = arguments.sweep;
  check_outputs(arguments.outputs,
                {{"the scene", options.scene.path},
                 {"--load-state", options.scene.load_state},
                 {"--cases", arguments.cases.table}},
                options.journal);
  options.kind = sweep_kind(arguments.of);
  if (options.kind != SweepKind::run && (options.time_limit || !arguments.trust.empty())) {
    throw Failure(ExitCode::usage,
                  fmt::format("{} is for runs (--of run), not for --of {}",
                              options.time_limit ? "--time-limit" : "--trust", arguments.of));
  }
  if (!arguments.cases.empty()) {
    options.plan.axes.push_back(case_axis(load_cases(arguments.cases)));
  }
  for (const std::string& text : arguments.axes) options.plan.axes.push_back(parse_axis(text));
  for (const std::string& text : arguments.measures) {
    options.measures.push_back(parse_measure(text, options.kind));
  }
  const auto design = std::find(design_names.begin(), design_names.end(), arguments.design);
  if (design != design_names.end()) {
    options.plan.design = static_cast<SweepDesign>(design - design_names.begin());
  }
  if (!arguments.shard.empty()) options.shard = parse_shard(arguments.shard);
  if (!arguments.trust.empty()) options.trust = positive_share("--trust", arguments.trust);
  catch_interrupts();
  return write_outputs(arguments.outputs, run_sweep(std::move(options)));
}

/// The rows of all shards. A Failure (65) if the shards are of different sweeps or incomplete.
SweepTable merged(const std::vector<std::string>& paths) {
  SweepTable all = read_sweep_journal(paths.front());
  if (all.head.tune) {
    throw Failure(ExitCode::bad_scene,
                  paths.front() + ": is the journal of a tune, which has no parts to merge");
  }
  all.head.shard = {};
  std::vector<const std::string*> from(all.head.runs, nullptr);
  for (const SweepRow& row : all.rows) from[row.run] = &paths.front();
  for (std::size_t i = 1; i < paths.size(); ++i) {
    SweepTable part = read_sweep_journal(paths[i]);
    if (part.head.kind != all.head.kind) {
      throw Failure(
          ExitCode::bad_scene,
          fmt::format("{} is of {}, and {} of {}: rows of one kind alone can be merged",
                      paths.front(), task_text(all.head), paths[i], task_text(part.head)));
    }
    if (part.head.key != all.head.key || part.head.runs != all.head.runs) {
      throw Failure(
          ExitCode::bad_scene,
          fmt::format("{} and {} belong to different sweeps: another scene, plan, measure "
                      "or build of the program",
                      paths.front(), paths[i]));
    }
    for (SweepRow& row : part.rows) {
      if (from[row.run] != nullptr) {
        throw Failure(ExitCode::bad_scene,
                      fmt::format("run {} is in {} and in {}", row.run, *from[row.run], paths[i]));
      }
      from[row.run] = &paths[i];
      all.rows.push_back(std::move(row));
    }
  }
  std::sort(all.rows.begin(), all.rows.end(),
            [](const SweepRow& a, const SweepRow& b) { return a.run < b.run; });
  if (all.rows.size() < all.head.runs) {
    const auto gap = std::find(from.begin(), from.end(), nullptr);
    print_warning(
        fmt::format("{} of {} runs are missing, the first of them run {}; their shards "
                    "are not done",
                    all.head.runs - all.rows.size(), all.head.runs, gap - from.begin()));
  }
  return all;
}

ExitCode merge(const MergeArguments& arguments) {
  std::vector<NamedPath> inputs;
  for (const std::string& path : arguments.journals) inputs.push_back({"the journal", path});
  check_outputs(arguments.outputs, inputs, "");
  const SweepTable table = merged(arguments.journals);
  const ExitCode code = write_outputs(arguments.outputs, table);
  if (code != ExitCode::done || table.rows.size() == table.head.runs) return code;
  return ExitCode::check_failed;
}

void add_outputs(CLI::App& app, SweepOutputs& outputs) {
  app.add_option("--csv", outputs.csv, "write a line per run; - is standard output")
      ->option_text("FILE");
  app.add_option("--chart", outputs.chart,
                 "draw the measures over the varied settings with gnuplot: .png, .svg or .pdf; for "
                 "two settings a heat map")
      ->option_text("FILE");
  app.add_flag("--json", outputs.json, "print one JSON object instead of the text");
  app.add_flag("--strict", outputs.strict,
               "exit code 76 unless all runs are done and not doubtful");
}

void add_plan(CLI::App& app, SweepArguments& arguments) {
  SweepOptions& sweep = arguments.sweep;
  const char* const group = "Variation and measures";
  app.add_option("--vary", arguments.axes,
                 "a setting (/json/pointer) or a parameter of the scene: a list 1,2,4, or "
                 "LOW:HIGH:COUNT values, both ends included, or LOW:HIGH to draw from; with :log "
                 "after it in equal steps of the logarithm; may be repeated")
      ->group(group)
      ->option_text("NAME=VALUES")
      ->expected(1)
      ->take_all();
  add_case_options(app, arguments.cases);
  app.add_option("--of", arguments.of,
                 "run (default), statics: the equilibrium of each, or modes: its vibrations, too")
      ->check(CLI::IsMember(kind_names))
      ->group(group)
      ->option_text("KIND");
  app.add_option(
         "--measure", arguments.measures,
         "a number of each run: [STATISTIC:]QUANTITY[@TIME or @FROM:TO] with min, max, mean, "
         "range, rate, drift, integral or at (default, the value at the end); QUANTITY may be an "
         "expression; at rest: QUANTITY, max:CABLE.tension, eigenvalue:N, unstable_motions, "
         "neutral_motions; of modes also frequency:N and damping:N; may be repeated")
      ->group(group)
      ->option_text("MEASURE")
      ->expected(1)
      ->take_all()
      ->required();
  app.add_option("--design", arguments.design,
                 "grid (default): every value with every other; list: the first values of all, "
                 "then the second ones; random; latin-hypercube: each range cut into as many parts "
                 "as there are runs, each part drawn from once")
      ->check(CLI::IsMember(design_names))
      ->group(group)
      ->option_text("NAME");
  app.add_option("--samples", sweep.plan.samples, "number of runs of random and latin-hypercube")
      ->check(CLI::Range(std::size_t{1}, most_sweep_runs))
      ->group(group)
      ->option_text("N");
  app.add_option("--seed", sweep.plan.seed, "seed of random and latin-hypercube; default: 1")
      ->group(group)
      ->option_text("N");
}

}  // namespace

Action declare_sweep(CLI::App& app) {
  auto arguments = std::make_shared<SweepArguments>();
  SweepOptions& options = arguments->sweep;
  add_plan(app, *arguments);
  add_scene_options(app, options.scene);
  app.add_option("--parallel", options.threads,
                 "number of runs at the same time; default: one per core")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  app.add_option("--resume", options.journal,
                 "write each run to this file as soon as it has ended, and resume from the file")
      ->option_text("FILE");
  app.add_option("--shard", arguments->shard,
                 "do only this part of the runs, e.g. 2/8; sheave merge merges the parts")
      ->option_text("I/N")
      ->needs(app.get_option("--resume"));
  app.add_option("--time-limit", options.time_limit,
                 "stop a run after this wall time [s]; the machine decides which runs reach it")
      ->check(number_between(0.0, 1e9))
      ->option_text("SECONDS");
  app.add_option("--trust", arguments->trust,
                 "largest relative error of a clean certificate, as in sheave run; default: 1%")
      ->option_text("SHARE");
  app.add_flag("-q,--quiet", options.quiet, "no progress");
  add_outputs(app, arguments->outputs);
  app.footer(R"(Examples:
  sheave sweep crane.json --vary /bodies/hook/mass=500:5000:10 --measure 'max:hoist cable.0.tension'
  sheave sweep crane.jsonnet --vary load=50:500:10 --vary parts=2,4,8 \
      --measure max:rope.0.tension --chart crane.png --csv crane.csv
  sheave sweep crane.json --vary /bodies/hook/mass=500:5000:log --vary /step/dt=0.001:0.02:log \
      --design latin-hypercube --samples 200 \
      --measure 'max:hoist cable.0.tension' --resume crane.sweep
  sheave sweep crane.json --of modes --vary /bodies/hook/mass=500:5000:10 --measure frequency:1
  sheave sweep crane.jsonnet --of statics --cases loads.csv --measure 'max:hoist cable.tension'
  sheave sweep crane.json ... --shard 2/8 --resume part-2.sweep     then: sheave merge part-*.sweep

Rows do not depend on the number of cores or shards. Exit codes as of `sheave run`. A run
that diverges, a scene that is not valid, and a machine without a rest or with an unstable one
have this as their status, and fail the sweep only with --strict.)");
  return [arguments] { return run_and_tell(*arguments); };
}

Action declare_merge(CLI::App& app) {
  auto arguments = std::make_shared<MergeArguments>();
  app.add_option("journals", arguments->journals, "files of sheave sweep --resume, one per shard")
      ->required()
      ->option_text("FILE...");
  add_outputs(app, arguments->outputs);
  app.footer(R"(Examples:
  sheave merge part-*.sweep --csv crane.csv --chart crane.png

Exit code 1 if runs are missing; the runs that exist are written nevertheless.)");
  return [arguments] { return merge(*arguments); };
}

}  // namespace sheave::command
