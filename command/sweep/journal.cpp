#include "command/sweep/journal.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/input/json_check.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

using Json = nlohmann::ordered_json;

constexpr double largest_double = std::numeric_limits<double>::max();
/// Enough for the most runs that a sweep may have.
constexpr std::size_t most_journal_bytes = std::size_t{256} << 20U;
constexpr std::size_t most_journal_values = 100'000'000;

json::Limits journal_limits() {
  json::Limits limits;
  limits.bytes = most_journal_bytes;
  limits.values = most_journal_values;
  return limits;
}

/// JSON has neither infinity nor NaN.
Json number_or_nothing(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
double number_of(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

JsonRule journal_rule() {
  const auto most = static_cast<std::int64_t>(most_sweep_runs);
  const JsonRule run = json_integer(0, most - 1);
  const JsonRule any = json_optional(json_number(-largest_double, largest_double));
  const JsonRule row = json_object({{"run", run},
                                    {"values", json_list(json_text())},
                                    {"status", json_integer(0, sweep_status_names.size() - 1)},
                                    {"measured", json_list(any)},
                                    {"end", json_number(0.0, largest_double)},
                                    {"doubt", any},
                                    {"doubt_of", json_text()},
                                    {"message", json_text()}});
  const JsonRule part = json_integer(1, most);
  const JsonRule measure = json_object({{"name", json_text()}, {"unit", json_text()}});
  return json_object({{"format", json_text()},
                      {"key", json_text()},
                      {"scene", json_text()},
                      {"axes", json_list(json_text())},
                      {"axis_units", json_list(json_text()), false},
                      {"measures", json_list(measure)},
                      {"runs", json_integer(1, most)},
                      {"shard", json_tuple({part, part})},
                      {"of", json_word(sweep_kind_names), false},
                      {"tune", json_boolean(), false},
                      {"rows", json_list(row)}});
}

/// Everything but the rows and the end.
std::string journal_head(const SweepHead& head) {
  Json measures = Json::array();
  for (const SweepMeasure& measure : head.measures) {
    measures.push_back({{"name", measure.name}, {"unit", measure.unit}});
  }
  Json json{{"format", sweep_journal_formats.marked},
            {"key", head.key},
            {"scene", head.scene},
            {"axes", head.axes},
            {"axis_units", head.axis_units},
            {"measures", std::move(measures)},
            {"runs", head.runs},
            {"shard", {head.shard.index, head.shard.count}}};
  // Journals of runs have the form that they had before there were other kinds.
  if (head.kind != SweepKind::run) json["of"] = name_of(head.kind);
  if (head.tune) json["tune"] = true;
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();
  return text + ",\"rows\":[";
}

std::string row_line(const SweepRow& row) {
  Json measured = Json::array();
  for (const double value : row.measured) measured.push_back(number_or_nothing(value));
  const Json json{{"run", row.run},
                  {"values", row.values},
                  {"status", static_cast<int>(row.status)},
                  {"measured", std::move(measured)},
                  {"end", row.end},
                  {"doubt", number_or_nothing(row.doubt)},
                  {"doubt_of", row.doubt_of},
                  {"message", row.message}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + ",";
}

SweepRow row_of(const Json& json) {
  SweepRow row;
  row.run = json.at("run");
  row.values = json.at("values").get<std::vector<std::string>>();
  row.status = static_cast<SweepStatus>(json.at("status").get<int>());
  for (const Json& value : json.at("measured")) row.measured.push_back(number_of(value));
  row.end = json.at("end");
  row.doubt = number_of(json.at("doubt"));
  row.doubt_of = json.at("doubt_of");
  row.message = json.at("message");
  return row;
}

[[noreturn]] void bad_row(const std::string& path, std::size_t line, const std::string& what) {
  throw Failure(ExitCode::bad_scene, fmt::format("{}:{}:1: {}", path, line, what));
}

/// Checks that concern several values at once.
void check_rows(const SweepTable& table, const std::string& path) {
  const SweepHead& head = table.head;
  if (head.shard.index > head.shard.count) bad_row(path, 1, "/shard: there is no such part");
  std::vector<bool> seen(head.runs, false);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const SweepRow& row = table.rows[i];
    const std::size_t line = i + 2;
    if (row.run >= head.runs || !head.shard.has(row.run)) {
      bad_row(path, line, fmt::format("run {} does not belong to this shard", row.run));
    }
    if (seen[row.run]) bad_row(path, line, fmt::format("run {} is in the file twice", row.run));
    seen[row.run] = true;
    if (row.values.size() != head.axes.size()) {
      bad_row(path, line, fmt::format("/values: must have {} elements", head.axes.size()));
    }
    if (row.measured.size() != head.measures.size()) {
      bad_row(path, line, fmt::format("/measured: must have {} elements", head.measures.size()));
    }
  }
}

/// `text`: of the file, in which those lines are.
SweepTable parsed(const JournalLines& lines, const std::string& text, const std::string& path) {
  const std::string closed = closed_journal(lines, "]}");
  const std::string& whole = closed.empty() ? text : closed;
  check_journal(lines, whole, path, sweep_journal_formats, journal_rule(), journal_limits());
  const Json json = Json::parse(whole, nullptr, false, true);
  SweepTable table;
  SweepHead& head = table.head;
  head.key = json.at("key");
  head.scene = json.at("scene");
  head.axes = json.at("axes").get<std::vector<std::string>>();
  // Journals of earlier versions have no units of axes.
  if (json.contains("axis_units")) {
    head.axis_units = json.at("axis_units").get<std::vector<std::string>>();
  }
  head.axis_units.resize(head.axes.size());
  for (const Json& measure : json.at("measures")) {
    head.measures.push_back({measure.at("name"), measure.at("unit")});
  }
  head.runs = json.at("runs");
  head.shard = {json.at("shard").at(0), json.at("shard").at(1)};
  const auto kind = std::find(sweep_kind_names.begin(), sweep_kind_names.end(),
                              json.value("of", std::string(name_of(SweepKind::run))));
  head.kind = static_cast<SweepKind>(kind - sweep_kind_names.begin());
  head.tune = json.value("tune", false);
  for (const Json& row : json.at("rows")) table.rows.push_back(row_of(row));
  check_rows(table, path);
  return table;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A pipe would be waited for without end.
bool is_regular_file(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

[[noreturn]] void io_failure(const std::string& path, const char* what) {
  throw Failure(ExitCode::io, fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

}  // namespace

std::string task_text(const SweepHead& head) {
  return fmt::format("a {} of {}", head.tune ? "tune" : "sweep",
                     head.kind == SweepKind::run ? "runs" : name_of(head.kind));
}

SweepTable read_sweep_journal(const std::string& path) {
  const std::string text = read_input(path, most_journal_bytes);
  return parsed(read_journal_lines(text, path), text, path);
}

SweepJournal::SweepJournal(std::string path, const SweepHead& head, std::vector<SweepRow>& known)
    : path_(std::move(path)) {
  if (path_.empty()) return;
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) io_failure(path_, "cannot be opened");
  if (!is_regular_file(descriptor_)) {
    ::close(std::exchange(descriptor_, -1));
    throw Failure(ExitCode::usage, path_ + ": is no file; a journal must be one");
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(std::exchange(descriptor_, -1));
    throw Failure(ExitCode::usage, path_ +
                                       ": another process writes this file; each sweep, each "
                                       "shard and each tune needs a journal of its own");
  }
  try {
    const std::string text = read_input(path_, most_journal_bytes);
    const std::string head_line = journal_head(head);
    json::ChecksumChain first;
    // Not even the first line: killed at the very start.
    const bool fresh =
        text.find('\n') == std::string::npos && marked_line(first, head_line).starts_with(text);
    std::size_t size = 0;
    if (!fresh) {
      const JournalLines lines = read_journal_lines(text, path_);
      SweepTable table = parsed(lines, text, path_);
      if (table.head.kind != head.kind || table.head.tune != head.tune) {
        throw Failure(ExitCode::usage,
                      fmt::format("{}: is the journal of {}, and this is {}; name another file, or "
                                  "remove this one",
                                  path_, task_text(table.head), task_text(head)));
      }
      // The key has the program in it: one without marks is of another.
      if (!lines.marked || table.head.key != head.key ||
          table.head.shard.index != head.shard.index ||
          table.head.shard.count != head.shard.count) {
        throw Failure(ExitCode::usage, path_ +
                                           ": belongs to another scene, plan, shard or build of "
                                           "the program; name another file, or remove this one");
      }
      print_note(fmt::format("{}: {} runs are known", path_, table.rows.size()));
      known = std::move(table.rows);
      size = lines.bytes;
      chain_ = lines.chain;
    }
    if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) io_failure(path_, "cannot be cut");
    if (::lseek(descriptor_, 0, SEEK_END) < 0) io_failure(path_, "is no file");
    if (fresh) write(head_line);
    finish();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

SweepJournal::~SweepJournal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SweepJournal::write(const std::string& line) {
  const std::string text = marked_line(chain_, line);
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) io_failure(path_, "cannot be written");
    done += static_cast<std::size_t>(count);
  }
}

void SweepJournal::keep(const SweepRow& row) {
  if (descriptor_ < 0) return;
  write(row_line(row));
  if (seconds_now() - synced_at_ > 1.0) finish();
}

void SweepJournal::finish() {
  if (descriptor_ < 0) return;
  if (::fdatasync(descriptor_) != 0) io_failure(path_, "cannot be written");
  synced_at_ = seconds_now();
}

}  // namespace sheave::command
