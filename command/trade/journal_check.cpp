#include "command/trade/journal_check.h"

#include <limits>

#include "command/input/json_check.h"
#include "engine/step_settings.h"

namespace sheave::command {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
/// Up to here doubles, which JSON's numbers are read as, count one by one.
constexpr std::int64_t largest_count = std::int64_t{1} << 53U;

JsonRule finite() { return json_number(-largest, largest); }
JsonRule positive_or_zero() { return json_number(0.0, largest); }
/// Numbers that may be infinite or none.
JsonRule any_number() { return json_number(-largest, largest, true); }
JsonRule count() { return json_integer(0, largest_count); }

JsonRule run_error() {
  return json_tuple({any_number(), any_number(), any_number(), any_number()});
}

JsonRule spread() {
  const JsonRule samples = json_integer(0, std::numeric_limits<int>::max());
  return json_tuple({finite(), finite(), finite(), finite(), samples});
}

JsonRule reference() {
  constexpr int most_substeps = 100'000 * 4096;  // of --substeps, doubled twelve times
  return json_object({{"substeps", json_integer(1, most_substeps)},
                      {"integrator", json_integer(0, integrator_names.size() - 1)},
                      {"tolerance", positive_or_zero(), false},
                      {"order", any_number()},
                      {"good", json_boolean()},
                      {"motion", any_number()},
                      {"estimate", run_error()},
                      {"differences", json_list(any_number())}});
}

/// A setting that was measured, or why it could not be.
JsonRule setting_row() {
  const JsonRule measured = json_object({{"fault", json_text()},
                                         {"error", run_error()},
                                         {"stretch", any_number()},
                                         {"length_error", any_number()},
                                         {"row_solves", positive_or_zero()},
                                         {"fallbacks", count()},
                                         {"run_seconds", positive_or_zero()}});
  const JsonRule at_fault = json_object({{"fault", json_text()}});
  return [=](const JsonCheck& check, json::NodeId node) {
    const json::NodeId fault = check.document.kind(node) == json::Kind::object
                                   ? check.document.member(node, "fault")
                                   : json::no_node;
    const bool told = fault != json::no_node && check.document.kind(fault) == json::Kind::string &&
                      !check.document.string(fault).empty();
    (told ? at_fault : measured)(check, node);
  };
}

JsonRule ladder() {
  const JsonRule row = json_object({{"name", json_text()},
                                    {"things", json_text()},
                                    {"change", json_text()},
                                    {"changed", json_integer(0, std::numeric_limits<int>::max())},
                                    {"fault", json_text()},
                                    {"difference", json_tuple({any_number(), any_number()})},
                                    {"seconds", spread()},
                                    {"row_solves", positive_or_zero()}});
  return json_object({{"setting", json_text()},
                      {"seconds", spread()},
                      {"row_solves", positive_or_zero()},
                      {"rows", json_list(row)},
                      {"absent", json_list(json_text())}});
}

}  // namespace

std::string checked_trade_journal(std::string_view text, const std::string& path) {
  const JsonRule journal =
      json_object({{"format", json_text()},
                   {"key", json_text()},
                   {"rows", json_map(setting_row())},
                   {"reference", reference(), false},
                   {"times", json_map(json_tuple({spread(), json_boolean(), json_text()})), false},
                   {"ladder", ladder(), false}});
  JournalLines lines = read_journal_lines(text, path);
  std::string closed = lines.marked ? closed_journal(lines, "}}") : std::string();
  if (closed.empty()) {
    // Earlier versions wrote whole JSON.
    closed = text;
    lines.cut = false;
  }
  check_journal(lines, closed, path, trade_journal_formats, journal);
  return closed;
}

}  // namespace sheave::command
