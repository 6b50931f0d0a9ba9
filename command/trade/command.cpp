// sheave trade: the cost of accuracy in the user's own scene, and the setting that meets a
// requirement.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/input/file.h"
#include "command/interrupt.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "command/trade/table.h"
#include "scenes/json/document.h"
#include "scenes/scene_text.h"

namespace sheave::command {
namespace {

struct TradeArguments {
  SceneOptions scene;
  TradeOptions trade;
  std::vector<std::string> solvers, integrators, tangents, tolerances;
  std::string budget, error, tension_error;

  [[nodiscard]] bool asks() const {
    return !budget.empty() || !error.empty() || !tension_error.empty();
  }
  std::string csv, markdown, chart;
  bool json = false;
  bool apply = false;
};

/// The values for words of a closed list; all values if no words are given.
template <class Kind, std::size_t Count>
std::vector<Kind> chosen(const std::vector<std::string>& words,
                         const std::array<std::string_view, Count>& names) {
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < Count; ++i) {
    const bool wanted = std::find(words.begin(), words.end(), names[i]) != words.end();
    if (wanted || words.empty()) kinds.push_back(static_cast<Kind>(i));
  }
  return kinds;
}

template <std::size_t Count>
CLI::IsMember one_of(const std::array<std::string_view, Count>& names) {
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}

void no_doubles(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// The tolerances of --tolerance; the default ones if it is not given.
void choose_tolerances(const std::vector<std::string>& words, TradeGrid& grid) {
  if (words.empty()) return;
  grid.tolerances.clear();
  if (words == std::vector<std::string>{"none"}) return;
  for (const std::string& word : words) grid.tolerances.push_back(parse_tolerance(word));
}

/// Checks the arguments before minutes of measuring.
TradeQuestion check_trade_arguments(const TradeArguments& arguments) {
  if (!arguments.chart.empty()) static_cast<void>(chart_format(arguments.chart));
  TradeQuestion question;
  if (!arguments.budget.empty()) question.seconds_per_frame = budget_seconds(arguments.budget);
  if (!arguments.error.empty()) question.error = error_share(arguments.error);
  if (!arguments.tension_error.empty()) {
    question.tension_error = error_share(arguments.tension_error, "--tension-error");
  }
  if (!arguments.apply) return question;
  if (!arguments.asks()) {
    throw Failure(ExitCode::usage,
                  "--apply needs --budget or --error or --tension-error, which choose a setting");
  }
  if (arguments.scene.path == "-") {
    throw Failure(ExitCode::usage, "--apply needs a scene file, not standard input");
  }
  if (arguments.scene.path.ends_with(".jsonnet") || arguments.scene.path.ends_with(".xml")) {
    throw Failure(ExitCode::usage,
                  "--apply needs a scene in JSON; it does not change Jsonnet programs and models "
                  "of other programs");
  }
  return question;
}

/// Writes the setting into the scene's file; the rest of the file stays unchanged.
void apply_setting(const std::string& path, const TradeSetting& setting) {
  std::string text = read_input(path, json::Limits{}.bytes);
  const SceneResult from = load_scene_text(text, path);
  if (!from) throw Failure(exit_code(from), to_text(from));
  const Scene wanted = setting.applied(*from);
  for (const Override& change : step_changes(*from, wanted)) {
    Result<std::string> changed = with_setting(text, change.pointer, change.value);
    if (!changed) throw Failure(ExitCode::bad_scene, path + ": " + to_text(changed.errors()));
    text = std::move(changed).value();
  }
  const SceneResult now = load_scene_text(text, path);
  if (!now) throw Failure(ExitCode::internal, "the changed scene is not valid: " + to_text(now));
  write_file(path, text);
}

std::string question_text(const TradeArguments& arguments) {
  if (!arguments.budget.empty()) return "--budget " + arguments.budget;
  std::string text;
  if (!arguments.error.empty()) text = "--error " + arguments.error;
  if (arguments.tension_error.empty()) return text;
  return text + (text.empty() ? "" : " ") + "--tension-error " + arguments.tension_error;
}

/// Why no setting meets the requirement, as far as known.
std::string missing_answer(const TradeTable& table, const TradeQuestion& question) {
  const std::string none = ": none of these settings";
  if (question.error && !question.tension_error &&
      answer(table,
             {.error = question.error, .tension_error = std::numeric_limits<double>::infinity()})) {
    return none +
           " for tensions; of positions alone some are (--tension-error allows more of "
           "tensions)";
  }
  return none + "; finer ones: --substeps, --iterations";
}

/// Reports the setting that meets the requirement, and applies it on request. Returns whether there
/// is one.
bool answer_question(const TradeArguments& arguments, const TradeTable& table,
                     const TradeQuestion& question) {
  const std::string asked = question_text(arguments);
  const std::optional<std::size_t> choice = answer(table, question);
  if (!choice) {
    print_warning(asked + missing_answer(table, question));
    return false;
  }
  const TradeRow& row = table.rows[*choice];
  const std::string line =
      fmt::format("{}: {} ({:.3g} ms per frame, {})", asked, row.setting.name(),
                  1e3 * table.dt * row.seconds.median, errors_text(table, row));
  // Standard output must contain exactly one object.
  if (arguments.json) {
    print_note(line);
  } else {
    print(printable(line) + "\n\n");
  }
  if (!table.tensions_known() && !question.tension_error) {
    print_warning(
        fmt::format("{}: chosen by positions alone, because the tensions of the reference have an "
                    "error of {:.1e} of their mean",
                    asked, table.doubt.tension));
  }
  if (arguments.apply) {
    apply_setting(arguments.scene.path, row.setting);
    print_note("written into " + arguments.scene.path);
  }
  return true;
}

void write_trade_files(const TradeArguments& arguments, const TradeTable& table,
                       OutputFaults& faults) {
  if (!arguments.csv.empty()) {
    faults.attempt([&] { write_file(arguments.csv, trade_csv(table)); });
  }
  if (!arguments.markdown.empty()) {
    faults.attempt([&] { write_file(arguments.markdown, trade_markdown(table)); });
  }
  if (arguments.chart.empty()) return;
  faults.attempt([&] {
    draw_with_gnuplot(arguments.chart, trade_chart_script(table, chart_format(arguments.chart)));
  });
}

ExitCode trade(TradeArguments& arguments) {
  const TradeQuestion question = check_trade_arguments(arguments);
  check_paths({{"the scene", arguments.scene.path}, {"--load-state", arguments.scene.load_state}},
              {{"--resume", arguments.trade.resume},
               {"--csv", arguments.csv},
               {"--markdown", arguments.markdown},
               {"--chart", arguments.chart}},
              true);
  TradeGrid& grid = arguments.trade.grid;
  no_doubles(grid.substeps);
  no_doubles(grid.iterations);
  grid.solvers = chosen<SolverKind>(arguments.solvers, solver_names);
  grid.integrators = chosen<IntegratorKind>(arguments.integrators, integrator_names);
  grid.tangents = chosen<TangentUpdate>(arguments.tangents, tangent_update_names);
  choose_tolerances(arguments.tolerances, grid);
  Scene scene = load(arguments.scene);
  if (scene.name.empty()) scene.name = std::filesystem::path(arguments.scene.path).stem().string();
  catch_interrupts();
  const TradeTable table = measure_trade(scene, arguments.trade);
  OutputFaults faults;
  const bool asked = arguments.asks();
  bool answered = !asked;
  // The answer comes before the table, which may be long.
  if (asked) faults.attempt([&] { answered = answer_question(arguments, table, question); });
  faults.attempt([&] {
    print(arguments.json ? showable_json(trade_json(table)) : printable(trade_text(table)));
  });
  if (table.machine.assertions) {
    print_warning(
        "this program was built with assertions, so its times are meaningless; build it as "
        "Release");
  }
  write_trade_files(arguments, table, faults);
  return faults.report(answered ? ExitCode::done : ExitCode::check_failed);
}

void add_trade_scene(CLI::App& app, SceneOptions& scene) {
  app.add_option("scene", scene.path, "Scene file (JSON); - reads standard input")
      ->required()
      ->option_text("SCENE");
  app.add_option("--dt", scene.dt, "time per frame [s] instead of the scene's")
      ->check(finite_number())
      ->option_text("X");
  app.add_option("--duration", scene.duration, "time to simulate [s] instead of the scene's")
      ->check(finite_number())
      ->option_text("X");
  add_start_options(app, scene);
  add_jsonnet_options(app, scene);
  add_case_option(app, scene);
}

void add_trade_grid(CLI::App& app, TradeArguments& arguments) {
  TradeGrid& grid = arguments.trade.grid;
  const char* const group = "Varied settings";
  app.add_option("--substeps", grid.substeps, "default: 1,2,4,8,16,32")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 100'000))
      ->group(group)
      ->option_text("N,...");
  app.add_option("--tolerance", arguments.tolerances,
                 "tolerances in place of substeps, lengths or shares of the machine's size, or "
                 "none; default: 1%,0.1%,0.01%,0.001%")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(group)
      ->option_text("LENGTH,...");
  app.add_option("--iterations", grid.iterations, "iterations of gauss-seidel; default: 1,10,100")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 1'000'000))
      ->group(group)
      ->option_text("N,...");
  app.add_option("--solver", arguments.solvers, "gauss-seidel,direct; default: both")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(solver_names))
      ->group(group)
      ->option_text("NAME,...");
  app.add_option("--integrator", arguments.integrators, "xpbd,rattle; default: both")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(integrator_names))
      ->group(group)
      ->option_text("NAME,...");
  app.add_option("--tangents", arguments.tangents,
                 "when the cables' tangents follow the bodies: iteration,substep; default: both")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(tangent_update_names))
      ->group(group)
      ->option_text("NAME,...");
}

void add_trade_outputs(CLI::App& app, TradeArguments& arguments) {
  app.add_flag("--json", arguments.json, "print one JSON object instead of the table");
  app.add_option("--csv", arguments.csv, "write the table as CSV")->option_text("FILE");
  app.add_option("--markdown", arguments.markdown, "write the report as Markdown")
      ->option_text("FILE");
  app.add_option("--chart", arguments.chart, "draw errors over times with gnuplot, .png or .svg")
      ->option_text("FILE");
}

}  // namespace

Action declare_trade(CLI::App& app) {
  auto arguments = std::make_shared<TradeArguments>();
  add_trade_scene(app, arguments->scene);
  add_trade_grid(app, *arguments);
  CLI::Option* const budget =
      app.add_option("--budget", arguments->budget,
                     "print the most accurate setting within this time, e.g. 2ms/frame; exit code "
                     "1 if there is none")
          ->option_text("TIME");
  app.add_option("--error", arguments->error,
                 "print the cheapest setting within this error of positions and of tensions, e.g. "
                 "0.1%; exit code 1 if there is none")
      ->option_text("SHARE")
      ->excludes(budget);
  app.add_option("--tension-error", arguments->tension_error,
                 "the same, within this error of tensions; with --error, which then counts for "
                 "positions, or alone")
      ->option_text("SHARE")
      ->excludes(budget);
  app.add_flag("--apply", arguments->apply,
               "write the chosen setting into the scene file; its comments are kept");
  app.add_option("--repetitions", arguments->trade.repetitions,
                 "samples of each setting's time; default: 5")
      ->check(CLI::Range(1, 1000))
      ->option_text("N");
  app.add_option("--reference-seconds", arguments->trade.reference_seconds,
                 "CPU time after which the step of the reference is no longer halved; default: 30")
      ->check(number_between(0.0, 1e6))
      ->option_text("X");
  app.add_option("--minutes", arguments->trade.minutes,
                 "approximate time of the command; settings that do not fit are listed and "
                 "skipped, the most expensive first; default: 5")
      ->check(number_between(0.01, 1e6))
      ->option_text("X");
  app.add_option(
         "--parallel", arguments->trade.threads,
         "number of threads that measure errors; times are measured by one; default: one per core")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  app.add_option("--resume", arguments->trade.resume,
                 "write the measurements to this file and resume from it; measurements of another "
                 "scene, setting or build are ignored")
      ->option_text("FILE");
  app.add_flag("--ladder,!--no-ladder", arguments->trade.ladder,
               "also measure the scene with single effects of the model left out; default: yes");
  add_trade_outputs(app, *arguments);
  app.footer(R"(Examples:
  sheave trade scenes/paper/simple.json --chart simple.png
  sheave trade scenes/paper/gym.json --solver direct --substeps 1,2,4
  sheave trade scenes/paper/pulley.json --error 0.1%
  sheave trade bench/tolerance/lands.json --tolerance 1mm,0.1mm --error 0.1%
  sheave trade scenes/machines/crane.json --error 0.1% --tension-error 1%
  sheave trade my-scene.json --budget 2ms/frame --apply

  sheave trade my-scene.json --minutes 30 --resume my-scene.trade

Keep the machine quiet: one thread measures the times, and other programs slow it down.)");
  return [arguments] { return trade(*arguments); };
}

}  // namespace sheave::command
