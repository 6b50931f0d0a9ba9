// sheave stress: where the numbers of a machine go too far, as maps.

#include <array>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tools/command.h"
#include "tools/gnuplot.h"
#include "tools/interrupt.h"
#include "tools/output_file.h"
#include "tools/stress_table.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

struct StressArguments {
  StressOptions stress;
  std::string solver, integrator, markdown, chart;
  bool json = false;
  bool list = false;
};

/// The enumeration's values whose names fit; "" fits all. A Failure (2) if none does.
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

std::string file_name(const StressResult& result) {
  return fmt::format("{}-{}-{}", result.map.name,
                     solver_names[static_cast<std::size_t>(result.settings.solver)],
                     integrator_names[static_cast<std::size_t>(result.settings.integrator)]);
}

/// Each map as .png and .svg in the folder, which is made if need be.
void draw_maps(const std::vector<StressResult>& results, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitCode::io, folder + ": " + error.message());
  for (const StressResult& result : results) {
    for (const char* extension : {".png", ".svg"}) {
      const std::string path =
          (std::filesystem::path(folder) / (file_name(result) + extension)).string();
      draw_with_gnuplot(path,
                        [&](const std::string& output) { return stress_script(result, output); });
    }
  }
}

ExitCode stress(StressArguments& arguments) {
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
  print(arguments.json ? stress_json(results) : stress_text(results));
  if (!arguments.markdown.empty()) write_file(arguments.markdown, stress_markdown(results));
  if (!arguments.chart.empty()) draw_maps(results, arguments.chart);
  return ExitCode::done;
}

}  // namespace

Action declare_stress(CLI::App& app) {
  auto arguments = std::make_shared<StressArguments>();
  app.add_option("scene", arguments->stress.scene,
                 "Scene file (JSON); without one, machines with closed forms")
      ->option_text("[SCENE]");
  app.add_option("--map", arguments->stress.map, "only the map of this name")->option_text("NAME");
  app.add_flag("--list", arguments->list, "only print the names and meanings of the maps");
  app.add_option("--solver", arguments->solver, "only this one; default: all")->option_text("NAME");
  app.add_option("--integrator", arguments->integrator, "only this one; default: all")
      ->option_text("NAME");
  app.add_flag("--quick", arguments->stress.quick, "fewer cells, shorter runs");
  app.add_flag("--json", arguments->json, "print one JSON object with all cells");
  app.add_option("--markdown", arguments->markdown, "write all cells as Markdown tables")
      ->option_text("FILE");
  app.add_option("--chart", arguments->chart,
                 "draw heat maps with gnuplot, a .png and a .svg each, into this folder")
      ->option_text("DIR");
  app.footer(R"(Examples:
  sheave stress --quick
  sheave stress --map atwood --solver direct
  sheave stress --markdown bench/STRESS.md --chart bench/stress
  sheave stress crane.json --json | jq '.maps[].cells[] | select(.silent) | .command'

A cell is right if no number is off by more than a tenth of its closed form. What fails is told apart: diverged
(the run stopped itself), energy gain, false slack, lost length, or wrong. "silent" are failures of which
sheave run says nothing.)");
  return [arguments] { return stress(*arguments); };
}

}  // namespace sheave::tools
