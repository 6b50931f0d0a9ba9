#include "command/run/recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include <fnmatch.h>

#include <fmt/format.h>

#include "command/failure.h"

namespace sheave::command {

Recorder::Recorder(const RecordOptions& options, const Simulation& simulation)
    : observables_(simulation, options.patterns.empty() ? ObservableSet::Extent::columns
                                                        : ObservableSet::Extent::everything),
      every_(options.every) {
  if (options.paths.empty()) return;
  choose_columns(options.patterns);
  values_.resize(columns_.size());
  std::vector<std::string> names;
  for (const int column : columns_) {
    names.push_back(observables_.names()[static_cast<std::size_t>(column)]);
  }
  for (const std::string& path : options.paths) {
    tables_.push_back({path, open_table(path, names), 0, {}});
  }
}

void Recorder::choose_columns(const std::vector<std::string>& patterns) {
  const std::vector<std::string>& names = observables_.names();
  std::vector<bool> chosen(names.size(), false);
  const auto choose = [&](std::size_t column) {
    if (!chosen[column]) columns_.push_back(static_cast<int>(column));
    chosen[column] = true;
  };
  choose(0);  // without the time a table says little
  for (std::size_t i = 0; patterns.empty() && i < observables_.default_count(); ++i) choose(i);
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (::fnmatch(pattern.c_str(), names[i].c_str(), 0) != 0) continue;
      choose(i);
      found = true;
    }
    if (found) continue;
    const Result<int> index = observables_.index_of(pattern);
    throw Failure(ExitCode::usage, fmt::format("--columns: {}", to_text(index.errors())));
  }
}

bool Recorder::observe(const Simulation& simulation) {
  const std::int64_t steps = simulation.world.state().steps;
  if (tables_.empty() || steps % every_ != 0) return true;
  observables_.sample(simulation, columns_, values_);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const bool unknown = steps == 0 && !observables_.known_at_start(columns_[i]);
    if (unknown || !std::isfinite(values_[i])) {
      values_[i] = std::numeric_limits<double>::quiet_NaN();
    }
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
