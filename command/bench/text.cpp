// sheave bench: the table for people, as text and as Markdown.

#include <cmath>

#include <fmt/format.h>

#include "command/bench/table.h"
#include "command/text/error_text.h"
#include "command/text/one_line.h"
#include "command/text/table.h"

namespace sheave::command {
namespace {

const std::vector<std::string> bench_head{
    "scene",          "setting",      "joints",         "frame [us]",    "quartiles",
    "paper [us]",     "paper / ours", "position error", "tension error", "stretch",
    "solves / frame", "ns / solve",   "instructions"};

std::string three_digits(double value) { return fmt::format("{:.3g}", value); }

std::string joints_text(const BenchRow& row) {
  const bool same = row.paper_joints == 0 || row.paper_joints == row.joints;
  return same ? fmt::format("{}", row.joints)
              : fmt::format("{} (paper {})", row.joints, row.paper_joints);
}

std::vector<std::string> cells(const BenchRow& row) {
  const auto& time = row.seconds;
  const bool paper = row.paper_seconds.has_value();
  return {row.scene,
          measure::settings_text(row.settings),
          joints_text(row),
          microseconds_text(time.median),
          microseconds_text(time.lower) + " - " + microseconds_text(time.upper),
          paper ? microseconds_text(*row.paper_seconds) : "-",
          paper ? three_digits(*row.paper_seconds / time.median) : "-",
          error_text(row.error.position, row.reference_error.position),
          error_text(row.error.tension, row.reference_error.tension),
          fmt::format("{:.1e}", row.stretch),
          three_digits(row.row_solves),
          three_digits(1e9 * row.seconds_per_solve()),
          row.instructions ? fmt::format("{:.0f}", *row.instructions) : "-"};
}

std::string machine_text(const BenchTable& table) {
  return fmt::format(
      "sheave {}, {}, {}{}", table.version, table.machine.cpu, table.machine.compiler,
      table.machine.assertions ? "; built WITH ASSERTIONS: the times are meaningless" : "");
}

/// Remarks beside the numbers, one line each.
std::vector<std::string> bench_remarks(const BenchTable& table) {
  std::vector<std::string> lines;
  for (const BenchRow& row : table.rows) {
    if (!row.measured()) lines.push_back(fmt::format("{}: no numbers: {}", row.name(), row.fault));
    if (row.measured() && row.fallbacks > 0) {
      lines.push_back(fmt::format("{}: {} substeps were done by gauss-seidel or xpbd instead",
                                  row.name(), row.fallbacks));
    }
  }
  for (const BenchReference& reference : table.references) {
    std::string line =
        fmt::format("{}: reference direct, {}, {} substeps, its own error {:.1e}", reference.scene,
                    integrator_names[static_cast<std::size_t>(reference.integrator)],
                    reference.substeps, reference.estimate.position);
    if (std::isfinite(reference.order)) line += fmt::format(" (order {:.1f})", reference.order);
    if (!reference.good) line += ", more than a tenth of the smallest error measured with it";
    lines.push_back(line);
  }
  if (!table.no_instructions.empty()) {
    lines.push_back("instructions: not available here: " + table.no_instructions +
                    " (dev/instruction-profile counts them with valgrind)");
  }
  return lines;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

}  // namespace

std::string bench_text(const BenchTable& table) {
  TextTable text(bench_head, 2);
  for (const BenchRow& row : table.rows) {
    if (row.measured()) text.add(cells(row));
  }
  std::string result = machine_text(table) + "\n\n" + text.text() + "\n";
  for (const std::string& line : bench_remarks(table)) result += "  " + line + "\n";
  return result;
}

std::string bench_markdown(const BenchTable& table) {
  std::string result = "# The paper's Table 1 on this machine\n\n";
  result += "Made by `sheave bench --markdown`: " + markdown_text(machine_text(table)) + ".\n\n";
  result += fmt::format(
      "Frame: CPU time of one frame of 1/60 s, median and quartiles of {} interleaved repetitions "
      "of\n"
      "the whole scene. Setting: solver, substeps (x iterations). Paper / ours: how many times "
      "faster than the paper's\n"
      "Core i7 of 3.5 GHz. Position error: largest displacement of the bodies from a converged "
      "reference in "
      "any frame, root\n"
      "mean square over bodies, relative to the scene's size (measure/run_error.h). Stretch: "
      "largest violation of a\n"
      "cable's length, relative to it. Solves: rows x iterations x substeps.\n\n",
      table.repetitions);
  result += markdown_row(bench_head);
  result += markdown_row(std::vector<std::string>(bench_head.size(), "---"));
  for (const BenchRow& row : table.rows) {
    if (row.measured()) result += markdown_row(cells(row));
  }
  result += "\n";
  for (const std::string& line : bench_remarks(table)) result += "* " + markdown_text(line) + "\n";
  return result;
}

bool BenchComparison::any_slower() const {
  for (const BenchChange& change : changes) {
    if (change.slower) return true;
  }
  return false;
}

std::string comparison_text(const BenchComparison& comparison) {
  TextTable text({"row", "before [us]", "now [us]", "now / before", ""}, 1);
  for (const BenchChange& change : comparison.changes) {
    text.add({change.name, microseconds_text(change.before), microseconds_text(change.now),
              fmt::format("{:.3f}", change.ratio()), change.slower ? "SLOWER" : ""});
  }
  std::string result = "compared with " + comparison.path + "\n\n" + text.text() + "\n";
  for (const std::string& name : comparison.missing)
    result += "  " + name + ": in one of the two files only\n";
  return result;
}

}  // namespace sheave::command
