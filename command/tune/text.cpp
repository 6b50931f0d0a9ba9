// sheave tune: the result as text and JSON.

#include <algorithm>
#include <array>
#include <cstdlib>

#include <sheave_version.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/sweep/rows_json.h"
#include "command/terminal.h"
#include "command/text/table.h"
#include "command/tune/tune.h"

namespace sheave::command {
namespace {

using Json = nlohmann::ordered_json;

/// More lines of the course are left to --csv and --json.
constexpr std::size_t most_steps_shown = 30;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string label(const SweepMeasure& measure) { return with_unit(measure.name, measure.unit); }

/// A value of a setting with fewer digits; the scene of -o has all.
std::string short_value(const std::string& text) {
  return short_number(std::strtod(text.c_str(), nullptr));
}

/// The words of TuneGoal::Sense.
constexpr std::array<std::string_view, 3> sense_names{"minimise", "maximise", "target"};

/// "minimise rope.0.tension", "reach frequency:1 = 2.5".
std::string task_text(const TuneOptions& options) {
  const TuneGoal& goal = options.goal;
  const std::string name = printable_line(options.rows.measures[0].name);
  if (goal.sense == TuneGoal::Sense::target) {
    return fmt::format("reach {} = {}", name, short_number(goal.target));
  }
  return fmt::format("{} {}", sense_names[static_cast<std::size_t>(goal.sense)], name);
}

/// The wanted value in a table: "least", "greatest", "= 2.5".
std::string wanted_text(const TuneGoal& goal) {
  if (goal.sense == TuneGoal::Sense::target) return "= " + short_number(goal.target);
  return goal.sense == TuneGoal::Sense::minimise ? "least" : "greatest";
}

std::string bound_text(const TuneBound& bound) {
  return (bound.above ? "> " : "< ") + short_number(bound.limit);
}

std::string names_of(const std::vector<std::size_t>& which, const std::vector<std::string>& names) {
  std::string text;
  for (const std::size_t i : which) text += (text.empty() ? "" : ", ") + printable_line(names[i]);
  return text;
}

std::vector<std::string> names_of_bounds(const TuneOptions& options) {
  std::vector<std::string> names;
  for (std::size_t b = 0; b < options.bounds.size(); ++b) {
    names.push_back(options.rows.measures[b + 1].name + " " + bound_text(options.bounds[b]));
  }
  return names;
}

/// The closing statement: one sentence about the end, and one about the limits of the result.
std::string statement(const TuneOptions& options, const TuneResult& result) {
  const std::size_t runs = result.table.rows.size();
  std::string text;
  switch (result.end) {
    case TuneEnd::converged:
      text = fmt::format(
          "converged after {} runs: the search ended with steps below {} % of each "
          "range",
          runs, short_number(100.0 * options.tolerance));
      break;
    case TuneEnd::limit:
      text = fmt::format("not converged: the limit of {} runs came first; a larger --runs goes on",
                         options.most_runs);
      break;
    case TuneEnd::violated:
      return fmt::format(
          "no solution: none of {} runs keeps all bounds; the best one violates "
          "them least",
          runs);
    case TuneEnd::flat:
      text =
          fmt::format("flat: the goal is the same in all {} runs, so nothing can be chosen", runs);
      break;
    case TuneEnd::no_result:
      return fmt::format("no result: none of {} runs is done", runs);
  }
  if (options.goal.sense == TuneGoal::Sense::target) {
    const SweepMeasure& measure = options.rows.measures[0];
    const double off = options.goal.cost(result.table.rows[*result.best].measured[0]);
    text += fmt::format("; off the target by {}{}{}", short_number(off),
                        measure.unit.empty() ? "" : " ", printable_line(measure.unit));
  }
  const auto& axes = result.table.head.axes;
  if (!result.at_end.empty() && result.end != TuneEnd::flat) {
    text += fmt::format("; at the end of the range: {}", names_of(result.at_end, axes));
  }
  if (!result.active.empty()) {
    text += fmt::format("; active: {}", names_of(result.active, names_of_bounds(options)));
  }
  return text;
}

std::string best_text(const TuneOptions& options, const TuneResult& result) {
  if (!result.best) return "";
  const SweepRow& best = result.table.rows[*result.best];
  TextTable settings({"setting", "best", "range"}, 1);
  for (std::size_t a = 0; a < best.values.size(); ++a) {
    const SweepAxis& axis = options.rows.plan.axes[a];
    settings.add({with_unit(axis.name, axis.unit), short_value(best.values[a]),
                  fmt::format("{} ... {}", short_number(axis.low), short_number(axis.high))});
  }
  TextTable measures({"measure", "value", "wanted"}, 1);
  const auto& list = options.rows.measures;
  measures.add({label(list[0]), short_number(best.measured[0]), wanted_text(options.goal)});
  for (std::size_t b = 0; b < options.bounds.size(); ++b) {
    measures.add(
        {label(list[b + 1]), short_number(best.measured[b + 1]), bound_text(options.bounds[b])});
  }
  return "\n" + settings.text() + "\n" + measures.text();
}

std::string course_text(const TuneOptions& options, const TuneResult& result) {
  if (result.improved.empty()) return "";
  std::vector<std::string> names{"run"};
  for (const SweepAxis& axis : options.rows.plan.axes) {
    names.push_back(with_unit(axis.name, axis.unit));
  }
  for (const SweepMeasure& measure : options.rows.measures) names.push_back(label(measure));
  TextTable table(names, 0);
  const std::size_t skipped =
      result.improved.size() - std::min(result.improved.size(), most_steps_shown);
  for (std::size_t i = skipped; i < result.improved.size(); ++i) {
    const SweepRow& row = result.table.rows[result.improved[i]];
    std::vector<std::string> cells{fmt::format("{}", row.run)};
    for (const std::string& value : row.values) cells.push_back(short_value(value));
    for (const double value : row.measured) cells.push_back(short_number(value));
    table.add(std::move(cells));
  }
  std::string text = "\nruns that were the best so far";
  if (skipped > 0)
    text += fmt::format(", the last {} of {}", most_steps_shown, result.improved.size());
  return text + "\n" + table.text();
}

/// Runs without a result, with the message of the first.
std::string failed_text(const TuneResult& result) {
  std::size_t count = 0;
  const SweepRow* first = nullptr;
  for (const SweepRow& row : result.table.rows) {
    if (row.status == SweepStatus::done) continue;
    ++count;
    if (first == nullptr) first = &row;
  }
  if (first == nullptr) return "";
  return fmt::format(
      "\n{} runs are not done and count as worse than all others, the first: run {} "
      "is {}: {}\n",
      count, first->run, sweep_status_names[static_cast<std::size_t>(first->status)],
      printable_line(first->message));
}

Json best_json(const TuneOptions& options, const TuneResult& result) {
  if (!result.best) return nullptr;
  const SweepRow& best = result.table.rows[*result.best];
  Json values = Json::object();
  for (std::size_t a = 0; a < best.values.size(); ++a) {
    values[result.table.head.axes[a]] = std::strtod(best.values[a].c_str(), nullptr);
  }
  Json bounds = Json::array();
  for (std::size_t b = 0; b < options.bounds.size(); ++b) {
    bounds.push_back({{"measure", options.rows.measures[b + 1].name},
                      {"above", options.bounds[b].above},
                      {"limit", options.bounds[b].limit},
                      {"value", best.measured[b + 1]},
                      {"active", std::count(result.active.begin(), result.active.end(), b) > 0}});
  }
  Json at_end = Json::array();
  for (const std::size_t a : result.at_end) at_end.push_back(result.table.head.axes[a]);
  return {{"run", best.run},
          {"values", std::move(values)},
          {"goal", best.measured[0]},
          {"bounds", std::move(bounds)},
          {"at_end_of_range", std::move(at_end)}};
}

}  // namespace

std::string tune_text(const TuneOptions& options, const TuneResult& result) {
  const SweepHead& head = result.table.head;
  return fmt::format("{}: {}, by {}\n{}\n", printable_line(head.scene), task_text(options),
                     name_of(result.method), statement(options, result)) +
         best_text(options, result) + course_text(options, result) + failed_text(result);
}

std::string tune_json(const TuneOptions& options, const TuneResult& result) {
  const SweepHead& head = result.table.head;
  const Json json{
      {"format", "sheave-tune/1"},
      {"version", version_string},
      {"scene", head.scene},
      {"of", name_of(head.kind)},
      {"method", name_of(result.method)},
      {"goal", sense_names[static_cast<std::size_t>(options.goal.sense)]},
      {"target",
       options.goal.sense == TuneGoal::Sense::target ? Json(options.goal.target) : Json(nullptr)},
      {"measure", options.rows.measures[0].name},
      {"unit", options.rows.measures[0].unit},
      {"end", tune_end_names[static_cast<std::size_t>(result.end)]},
      {"statement", statement(options, result)},
      {"best", best_json(options, result)},
      {"runs", result.table.rows.size()},
      {"improved", result.improved},
      {"rows", sweep_rows_json(result.table)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
