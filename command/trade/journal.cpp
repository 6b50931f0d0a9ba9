#include "command/trade/journal.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/input/content_hash.h"
#include "command/input/file.h"
#include "command/machine_info.h"
#include "command/output/file.h"
#include "command/terminal.h"
#include "command/trade/journal_check.h"

namespace sheave::command {
namespace {

using JournalJson = nlohmann::json;

/// Far more than any journal.
constexpr std::size_t most_bytes = std::size_t{256} << 20U;

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// JSON has neither infinity nor NaN.
JournalJson number(double value) {
  if (std::isfinite(value)) return value;
  return fmt::format("{}", value);
}
double number_of(const JournalJson& value) {
  return value.is_string() ? std::strtod(value.get<std::string>().c_str(), nullptr)
                           : value.get<double>();
}

JournalJson error_of(const measure::RunError& error) {
  return {number(error.position), number(error.position_end), number(error.tension),
          number(error.energy)};
}
measure::RunError error_from(const JournalJson& list) {
  return {number_of(list.at(0)), number_of(list.at(1)), number_of(list.at(2)),
          number_of(list.at(3))};
}

JournalJson spread_json(const measure::Spread& spread) {
  return {spread.median, spread.lower, spread.upper, spread.minimum, spread.count};
}
measure::Spread spread_from(const JournalJson& list) {
  return {list.at(0), list.at(1), list.at(2), list.at(3), list.at(4)};
}

JournalJson ladder_row_json(const LadderRow& row) {
  return {{"name", row.name},
          {"things", row.things},
          {"change", row.change},
          {"changed", row.changed},
          {"fault", row.fault},
          {"difference", {number(row.difference.position), number(row.difference.tension)}},
          {"seconds", spread_json(row.seconds)},
          {"row_solves", row.row_solves}};
}
LadderRow ladder_row_from(const JournalJson& own) {
  const JournalJson& difference = own.at("difference");
  return {own.at("name"),
          own.at("things"),
          own.at("change"),
          own.at("changed"),
          own.at("fault"),
          {number_of(difference.at(0)), number_of(difference.at(1))},
          spread_from(own.at("seconds")),
          own.at("row_solves")};
}

/// A line with everything but the settings, then a line for each of those.
std::string journal_text(const JournalJson& data) {
  const auto line_of = [](const JournalJson& json) {
    return json.dump(-1, ' ', false, JournalJson::error_handler_t::replace);
  };
  JournalJson head = data;
  head.erase("rows");
  std::string first = line_of(head);
  first.pop_back();
  json::ChecksumChain chain;
  std::string text = marked_line(chain, first + ",\"rows\":{");
  for (const auto& [name, row] : data.at("rows").items()) {
    text += marked_line(chain, line_of(name) + ":" + line_of(row) + ",");
  }
  return text;
}

/// The settings that decide the numbers of a ladder, as a key.
std::string ladder_key(const TradeSetting& setting) {
  return fmt::format("{} of {}", setting.name(), setting.step.dt);
}

}  // namespace

std::string trade_key(const Scene& scene, const TradeOptions& options) {
  ContentHash hash;
  hash.add(trade_journal_formats.marked);
  hash.add_program();
  hash.add(machine_info().cpu);
  hash.add(write_scene(scene));
  if (scene.start_state != nullptr) hash.add(to_bytes(*scene.start_state));
  hash.add(fmt::format("{} {}", options.repetitions, options.reference_seconds));
  for (const int substeps : options.grid.substeps) hash.add(fmt::format("{}", substeps));
  hash.add(options.grid.tolerances.empty() ? "" : "tolerance");  // decides the references
  return hash.text();
}

TradeJournal::TradeJournal(std::string path, const std::string& key)
    : path_(std::move(path)), data_(std::make_unique<JournalJson>(JournalJson::object())) {
  JournalJson& data = *data_;
  if (!path_.empty() && std::filesystem::exists(path_)) {
    // A pipe would be waited for without end.
    if (!std::filesystem::is_regular_file(path_)) {
      throw Failure(ExitCode::usage, path_ + ": is no file; a journal must be one");
    }
    const std::string text = checked_trade_journal(read_input(path_, most_bytes), path_);
    JournalJson found = JournalJson::parse(text, nullptr, false, true);
    if (found.at("key") == key) {
      data = std::move(found);
      data["format"] = trade_journal_formats.marked;
      print_note(fmt::format("{}: {} settings are known", path_,
                             data.value("rows", JournalJson::object()).size()));
      return;
    }
    print_note(path_ + ": belongs to another scene, setting, machine or build; started again");
  }
  data["format"] = trade_journal_formats.marked;
  data["key"] = key;
  data["rows"] = JournalJson::object();
}

TradeJournal::~TradeJournal() {
  try {
    save();
  } catch (const std::exception& error) {
    print_warning(error.what());
  }
}

void TradeJournal::keep(const measure::Reference& reference, double motion) {
  JournalJson differences = JournalJson::array();
  for (const double difference : reference.differences) differences.push_back(number(difference));
  (*data_)["reference"] = {{"substeps", reference.substeps},
                           {"integrator", static_cast<int>(reference.integrator)},
                           {"tolerance", reference.tolerance},
                           {"order", number(reference.order)},
                           {"good", reference.good},
                           {"motion", number(motion)},
                           {"estimate", error_of(reference.estimate)},
                           {"differences", std::move(differences)}};
  changed_ = true;
  save();
}

std::optional<std::pair<measure::Reference, double>> TradeJournal::reference() const {
  if (!data_->contains("reference")) return {};
  const JournalJson& own = data_->at("reference");
  measure::Reference reference;
  reference.substeps = own.at("substeps");
  reference.integrator = static_cast<IntegratorKind>(own.at("integrator").get<int>());
  reference.tolerance = own.value("tolerance", 0.0);
  reference.order = number_of(own.at("order"));
  reference.good = own.at("good");
  reference.estimate = error_from(own.at("estimate"));
  for (const JournalJson& difference : own.at("differences")) {
    reference.differences.push_back(number_of(difference));
  }
  return std::pair(std::move(reference), number_of(own.at("motion")));
}

void TradeJournal::keep(const TradeRow& row) {
  JournalJson own{{"fault", row.fault}};
  if (row.measured()) {
    own["error"] = error_of(row.error);
    own["stretch"] = number(row.stretch);
    own["length_error"] = number(row.length_error);
    own["row_solves"] = row.row_solves;
    own["fallbacks"] = row.fallbacks;
    own["run_seconds"] = row.run_seconds;
  }
  (*data_)["rows"][row.setting.name()] = std::move(own);
  changed_ = true;
}

bool TradeJournal::restore(TradeRow& row) const {
  const JournalJson& rows = data_->at("rows");
  const auto found = rows.find(row.setting.name());
  if (found == rows.end()) return false;
  row.fault = found->at("fault");
  if (!row.fault.empty()) return true;
  row.error = error_from(found->at("error"));
  row.stretch = number_of(found->at("stretch"));
  row.length_error = number_of(found->at("length_error"));
  row.row_solves = found->at("row_solves");
  row.fallbacks = found->at("fallbacks");
  row.run_seconds = found->at("run_seconds");
  return true;
}

void TradeJournal::keep_times(const std::vector<TradeRow>& rows) {
  JournalJson times = JournalJson::object();
  for (const TradeRow& row : rows) {
    if (row.skipped.empty()) {
      times[row.setting.name()] = {spread_json(row.seconds), row.timed_alone, row.fault};
    }
  }
  (*data_)["times"] = std::move(times);
  changed_ = true;
  save();
}

bool TradeJournal::restore_times(std::vector<TradeRow>& rows) const {
  if (!data_->contains("times")) return false;
  const JournalJson& times = data_->at("times");
  for (const TradeRow& row : rows) {
    if (row.measured() && !times.contains(row.setting.name())) return false;
  }
  for (TradeRow& row : rows) {
    if (!row.measured()) continue;
    const JournalJson& own = times.at(row.setting.name());
    row.seconds = spread_from(own.at(0));
    row.timed_alone = own.at(1);
    row.fault = own.at(2);
  }
  return true;
}

void TradeJournal::keep(const TradeLadder& ladder) {
  JournalJson rows = JournalJson::array();
  for (const LadderRow& row : ladder.rows) rows.push_back(ladder_row_json(row));
  (*data_)["ladder"] = {{"setting", ladder_key(ladder.setting)},
                        {"seconds", spread_json(ladder.seconds)},
                        {"row_solves", ladder.row_solves},
                        {"rows", std::move(rows)},
                        {"absent", ladder.absent}};
  changed_ = true;
  save();
}

std::optional<TradeLadder> TradeJournal::ladder(const TradeSetting& setting) const {
  if (!data_->contains("ladder")) return {};
  const JournalJson& own = data_->at("ladder");
  if (own.at("setting") != ladder_key(setting)) return {};
  TradeLadder ladder{setting, 0.0, spread_from(own.at("seconds")), own.at("row_solves"), {},
                     {},      {}};
  for (const JournalJson& row : own.at("rows")) ladder.rows.push_back(ladder_row_from(row));
  ladder.absent = own.at("absent").get<std::vector<std::string>>();
  return ladder;
}

void TradeJournal::save() {
  if (path_.empty() || !changed_) return;
  write_file(path_, journal_text(*data_));
  changed_ = false;
  saved_at_ = now_seconds();
}

void TradeJournal::save_sometimes() {
  if (now_seconds() - saved_at_ > 1.0) save();
}

}  // namespace sheave::command
