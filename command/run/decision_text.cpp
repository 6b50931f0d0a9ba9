#include "command/run/decision_text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "command/text/table.h"

namespace sheave::command {
namespace {

using measure::Decision;
using measure::ErrorEstimate;

constexpr std::size_t max_decisions = 8;

std::string amount(double value, std::string_view unit) {
  if (unit.empty()) return fmt::format("{:.3g} %", 100.0 * value);
  return fmt::format("{:.3g} {}", value, unit);
}

std::string safety_text(const Decision& decision) {
  if (!decision.error) return "-";
  return std::isfinite(decision.safety()) ? fmt::format("{:.3g}", decision.safety()) : "exact";
}

std::string runs_text(const Decision& decision, const ErrorEstimate& estimate) {
  const bool fixed = estimate.tolerance == 0.0;
  const auto name = [&](std::size_t run) {
    const int part = 1 << run;
    if (run == 0) return std::string("this run");
    return fixed ? fmt::format("the run with {} substeps", estimate.substeps[run])
                 : fmt::format("the run with 1/{} of the tolerance", part * part);
  };
  std::string took;
  std::string left;
  for (std::size_t run = 0; run < 3; ++run) {
    std::string& list = decision.took_other[run] ? took : left;
    list += (list.empty() ? "" : ", ") + name(run);
  }
  return fmt::format(
      "it {} in {}, and never in {}; the positions of these runs differ by up to "
      "{:.3g} m (body \"{}\")",
      decision.other, took, left, estimate.apart, estimate.apart_body);
}

std::string close_text(const Decision& decision, const ErrorEstimate& estimate) {
  std::string text = fmt::format(
      "  decided by less than the error: {} {} at t = {} s, with a margin "
      "of {}",
      decision.alternative, decision.branch, short_number(decision.time),
      amount(decision.margin, decision.unit));
  if (decision.error)
    text += fmt::format(" and an error of {}", amount(*decision.error, decision.unit));
  if (decision.differs()) return text + "; " + runs_text(decision, estimate) + "\n";
  const bool ever = decision.took_other[0];
  return text +
         fmt::format("; the exact motion may be one in which it {}, {}\n", decision.other,
                     ever ? "as it does in all runs at another time" : "which no run has shown");
}

}  // namespace

std::string decision_text(const ErrorEstimate& estimate) {
  const std::vector<Decision>& all = estimate.decisions;
  if (all.empty()) return "";
  TextTable lines(
      {"nearest to its other branch", "branch", "margin", "at [s]", "error", "in errors"}, 2);
  std::string close;
  for (std::size_t i = 0; i < std::min(all.size(), max_decisions); ++i) {
    const Decision& own = all[i];
    lines.add({own.alternative, std::string(own.branch), amount(own.margin, own.unit),
               short_number(own.time), own.error ? amount(*own.error, own.unit) : "-",
               safety_text(own)});
    if (own.close) close += close_text(own, estimate);
  }
  std::string text = lines.text();
  if (all.size() > max_decisions) {
    text +=
        fmt::format("  ... and {} more margins; --json lists all\n", all.size() - max_decisions);
  }
  return text + close;
}

}  // namespace sheave::command
