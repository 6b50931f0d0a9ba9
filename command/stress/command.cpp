// sheave stress: maps of the range of numbers in which a machine is computed well.

#include <array>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command/interrupt.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/gnuplot.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/stress/table.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "measure/stress_scenes.h"

namespace sheave::command {
namespace {

struct StressArguments {
  StressOptions stress;
  std::string solver, integrator, markdown, chart, print;
  bool json = false;
  bool list = false;
  bool only_failed = false;
};

/// The values of an enumeration whose names match; "" matches all. A Failure (2) if none matches.
template <class Kind, std::size_t n>
std::vector<Kind> chosen(const char* option, const std::string& name,
                         const std::array<std::string_view, n>& names) {
  std::vector<Kind> kinds;
  std::string allowed;
  for (std::size_t i = 0; i < n; ++i) {
    if (name.empty() || name == names[i]) kinds.push_back(static_cast<Kind>(i));
    allowed += (i > 0 ? ", " : "") + std::string(names[i]);
  }
  if (!kinds.empty()) return kinds;
  throw Failure(ExitCode::usage, fmt::format("{} {}: allowed: {}", option, name, allowed));
}

bool is_drawn(const StressArguments& arguments, const StressResult& result) {
  return !arguments.chart.empty() && (!arguments.only_failed || result.failed() > 0);
}

/// The path of a result's picture relative to the page.
std::string picture_of(const StressArguments& arguments, const StressResult& result) {
  if (!is_drawn(arguments, result)) return "";
  const auto page = std::filesystem::absolute(arguments.markdown).parent_path();
  const auto picture =
      std::filesystem::absolute(arguments.chart) / (stress_chart_name(result) + ".png");
  return picture.lexically_relative(page).generic_string();
}

/// Draws each map as .png and .svg in the folder, which is created if necessary.
void draw_maps(const std::vector<StressResult>& results, const StressArguments& arguments) {
  const std::string& folder = arguments.chart;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitCode::io, folder + ": " + error.message());
  for (const StressResult& result : results) {
    if (!is_drawn(arguments, result)) continue;
    for (const char* extension : {".png", ".svg"}) {
      const std::string path =
          (std::filesystem::path(folder) / (stress_chart_name(result) + extension)).string();
      draw_with_gnuplot(path, stress_script(result, chart_format(path)));
    }
  }
}

/// Prints the text of a built-in scene.
ExitCode print_scene(const std::string& name) {
  if (const auto text = measure::stress_scene(name)) {
    print(std::string(*text));
    return ExitCode::done;
  }
  throw Failure(ExitCode::usage, fmt::format("--print {}: allowed: {}", name,
                                             fmt::join(measure::stress_scene_names, ", ")));
}

ExitCode stress(StressArguments& arguments) {
  if (!arguments.print.empty()) return print_scene(arguments.print);
  StressOptions& options = arguments.stress;
  options.settings.clear();
  for (const auto integrator :
       chosen<IntegratorKind>("--integrator", arguments.integrator, integrator_names)) {
    for (const auto solver : chosen<SolverKind>("--solver", arguments.solver, solver_names)) {
      options.settings.push_back({solver, integrator});
    }
  }
  if (arguments.list) {
    std::string names;
    for (const measure::StressMap& map : choose_maps(options)) {
      names += fmt::format("{}: {}\n", map.name, map.meaning);
    }
    print(names);
    return ExitCode::done;
  }
  catch_interrupts();
  const std::vector<StressResult> results = measure_stress(options);
  OutputFaults faults;
  faults.attempt([&] {
    print(arguments.json ? showable_json(stress_json(results)) : printable(stress_text(results)));
  });
  if (!arguments.markdown.empty()) {
    faults.attempt([&] {
      write_file(arguments.markdown, stress_markdown(results, [&](const StressResult& result) {
                   return picture_of(arguments, result);
                 }));
    });
  }
  if (!arguments.chart.empty()) faults.attempt([&] { draw_maps(results, arguments); });
  return ExitCode::done;
}

}  // namespace

Action declare_stress(CLI::App& app) {
  auto arguments = std::make_shared<StressArguments>();
  app.add_option(
         "scene", arguments->stress.scene.path,
         "Scene file (JSON); without one, machines with closed forms, and the hand, the gym "
         "machine and the bow")
      ->option_text("[SCENE]");
  add_start_options(app, arguments->stress.scene);
  for (const char* start : {"--from-rest", "--load-state"}) {
    app.get_option(start)->needs(app.get_option("scene"));
  }
  app.add_option("--map", arguments->stress.map, "only the map of this name")->option_text("NAME");
  app.add_option("--print", arguments->print,
                 "only print one of the scenes that are part of the program: hand, gym, bow")
      ->option_text("NAME");
  app.add_flag("--list", arguments->list, "only print the names and meanings of the maps");
  app.add_option("--solver", arguments->solver, "only this one; default: all")->option_text("NAME");
  app.add_option("--integrator", arguments->integrator, "only this one; default: all")
      ->option_text("NAME");
  app.add_flag("--quick", arguments->stress.quick, "fewer cells, shorter runs");
  app.add_flag("--json", arguments->json, "print one JSON object with all cells");
  app.add_option("--markdown", arguments->markdown, "write all cells as Markdown tables")
      ->option_text("FILE");
  CLI::Option* chart =
      app.add_option("--chart", arguments->chart,
                     "draw heat maps with gnuplot, a .png and a .svg each, into this folder")
          ->option_text("DIR");
  app.add_flag("--only-failed", arguments->only_failed, "draw only maps in which a cell failed")
      ->needs(chart);
  app.footer(R"(Examples:
  sheave stress --quick
  sheave stress --map atwood --solver direct
  sheave stress --markdown STRESS.md --chart stress --only-failed
  sheave stress crane.json --json | jq '.maps[].cells[] | select(.silent) | .command'

A cell is right if every number is within a tenth of its closed form. A failure has one of these
kinds: diverged (the run stopped itself), energy gain, false slack, lost length, or wrong. A failure
is "silent" if sheave run gives neither a warning nor a doubtful certificate.)");
  return [arguments] { return stress(*arguments); };
}

}  // namespace sheave::command
