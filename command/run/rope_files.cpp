#include "command/run/rope_files.h"

#include "command/failure.h"
#include "command/output/gnuplot_script.h"

namespace sheave::command {

void check_rope_options(const RopeOptions& options, std::vector<NamedPath>& inputs,
                        std::vector<NamedPath>& outputs) {
  if (!options.wanted() && (options.sections || options.diameter)) {
    throw Failure(ExitCode::usage,
                  "--rope-sections and --rope-diameter need --rope-history, --rope-chart or "
                  "--rope-life");
  }
  if (!options.life.empty() && !options.diameter) {
    throw Failure(ExitCode::usage,
                  "--rope-life needs --rope-diameter D, the diameter of the ropes [m]");
  }
  inputs.push_back({"--rope-life", options.life});
  for (const std::string& path : options.files) outputs.push_back({"--rope-history", path});
  if (options.chart.empty()) return;
  static_cast<void>(chart_format(options.chart));
  outputs.push_back({"--rope-chart", options.chart});
}

std::optional<measure::RopeHistory> watch_ropes(const RopeOptions& options) {
  if (!options.wanted()) return {};
  std::optional<measure::RopeLife> life;
  if (!options.life.empty()) life = read_rope_life(options.life, options.diameter.value());
  return measure::RopeHistory(options.sections.value_or(default_rope_sections), std::move(life));
}

void write_rope_files(const RopeOptions& options, const std::vector<measure::CableHistory>& cables,
                      const std::string& title, OutputFaults& faults) {
  for (const std::string& path : options.files) {
    faults.attempt([&] {
      if (path.ends_with(".csv")) {
        write_rope_table(path, options, cables);
      } else {
        write_rope_json(path, options, cables);
      }
    });
  }
  if (!options.chart.empty()) faults.attempt([&] { draw_rope_chart(options, cables, title); });
}

}  // namespace sheave::command
