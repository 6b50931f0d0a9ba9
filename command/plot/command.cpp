// sheave plot: quantities of runs as a chart.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/plot/data.h"
#include "command/registry.h"
#include "command/run/checker.h"
#include "command/run/player.h"
#include "command/run/simulate.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/text/one_line.h"

namespace sheave::command {
namespace {

struct PlotArguments {
  std::vector<std::string> inputs;
  SceneOptions scene;  ///< overrides for the inputs that are scenes
  PlotChoice choice;
  std::vector<std::string> labels;
  std::string out, title;
  bool json = false;
  bool quiet = false;
};

bool is_table(const std::string& path) { return path.ends_with(".csv") || path.ends_with(".npy"); }

/// Runs a scene to its end, or to an early stop, which is reported.
PlotRun plot_of_scene(const PlotArguments& arguments, const std::string& path) {
  SceneOptions options = arguments.scene;
  options.path = path;
  const Scene scene = load(options);
  Simulation simulation = make_simulation(scene);
  PlotRecorder recorder(simulation, arguments.choice);
  const std::int64_t steps = step_count(scene);
  Progress progress(path, 0.0, static_cast<double>(steps), arguments.quiet);
  const RunOutcome outcome = simulate(simulation, steps, progress, [&](const RunStatistics&) {
    recorder.observe(simulation);
    return true;
  });
  progress.clear();
  if (outcome.status == RunStatus::interrupted) throw Failure(ExitCode::interrupted, "interrupted");
  if (outcome.divergence) {
    print_warning(path + ": diverged: " + outcome.divergence->message + "; drawn until there");
  } else if (!outcome.certificate.clean(default_trust)) {
    print_warning(path + ": doubtful: " + doubt_text(outcome.certificate, default_trust));
  }
  return recorder.run(path, simulation);
}

ExitCode plot(const PlotArguments& arguments) {
  const ChartFormat format = chart_format(arguments.out);
  std::vector<NamedPath> inputs;
  for (const std::string& path : arguments.inputs) inputs.push_back({"the input", path});
  inputs.push_back({"--load-state", arguments.scene.load_state});
  check_paths(inputs, {{"--out", arguments.out}}, arguments.json);
  if (!arguments.labels.empty() && arguments.labels.size() != arguments.inputs.size()) {
    throw Failure(ExitCode::usage, fmt::format("{} labels for {} inputs; allowed: one for each",
                                               arguments.labels.size(), arguments.inputs.size()));
  }
  catch_interrupts();
  std::vector<PlotRun> runs;
  for (std::size_t i = 0; i < arguments.inputs.size(); ++i) {
    const std::string& path = arguments.inputs[i];
    runs.push_back(is_table(path) ? read_plot_table(path, arguments.choice)
                                  : plot_of_scene(arguments, path));
    runs.back().label = arguments.labels.empty() ? std::filesystem::path(path).stem().string()
                                                 : arguments.labels[i];
  }
  std::string title = arguments.title;
  for (std::size_t i = 0; arguments.title.empty() && i < runs.size(); ++i) {
    title += (i > 0 ? ", " : "") + runs[i].label;
  }
  draw_with_gnuplot(arguments.out, plot_script(runs, title, format));
  if (arguments.json) print(showable_json(plot_json(runs, arguments.out)));
  return ExitCode::done;
}

}  // namespace

Action declare_plot(CLI::App& app) {
  auto arguments = std::make_shared<PlotArguments>();
  app.add_option("inputs", arguments->inputs, "tables (.csv, .npy) and scenes, which are run")
      ->required()
      ->option_text("FILE...");
  app.add_option("-y,--y", arguments->choice.lists,
                 "quantities to draw: names, patterns with * and ?, and expressions such as "
                 "'load.y - hook.y' "
                 "or 'hypot(load.vx, load.vy)'; quantities of one unit share a panel")
      ->expected(1)
      ->take_all()
      ->required()
      ->option_text("NAME,...");
  app.add_option("-x,--x", arguments->choice.x,
                 "quantity or expression of the horizontal axis; default: t, the time")
      ->option_text("NAME");
  app.add_option("-o,--out", arguments->out, "file of the picture: .png, .svg or .pdf")
      ->required()
      ->option_text("FILE");
  app.add_option("--label", arguments->labels,
                 "name of each input in the legend; default: its file")
      ->delimiter(',')
      ->expected(1)
      ->take_all()
      ->option_text("TEXT,...");
  app.add_option("--title", arguments->title, "title above the picture")->option_text("TEXT");
  add_scene_changes(app, arguments->scene);
  app.add_flag("--json", arguments->json, "print the drawn curves as one JSON object");
  app.add_flag("-q,--quiet", arguments->quiet, "no progress");
  app.footer(R"(Examples:
  sheave plot scenes/machines/crane.json -y '*.0.tension' -o tensions.png
  sheave plot coarse.csv fine.npy -y load.y -o difference.pdf --label coarse,fine
  sheave plot run.csv -x load.x -y load.y -o path.svg
  sheave plot crane.json -y 'hypot(hook.vx, hook.vy)' -o speed.svg

Events, such as a rope that breaks, are marked where the horizontal axis is time.)");
  return [arguments] { return plot(*arguments); };
}

}  // namespace sheave::command
