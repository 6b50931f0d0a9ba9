// Texts from outside stay texts: whatever names, titles, columns, files and journals hold, no
// program but gnuplot starts, no file but the picture appears, and the picture does.

#include "tests/support/hostile_text.h"

#include <chrono>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/output/gnuplot_script.h"
#include "command/scene_options.h"
#include "command/sweep/journal.h"
#include "command/sweep/table.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "command/text/table.h"
#include "command/trade/table.h"
#include "tests/command/journal_text.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"
#include "tests/command/watched_run.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

// A text that a program meets cannot become code: only constants can, which the compiler sees.
static_assert(!std::is_constructible_v<command::GnuplotPiece, std::string>);
static_assert(!std::is_constructible_v<command::GnuplotPiece, std::string_view>);
static_assert(!std::is_constructible_v<command::GnuplotCode, std::string>);

bool has_gnuplot_here() {
  static const bool found = std::system("gnuplot --version > /dev/null 2>&1") == 0;  // NOLINT
  return found;
}

/// Runs the command in a folder, and looks at what comes of it.
class HostileText : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_gnuplot_here()) GTEST_SKIP() << "no gnuplot";
  }

  void draws(const std::vector<std::string>& arguments, const std::string& picture) {
    const ProcessResult result = runs.run(arguments, {picture});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(runs.contents.front().size(), 3000U) << result.err;
    ++drawn;
  }
  void TearDown() override {
    EXPECT_EQ(runs.gnuplots(), drawn) << "the library does not tell of programs";
  }

  WatchedRuns runs;
  TemporaryFolder& folder = runs.folder;
  int drawn = 0;
};

/// Without what ends a word of a command line.
std::string word_of(std::string text) {
  std::erase(text, '\0');
  constexpr std::size_t most = 100'000;  // Linux takes 128 KiB
  return text.substr(0, most);
}

/// All hostile texts, so many together.
std::vector<std::vector<std::string>> groups_of(std::size_t size) {
  std::vector<std::vector<std::string>> groups;
  for (const std::string& text : hostile_texts()) {
    if (groups.empty() || groups.back().size() == size) groups.emplace_back();
    groups.back().push_back(text);
  }
  return groups;
}

TEST_F(HostileText, NameOfAScene) {
  json scene = json::parse(atwood_scene);
  scene["duration"] = 0.05;
  for (const std::string& name : {std::string("x\nsystem(\"touch pwned\")\n#"), std::string("'x\\"),
                                  std::string("`touch pwned`\x1a")}) {
    scene["name"] = name;
    const std::string path = folder.write("scene.json", scene.dump());
    draws({"run", path, "-q", "--plot", "rope.0.tension", "--plot-file", folder.path("a.svg")},
          "a.svg");
  }
}

TEST_F(HostileText, TitlesAndLabels) {
  const std::string table = folder.write("a.csv", "t,y\n0,1\n1,2\n");
  for (const auto& texts : groups_of(8)) {
    std::vector<std::string> arguments{"plot"};
    arguments.resize(1 + texts.size(), table);
    arguments.insert(arguments.end(), {"-y", "y", "-o", folder.path("a.svg")});
    for (const std::string& text : texts) {
      // Commas part labels.
      std::string label = word_of(text) + ".";
      std::erase(label, ',');
      arguments.push_back("--label=" + label);
    }
    arguments.push_back("--title=" + word_of(texts[texts.size() / 4]));
    draws(arguments, "a.svg");
  }
}

TEST_F(HostileText, ColumnsOfATable) {
  for (const auto& texts : groups_of(16)) {
    std::string names = "t";
    std::string row = "0";
    for (const std::string& text : texts) {
      std::string name;
      // A line of a table ends at its line break, quoted or not.
      for (const char c : text) name += c == '"' ? "\"\"" : (c == '\n' ? "" : std::string(1, c));
      names += ",\"" + name + "\"";
      row += ",1";
    }
    const std::string path = folder.write("a.csv", names + "\n" + row + "\n");
    draws({"plot", path, "-y", "*", "-o", folder.path("a.svg")}, "a.svg");
  }
}

/// A file of NumPy's with a column of each name, without the quotes that would end it there.
std::string npy_with(const std::vector<std::string>& names) {
  std::string header = "{'descr': [";
  for (std::string name : names) {
    std::erase(name, '\'');
    header += "('" + name + "', '<f8'), ";
  }
  header += "], 'fortran_order': False, 'shape': (2,)}\n";
  std::string file("\x93NUMPY\x02\x00", 8);
  for (unsigned i = 0; i < 4; ++i) file += static_cast<char>(header.size() >> (8 * i));
  return file + header + std::string(2 * names.size() * sizeof(double), '\0');
}

TEST_F(HostileText, ColumnsOfAnArray) {
  for (std::vector<std::string> names : groups_of(16)) {
    names.insert(names.begin(), "t");
    const std::string path = folder.write("a.npy", npy_with(names));
    draws({"plot", path, "-y", "*", "-o", folder.path("a.svg")}, "a.svg");
  }
}

TEST_F(HostileText, NamesOfFiles) {
  for (const auto& texts : groups_of(8)) {
    std::vector<std::string> arguments{"plot"};
    std::string name;
    for (const std::string& text : texts) {
      if (text.find('/') != std::string::npos || text.size() > 100) continue;
      name = "x" + word_of(text);
      arguments.push_back(folder.write(name + ".csv", "t,y\n0,1\n1,2\n"));
    }
    const std::vector<std::string> tables(arguments.begin() + 1, arguments.end());
    if (tables.empty()) continue;
    arguments.insert(arguments.end(), {"-y", "y", "-o", folder.path(name + ".svg")});
    draws(arguments, name + ".svg");
    for (const std::string& table : tables) std::filesystem::remove(table);
  }
}

/// A journal of four runs; JSON is UTF-8.
std::string journal_with(const std::vector<std::string>& texts, std::size_t axes) {
  std::size_t next = 0;
  const auto text = [&] { return texts[next++ % texts.size()]; };
  json head{{"format", command::sweep_journal_formats.marked}, {"key", "1"}, {"scene", text()}};
  head["axes"] = json::array();
  head["measures"] = json::array({json::object({{"name", text()}, {"unit", text()}})});
  head["runs"] = 4;
  head["shard"] = json::array({1, 1});
  for (std::size_t a = 0; a < axes; ++a) head["axes"].push_back(text());
  const auto line = [](const json& value) {
    return value.dump(-1, ' ', true, json::error_handler_t::replace);
  };
  std::string journal = line(head);
  journal.back() = ',';
  journal += "\"rows\":[\n";
  for (int run = 0; run < 4; ++run) {
    json row{{"run", run}, {"status", 0}, {"end", 0.1}, {"doubt", 0.0}};
    row["values"] = json::array();
    row["measured"] = json::array({1.0});
    row["doubt_of"] = text();
    row["message"] = text();
    for (std::size_t a = 0; a < axes; ++a) row["values"].push_back(text());
    journal += line(row) + ",\n";
  }
  return with_checksums(journal);
}

TEST_F(HostileText, JournalsOfSweeps) {
  std::size_t axes = 0;
  for (const auto& texts : groups_of(16)) {
    axes = axes % 3 + 1;
    const std::string path = folder.write("a.sweep", journal_with(texts, axes));
    draws({"merge", path, "--chart", folder.path("a.svg")}, "a.svg");
  }
}

/// A gnuplot that never ends, nor does what it has started.
TEST(Gnuplot, AnInterruptEndsAHangingGnuplot) {
  const TemporaryFolder folder;
  const std::string table = folder.write("a.csv", "t,y\n0,1\n1,2\n");
  std::filesystem::create_directory(folder.path("bin"));
  const std::string started = folder.path("started");
  const std::string gnuplot = folder.write(
      "bin/gnuplot", "#!/bin/sh\nsleep 100000 &\necho $! > '" + started + ".new'\nmv '" + started +
                         ".new' '" + started + "'\nsleep 100000\n");
  std::filesystem::permissions(gnuplot, std::filesystem::perms::owner_all);
  const char* const path = std::getenv("PATH");
  Process plot({"plot", table, "-y", "y", "-o", folder.path("a.svg")},
               {.environment = {"PATH=" + folder.path("bin") + ":" + (path ? path : "")}});
  ASSERT_TRUE(plot.wait_until([&] { return std::filesystem::exists(started); }));
  const int grandchild = std::stoi(read_file(started));
  plot.send(SIGINT);
  const ProcessResult result = plot.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_THAT(folder.entries(), ElementsAre("a.csv", "bin", "started"));
  // The system may take a while for it.
  const auto has_ended = [&] {
    const std::string state = read_file("/proc/" + std::to_string(grandchild) + "/stat");
    return state.empty() || state.find(") Z ") != std::string::npos;
  };
  while (!has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

// gnuplot warns of an empty range on every chart of one value: that was told where the disk was
// full.
TEST(Gnuplot, AFullDiskIsReportedAsSuch) {
  if (!has_gnuplot_here()) GTEST_SKIP() << "no gnuplot";
  const TemporaryFolder folder;
  const std::string table = folder.write("a.csv", "t,y\n0,1\n1,1\n");
  bool told = false;
  for (int first = 1; first < 20 && !told; ++first) {
    const ProcessResult result =
        run_sheave({"plot", table, "-y", "y", "-o", folder.path("a.svg")},
                   {.environment = {"LD_PRELOAD=" SHEAVE_FAULT_LIBRARY, "SHEAVE_FAULT_STAYS=1",
                                    "SHEAVE_FAULT_AT=" + std::to_string(first)}});
    EXPECT_EQ(result.exit_code, 74) << result.err;
    EXPECT_EQ(result.err.find("range"), std::string::npos) << result.err;
    EXPECT_THAT(folder.entries(), ElementsAre("a.csv"));
    told = result.err.find("cannot write: No space left on device") != std::string::npos;
  }
  EXPECT_TRUE(told);
}

TEST(Printable, EscapesControlCharacters) {
  EXPECT_EQ(command::printable("a\nb\tc\x1b[2J\x7f\xc2\x9b\xe2\x80\xae\xff ü"),
            "a\nb\tc\\x1b[2J\\x7f\\xc2\\x9b\\xe2\\x80\\xae\\xff ü");
  // Of JSON the strings mean what they meant.
  const std::string json = json::array({"\x7f\xc2\x9b\xe2\x80\xae ü"}).dump();
  EXPECT_EQ(command::showable_json(json), "[\"\\u007f\\u009b\\u202e ü\"]");
  EXPECT_EQ(json::parse(command::showable_json(json)), json::parse(json));
}

TEST(PrintableLine, HasNoLineBreak) {
  EXPECT_EQ(command::printable_line("a\n15 of 15 checks passed\x1b[2J\n"),
            "a\\x0a15 of 15 checks passed\\x1b[2J\\x0a");
  command::TextTable table({"m\nforged", "value"}, 1);
  table.add({"a\nforged", "1"});
  EXPECT_EQ(table.text(), "  m\\x0aforged  value\n  a\\x0aforged      1\n");
}

// An axis of a journal is a text from outside, and so are the names of a scene and of a file. None
// of them may begin a line.
TEST(PrintableLine, NoTextFromOutsideForgesALine) {
  command::SweepTable table;
  table.head.scene = "scene\n15 of 15 checks passed";
  table.head.axes = {"/a\nforged"};
  table.head.measures.emplace_back().name = "m\nforged";
  for (const double value : {1.0, 2.0}) {
    command::SweepRow row;
    row.values = {"v\nforged"};
    row.measured = {value};
    row.message = "message\nforged";
    table.rows.push_back(row);
  }
  const std::string text = command::sweep_text(table);
  EXPECT_EQ(text.find("\nforged"), std::string::npos) << text;
  EXPECT_EQ(text.find("\n15 of"), std::string::npos) << text;
  SceneResult result;
  SceneError& error = result.errors.emplace_back();
  error.file = "a\nforged";
  error.message = "there is no such file";
  EXPECT_EQ(command::to_text(result), "a\\x0aforged: there is no such file");
}

TEST(OneLine, ReplacesControlCharactersAndCutsLongTexts) {
  using command::one_line;
  EXPECT_EQ(one_line("a\nb\tc\r\n"), "a b c  ");
  EXPECT_EQ(one_line("größe Ω"), "größe Ω");
  EXPECT_EQ(one_line(std::string("a\0b\x1a\x7f", 5)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(one_line("\xff\xc3"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(one_line("\xe2\x80\xae\xef\xbf\xbf"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(one_line("\xe2\x80\xa8"), " ");
  EXPECT_EQ(one_line("abcd", 4), "abcd");
  EXPECT_EQ(one_line("abcde", 4), "abc…");
  EXPECT_EQ(one_line(std::string(1'000'000, 'x')).size(), 299U + 3U);
}

TEST(MarkdownText, EscapesMarkup) {
  EXPECT_EQ(command::markdown_text("a <b> & [c](d) `e` | \\"),
            "a &lt;b&gt; &amp; \\[c\\](d) \\`e\\` \\| \\\\");
  EXPECT_EQ(command::markdown_code("``` a\n"), "````\n``` a\n````\n");
}

TEST(MarkdownText, PagesOfTradesContainNoHtml) {
  for (const std::string& text : hostile_texts()) {
    command::TradeTable table;
    table.scene = text;
    table.limits = {text};
    EXPECT_EQ(command::trade_markdown(table).find("<script"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace sheave::test
