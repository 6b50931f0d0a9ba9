#include "command/input/case_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/input/json_check.h"
#include "engine/field_check.h"
#include "scenes/csv.h"

namespace sheave::command {
namespace {

constexpr std::string_view name_column = "case";

[[noreturn]] void bad_table(const std::string& path, std::size_t line, const std::string& what) {
  throw Failure(ExitCode::bad_scene, fmt::format("{}:{}:1: {}", path, line, what));
}

/// The value, or a Failure with its place in the table.
template <class Value>
Value sound(const std::string& path, std::variant<Value, CsvFault> found) {
  const auto* const fault = std::get_if<CsvFault>(&found);
  if (fault != nullptr) throw Failure(ExitCode::bad_scene, fault->text(path));
  return std::get<Value>(std::move(found));
}

/// JSON does not allow ".5" and "+5", which tables of other programs have.
std::string value_of(const std::string& cell) {
  std::string_view digits = cell;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double number = 0.0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, number);
  return error == std::errc{} && end == last && std::isfinite(number) ? number_text(number) : cell;
}

void check_columns(const std::string& path, std::size_t line,
                   const std::vector<std::string>& names) {
  if (names.front() != name_column) {
    bad_table(
        path, line,
        "the first column must be \"case\", the names of the cases; the others are parameters "
        "or settings, as in: case,load,/bodies/hook/mass");
  }
  if (names.size() < 2) {
    bad_table(path, line, "there must be a second column: a parameter or a setting of the scene");
  }
  if (names.size() > most_case_columns) {
    bad_table(path, line, fmt::format("there may be at most {} columns", most_case_columns));
  }
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (name.find('=') != std::string::npos) {
      bad_table(path, line, fmt::format("the name \"{}\" must not contain =", name));
    }
    if (!known.insert(name).second) {
      bad_table(path, line, fmt::format("the column \"{}\" is there twice", name));
    }
  }
}

/// Collects cases and refuses those that have no name of their own.
class CaseList {
 public:
  explicit CaseList(const std::string& path) : path_(path) {}

  LoadCase& add(const std::string& name, std::size_t line) {
    if (name.empty()) bad_table(path_, line, "the case has no name");
    if (!names_.insert(name).second) {
      bad_table(path_, line, fmt::format("the case \"{}\" is there twice", name));
    }
    if (cases_.size() == most_cases) {
      bad_table(path_, line, fmt::format("there may be at most {} cases", most_cases));
    }
    return cases_.emplace_back(LoadCase{name, {}});
  }

  std::vector<LoadCase> take() {
    if (cases_.empty()) bad_table(path_, 1, "the table has no case");
    return std::move(cases_);
  }

 private:
  const std::string& path_;
  std::set<std::string> names_;
  std::vector<LoadCase> cases_;
};

std::vector<LoadCase> cases_of_csv(std::string_view text, const std::string& path) {
  CaseList list(path);
  CsvReader reader(text);
  const std::vector<std::string> names = sound(path, reader.names());
  check_columns(path, reader.line(), names);
  while (sound(path, reader.next())) {
    const std::vector<CsvCell>& cells = reader.cells();
    LoadCase& one = list.add(cells.front().text, reader.line());
    for (std::size_t c = 1; c < cells.size(); ++c) {
      if (cells[c].text.empty()) continue;
      // No setting is such a text.
      if (has_decimal_comma(cells[c].text)) (void)sound(path, reader.number(c));
      one.values.emplace_back(names[c], value_of(cells[c].text));
    }
  }
  return list.take();
}

std::vector<LoadCase> cases_of_json(std::string_view text, const std::string& path) {
  json::Limits limits;
  limits.bytes = most_case_bytes;
  const json::Document document = read_json(text, path, limits);
  const auto line_of = [&](json::NodeId node) {
    return static_cast<std::size_t>(document.location(document.offset(node)).line);
  };
  if (document.kind(document.root()) != json::Kind::array) {
    bad_table(path, 1, R"(must be a list of cases, as in [{"case": "full", "load": 500}])");
  }
  CaseList list(path);
  for (const json::NodeId node : document.children(document.root())) {
    if (document.kind(node) != json::Kind::object) {
      bad_table(path, line_of(node), R"(must be an object, as in {"case": "full", "load": 500})");
    }
    const json::NodeId name = document.member(node, name_column);
    if (name == json::no_node || document.kind(name) != json::Kind::string) {
      bad_table(path, line_of(node), "\"case\" must be a text, the name of the case");
    }
    LoadCase& one = list.add(document.string(name), line_of(node));
    std::vector<std::string> keys{std::string(name_column)};
    for (const json::NodeId member : document.children(node)) {
      if (member == name) continue;
      keys.push_back(document.key(member));
      const std::uint32_t begin = document.offset(member);
      one.values.emplace_back(keys.back(), text.substr(begin, document.end_offset(member) - begin));
    }
    // A case without settings is the scene as it is.
    if (keys.size() > 1) check_columns(path, line_of(node), keys);
  }
  return list.take();
}

}  // namespace

std::vector<LoadCase> read_cases(const std::string& path) {
  const bool csv = path.ends_with(".csv");
  if (!csv && !path.ends_with(".json")) {
    throw Failure(ExitCode::usage,
                  path + ": the name of a table of cases must end in .csv or .json");
  }
  const std::string text = read_input(path, most_case_bytes);
  return csv ? cases_of_csv(text, path) : cases_of_json(text, path);
}

}  // namespace sheave::command
