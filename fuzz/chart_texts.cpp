#include "fuzz/chart_texts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "command/bench/table.h"
#include "command/plot/data.h"
#include "command/stress/table.h"
#include "command/sweep/table.h"
#include "command/trade/table.h"
#include "fuzz/target.h"
#include "scenes/json/text.h"

namespace sheave::fuzz {
namespace {

/// Returns the texts in turn, cyclically.
class InTurn {
 public:
  explicit InTurn(const std::vector<std::string>& texts) : texts_(texts) {}
  std::string operator()() {
    return texts_.empty() ? std::string() : texts_[next_++ % texts_.size()];
  }

 private:
  const std::vector<std::string>& texts_;
  std::size_t next_ = 0;
};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

command::GnuplotScript run_chart(InTurn& next, command::ChartFormat format) {
  std::vector<command::PlotRun> runs(2);
  for (command::PlotRun& run : runs) {
    run.label = next();
    run.names = {next(), next(), next(), "a.x"};
    run.units = {"", "", next(), "m"};
    run.values = {{0.0, 1.0, 2.0}, {none, 1.0, 2.0}, {1e300, -1e300, none}, {none, none, none}};
    run.events = {{0.5, next()}, {1.5, next()}};
  }
  return command::plot_script(runs, next(), format);
}

command::GnuplotScript sweep_chart(InTurn& next, std::size_t axes, command::ChartFormat format) {
  command::SweepTable table;
  table.head.scene = next();
  for (std::size_t a = 0; a < axes; ++a) table.head.axes.push_back(next());
  table.head.measures = {{next(), next(), {}}, {next(), "", {}}};
  table.head.runs = 4;
  for (std::size_t i = 0; i < table.head.runs; ++i) {
    command::SweepRow row;
    row.run = i;
    for (std::size_t a = 0; a < axes; ++a) row.values.push_back(next());
    row.measured = {static_cast<double>(i), i == 2 ? none : 7.0};
    row.doubt_of = next();
    row.message = next();
    table.rows.push_back(std::move(row));
  }
  return command::sweep_chart_script(table, format);
}

command::GnuplotScript trade_chart(InTurn& next, command::ChartFormat format) {
  command::TradeTable table;
  table.scene = next();
  table.dt = 0.01;
  for (int i = 0; i < 3; ++i) {
    command::TradeRow row;
    row.setting.step.substeps = 1 << i;
    row.seconds = {1e-3 / (1 + i), 0.9e-3 / (1 + i), 1.1e-3 / (1 + i), 0.8e-3 / (1 + i), 5};
    row.error.position = 1e-2 / (1 + i);
    if (i == 2) row.fault = next() + "fault";
    table.rows.push_back(std::move(row));
  }
  table.families.push_back({next(), {}});
  table.limits.push_back(next());
  return command::trade_chart_script(table, format);
}

command::GnuplotScript stress_chart(InTurn& next, command::ChartFormat format) {
  command::StressResult result;
  result.map.name = next();
  result.map.meaning = next();
  result.map.x = {next(), {1.0, 1e4}};
  result.map.y = {next(), {1.0 / 60.0}};
  result.outcomes.resize(2);
  result.outcomes[0].verdict = {measure::StressKind::wrong, 1.0, next()};
  result.outcomes[0].doubt = next();
  result.outcomes[1].verdict.error = 1e-9;
  return command::stress_script(result, format);
}

command::GnuplotScript bench_chart(InTurn& next, command::ChartFormat format) {
  command::BenchTable table;
  for (int i = 0; i < 2; ++i) {
    command::BenchRow row;
    row.scene = next();
    row.file = next();
    row.paper_source = next();
    row.paper_seconds = 1e-3;
    row.seconds = {1e-3, 0.9e-3, 1.1e-3, 0.8e-3, 5};
    row.error.position = 1e-5;
    table.rows.push_back(std::move(row));
  }
  return command::chart_script(table, format);
}

bool only_of(std::string_view text, std::string_view allowed) {
  return text.find_first_not_of(allowed) == std::string_view::npos;
}

/// Checks a line of the data block of texts: gnuplot stores such a line unchanged up to its end.
void require_text(std::string_view line) {
  require(line.starts_with('|'), "a text does not begin with the bar that keeps it a text");
  constexpr std::size_t most = 4 * 300 + 1;
  require(line.size() <= most, "a text is longer than a picture has room for");
  while (!line.empty()) {
    const std::size_t length = json::character_length(line);
    require(length > 0, "a text is no UTF-8");
    const auto first = static_cast<unsigned char>(line.front());
    const auto second = static_cast<unsigned char>(length > 1 ? line[1] : 0x80);
    require(first >= 0x20 && first != 0x7f && !(first == 0xc2 && second < 0xa0),
            "a text has a control character");
    line.remove_prefix(length);
  }
}

/// A line of commands without the contents of single quotes, which gnuplot does not interpret.
std::string without_constants(std::string_view line) {
  std::string code;
  bool quoted = false;
  for (const char c : line) {
    if (c == '\'') quoted = !quoted;
    if (!quoted) code += c;
  }
  require(!quoted, "a line ends within quotes");
  return code;
}

void require_command(std::string_view line) {
  const std::string code = without_constants(line);
  constexpr std::string_view alphabet =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_'$[](),.:?*<+- ";
  require(only_of(code, alphabet), "a command has a character that none of ours has: " + code);
  require(code.starts_with("set ") || code.starts_with("unset ") || code.starts_with("plot "),
          "a line is no command of ours: " + code);
  constexpr std::array<std::string_view, 16> forbidden{
      "system", "load", "call", "eval", "print", "output", "shell", "popen",
      "table",  "save", "fit ", "cd ",  "pause", "import", "stats", "macros"};
  for (const std::string_view word : forbidden) {
    require(code.find(word) == std::string::npos, "a command may do more than draw: " + code);
  }
  // In place of a file name, "<" reads the output of a program.
  for (std::size_t at = code.find('<'); at != std::string::npos; at = code.find('<', at + 1)) {
    require(at >= 3 && code.compare(at - 3, 5, "$3 < ") == 0,
            "a command may read from a program: " + code);
  }
}

}  // namespace

std::vector<command::GnuplotScript> charts_with(const std::vector<std::string>& texts,
                                                command::ChartFormat format) {
  InTurn next(texts);
  return {run_chart(next, format),      sweep_chart(next, 1, format), sweep_chart(next, 2, format),
          sweep_chart(next, 3, format), trade_chart(next, format),    stress_chart(next, format),
          bench_chart(next, format)};
}

void require_harmless(const std::string& script, const std::string& mark) {
  require(script.find('\0') == std::string::npos && script.find('\r') == std::string::npos,
          "a script has a null character or a carriage return");
  enum class Place { commands, texts, numbers } place = Place::commands;
  require(script.ends_with('\n'), "a script ends within a line");
  for (std::size_t begin = 0; begin < script.size();) {
    const std::size_t end = script.find('\n', begin);
    const std::string_view line = std::string_view(script).substr(begin, end - begin);
    begin = end + 1;
    if (place != Place::texts) {
      require(line.find(mark) == std::string_view::npos, "a text from outside is part of a script");
    }
    if (place != Place::commands) {
      // gnuplot ends a block at a line that only begins with its name.
      if (line.starts_with("end")) {
        require(line == "end", "a block is ended by what stands in it");
        place = Place::commands;
      } else if (place == Place::texts) {
        require_text(line);
      } else {
        require(only_of(line, "0123456789.eE+-Na "), "a block of numbers has something else");
      }
    } else if (line == "$texts << end") {
      place = Place::texts;
    } else if (line.starts_with("$data") && line.ends_with(" << end")) {
      require(only_of(line.substr(5, line.size() - 12), "0123456789"), "a block has another name");
      place = Place::numbers;
    } else {
      require_command(line);
    }
  }
  require(place == Place::commands, "a script ends within a block");
}

}  // namespace sheave::fuzz
