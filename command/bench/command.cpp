// sheave bench: the paper's table on this machine, with the error beside every time.

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/bench/table.h"
#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/gnuplot_script.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/terminal.h"
#include "command/text/one_line.h"

namespace sheave::command {
namespace {

struct BenchArguments {
  BenchOptions bench;
  bool json = false;
  bool list = false;
  std::string markdown, chart, save, compare;
  double allow = 1.1;
};

/// Checks the arguments before minutes of measuring.
void check_arguments(const BenchArguments& arguments) {
  if (!arguments.chart.empty()) static_cast<void>(chart_format(arguments.chart));
  if (!arguments.compare.empty()) {
    // Reads and checks the baseline; the empty table compares nothing.
    static_cast<void>(compare_with_baseline({}, arguments.compare, arguments.allow));
  }
}

ExitCode bench(const BenchArguments& arguments) {
  check_paths({{"--compare", arguments.compare}},
              {{"--save", arguments.save},
               {"--markdown", arguments.markdown},
               {"--chart", arguments.chart}},
              true);
  check_arguments(arguments);
  if (arguments.list) {
    const BenchTable rows = list_table(arguments.bench);
    std::string names;
    for (const BenchRow& row : rows.rows) names += row.name() + "\n";
    print(arguments.json ? showable_json(bench_json(rows)) : printable(names));
    return ExitCode::done;
  }
  catch_interrupts();
  const BenchTable table = measure_table(arguments.bench);
  OutputFaults faults;
  faults.attempt([&] {
    print(arguments.json ? showable_json(bench_json(table)) : printable(bench_text(table)));
  });
  if (table.machine.assertions) {
    print_warning(
        "this program was built with assertions, so its times are meaningless; build it as "
        "Release");
  }
  if (!arguments.save.empty()) {
    faults.attempt([&] { write_file(arguments.save, bench_json(table)); });
  }
  if (!arguments.markdown.empty()) {
    faults.attempt([&] { write_file(arguments.markdown, bench_markdown(table)); });
  }
  if (!arguments.chart.empty()) faults.attempt([&] { draw_chart(table, arguments.chart); });
  const bool any_measured = std::any_of(table.rows.begin(), table.rows.end(),
                                        [](const BenchRow& row) { return row.measured(); });
  if (!any_measured) {
    print_error("no row has numbers; --scenes DIR names the folder of the paper's scenes");
    return faults.report(ExitCode::check_failed);
  }
  if (arguments.compare.empty()) return faults.report(ExitCode::done);
  const BenchComparison comparison =
      compare_with_baseline(table, arguments.compare, arguments.allow);
  if (!comparison.other_machine.empty()) {
    print_warning(fmt::format(
        "{}: the baseline was measured on another machine ({}); --save makes one of this machine",
        arguments.compare, comparison.other_machine));
  }
  const std::string text = comparison_text(comparison);
  // Standard output must contain exactly one object.
  if (arguments.json) {
    print_note(text);
  } else {
    faults.attempt([&] { print("\n" + text); });
  }
  return faults.report(comparison.any_slower() ? ExitCode::check_failed : ExitCode::done);
}

}  // namespace

Action declare_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  app.add_option("--scenes", arguments->bench.folder,
                 "folder of the paper's scenes; default: scenes/paper")
      ->option_text("DIR");
  app.add_option("--filter", arguments->bench.filter,
                 "only rows whose scene and setting contain this text, e.g. hilbert3, direct, "
                 "\"simple gauss\"")
      ->option_text("TEXT");
  app.add_flag("--list", arguments->list, "only print the names of the rows");
  app.add_option("--repetitions", arguments->bench.repetitions, "samples of each row; default: 7")
      ->check(CLI::Range(1, 1000))
      ->option_text("N");
  app.add_option("--reference-doublings", arguments->bench.reference_doublings,
                 "most times that the step of a reference is halved; default: 5")
      ->check(CLI::Range(1, 12))
      ->option_text("N");
  app.add_option("--reference-seconds", arguments->bench.reference_seconds,
                 "CPU time after which the step of a reference is no longer halved; default: 60")
      ->check(number_between(0.0, 1e6))
      ->option_text("X");
  app.add_flag("--json", arguments->json, "print one JSON object instead of the table");
  app.add_option("--markdown", arguments->markdown, "write the table as Markdown")
      ->option_text("FILE");
  app.add_option("--chart", arguments->chart, "draw times and errors with gnuplot, .png or .svg")
      ->option_text("FILE");
  app.add_option("--save", arguments->save,
                 "write the result to a file, as the baseline of this machine")
      ->option_text("FILE");
  app.add_option("--compare", arguments->compare,
                 "compare with a baseline; exit code 1 if a row is slower")
      ->option_text("FILE");
  app.add_option("--allow", arguments->allow,
                 "factor by which a row may be slower than the baseline; default: 1.1. A row "
                 "counts as slower only if the quartiles do not overlap")
      ->check(number_between(1.0, 1000.0))
      ->option_text("X");
  app.footer(R"(Examples:
  sheave bench
  sheave bench --filter hilbert3 --repetitions 3
  sheave bench --markdown bench/TABLE1.md --chart bench/table1.png
  sheave bench --save before.json
  sheave bench --compare before.json --allow 1.05

Keep the machine quiet, and the program on one core: taskset -c 1 sheave bench)");
  return [arguments] { return bench(*arguments); };
}

}  // namespace sheave::command
