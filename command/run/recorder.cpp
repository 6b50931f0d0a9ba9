#include "command/run/recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <unordered_set>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/quantity_choice.h"

namespace sheave::command {

Recorder::Recorder(const RecordOptions& options, const Simulation& simulation)
    : every_(options.every),
      columns_(std::make_shared<const QuantityIndex>(
                   simulation, options.columns.empty() ? ObservableSet::Extent::columns
                                                       : ObservableSet::Extent::everything),
               Taken::along_run) {
  if (options.paths.empty()) return;
  choose_columns(options.columns);
  values_.resize(columns_.size());
  courses_.resize(columns_.course_count());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns_.size(); ++i) names.push_back(columns_.text(i));
  for (const std::string& path : options.paths) {
    tables_.push_back({path, open_table(path, names), 0, {}});
  }
}

void Recorder::choose_columns(const std::vector<std::string>& lists) {
  const ObservableSet& set = columns_.index().set();
  std::vector<bool> chosen(set.names().size(), false);
  std::unordered_set<std::string> expressions;
  const auto choose = [&](std::size_t column) {
    if (!chosen[column]) columns_.add(static_cast<int>(column));
    chosen[column] = true;
  };
  choose(0);  // without the time a table says little
  for (std::size_t i = 0; lists.empty() && i < set.default_count(); ++i) choose(i);
  for (const std::string& text : split_quantities(lists)) {
    const auto found = chosen_quantities(text, set.names(), columns_.index());
    if (!found) {
      throw Failure(ExitCode::usage, fmt::format("--columns: {}", to_text(found.errors())));
    }
    for (const int index : found->indices) choose(static_cast<std::size_t>(index));
    if (!found->expression || !expressions.insert(text).second) continue;
    const Errors faults = columns_.add(*found->expression, text);
    if (!faults.empty()) throw Failure(ExitCode::usage, "--columns: " + to_text(faults));
  }
}

bool Recorder::observe(const Simulation& simulation) {
  const std::int64_t steps = simulation.world.state().steps;
  if (tables_.empty()) return true;
  const bool has_row = steps % every_ == 0;
  if (!has_row && courses_.empty()) return true;
  columns_.follow(simulation, courses_, values_);
  if (!has_row) return true;
  for (double& value : values_) {
    if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
  }
  bool well = true;
  for (RecordedTable& table : tables_) {
    if (table.writer == nullptr) continue;
    well &= attempt(table, [&](TableWriter& writer) { writer.write_row(values_); });
  }
  ++rows_;
  return well;
}

bool Recorder::attempt(RecordedTable& table, const std::function<void(TableWriter&)>& action) {
  try {
    action(*table.writer);
    return true;
  } catch (const Failure& failure) {
    table.fault = failure.what();
  }
  try {
    const Salvage left = table.writer->salvage();
    table.rows = left.rows;
    if (!left.message.empty()) table.fault += "; " + left.message;
  } catch (const Failure& failure) {
    table.fault += fmt::format("; {}", failure.what());
  }
  table.writer.reset();
  return false;
}

void Recorder::finish() {
  bool out_of_memory = false;
  for (RecordedTable& table : tables_) {
    if (table.writer == nullptr) continue;
    try {
      if (!attempt(table, [](TableWriter& writer) { writer.finish(); })) continue;
      table.rows = rows_;
      table.writer.reset();
    } catch (const std::bad_alloc&) {
      out_of_memory = true;  // for this one; the next may need none
    }
  }
  if (out_of_memory) throw std::bad_alloc();
}

bool Recorder::is_writing() const {
  return std::any_of(tables_.begin(), tables_.end(),
                     [](const RecordedTable& table) { return table.writer != nullptr; });
}

}  // namespace sheave::command
