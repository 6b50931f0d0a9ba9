// Replays fuzzing results in every build. fuzz/regressions/TARGET/ has the inputs that broke a
// promise, and fuzz/corpus/TARGET/ a few inputs that reach most of the code.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "command/output/gnuplot.h"
#include "command/text/one_line.h"
#include "fuzz/chart_texts.h"
#include "fuzz/machine.h"
#include "fuzz/target.h"
#include "tests/property/shrink.h"
#include "tests/support/hostile_text.h"

#if SHEAVE_HAS_RENDER
#include "render/child_process.h"
#endif

namespace sheave::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path path = fs::path(SHEAVE_SOURCE_DIR "/fuzz") / folder;
  if (!fs::is_directory(path)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class Replay : public testing::TestWithParam<Target> {};

TEST_P(Replay, BreaksNoPromise) {
  const std::string name(GetParam().name);
  std::size_t tried = 0;
  for (const char* folder : {"regressions/", "corpus/"}) {
    for (const fs::path& path : inputs(folder + name)) {
      const std::vector<std::uint8_t> bytes = bytes_of(path);
      EXPECT_NO_THROW(GetParam().run(bytes)) << path;
      ++tried;
    }
  }
  EXPECT_GT(tried, 0U);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, testing::ValuesIn(targets),
                         [](const auto& target) { return std::string(target.param.name); });

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Saves the scene of a machine whose run broke a promise, for inspection.
void keep_scene(Bytes bytes, std::uint64_t seed) {
  const char* folder = std::getenv("SHEAVE_FAULTS");
  if (folder == nullptr) return;
  std::ofstream(fs::path(folder) / ("machine-" + std::to_string(seed) + ".json"))
      << test::scene_of(trial_from(bytes).machine);
}

// SHEAVE_CASES machines from consecutive seeds beginning at SHEAVE_SEED: `dev/fuzz random`.
// Scenes that break a promise are written to the folder SHEAVE_FAULTS.
TEST(RandomMachines, KeepEveryPromise) {
  const std::uint64_t cases = from_environment("SHEAVE_CASES", 10);
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  for (std::uint64_t seed = first; seed < first + cases; ++seed) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(seed >> (8 * i));
    }
    try {
      try_machine(bytes);
    } catch (const std::exception& fault) {
      ADD_FAILURE() << fault.what() << "\nseed " << seed;
      keep_scene(bytes, seed);
    }
  }
}

// The same for edits from random bytes.
TEST(RandomEdits, KeepEveryPromise) {
  const std::uint64_t cases = from_environment("SHEAVE_CASES", 100);
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  for (std::uint64_t seed = first; seed < first + cases; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<std::uint8_t> bytes(512);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() >> 56U);
    try {
      try_edit(bytes);
    } catch (const std::exception& fault) {
      ADD_FAILURE() << fault.what() << "\nseed " << seed;
    }
  }
}

std::vector<std::string> some_texts(std::uint64_t first, std::uint64_t count) {
  std::vector<std::string> texts;
  for (std::uint64_t i = 0; i < count; ++i) texts.push_back(test::hostile_text(first + i));
  return texts;
}

constexpr std::uint64_t texts_of_a_chart = 100;

// SHEAVE_CASES texts from consecutive seeds beginning at SHEAVE_SEED. A hundred at a time are put
// into charts of all kinds.
TEST(HostileTexts, StayTexts) {
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  const std::uint64_t end = first + from_environment("SHEAVE_CASES", 2000);
  for (std::uint64_t seed = first; seed < end; seed += texts_of_a_chart) {
    const std::vector<std::string> texts = some_texts(seed, texts_of_a_chart);
    for (const auto& chart : charts_with(texts, command::ChartFormat::svg)) {
      ASSERT_NO_THROW(require_harmless(chart.text(), test::hostile_mark)) << "seed " << seed;
    }
  }
}

#if SHEAVE_HAS_RENDER

bool has_gnuplot() {
  static const bool found = std::system("gnuplot --version > /dev/null 2>&1") == 0;  // NOLINT
  return found;
}

/// The texts of a script as gnuplot prints them.
std::string read_back(const std::vector<std::string>& texts) {
  command::GnuplotScript script(command::ChartFormat::svg, 100);
  script.add({"set print '-'\n"});
  for (const std::string& text : texts) script.add({"print ", script.shown(text), "\n"});
  auto child = render::ChildProcess::start({"gnuplot", "-d", "-"}, {.keeps_output = true});
  const std::string code = script.text();
  EXPECT_TRUE(child && child->write(std::vector<std::uint8_t>(code.begin(), code.end())).empty());
  EXPECT_TRUE(child->finish().empty()) << child->last_words();
  const std::vector<std::uint8_t> output = child->output();
  return {output.begin(), output.end()};
}

// gnuplot itself is the reference.
TEST(HostileTexts, AreReadBackByGnuplot) {
  if (!has_gnuplot()) GTEST_SKIP() << "no gnuplot";
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  const std::uint64_t end = first + from_environment("SHEAVE_CASES", 2000);
  constexpr std::uint64_t at_once = 2000;
  for (std::uint64_t seed = first; seed < end; seed += at_once) {
    const std::vector<std::string> texts = some_texts(seed, std::min(at_once, end - seed));
    std::string expected;
    for (const std::string& text : texts) expected += command::one_line(text) + "\n";
    ASSERT_EQ(read_back(texts), expected) << "seed " << seed;
  }
}

/// A folder for pictures in which every started program records its name.
class Drawing {
 public:
  Drawing() : before_(fs::current_path()) {
    std::string name = (fs::temp_directory_path() / "sheave-charts.XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    programs_ = name + ".programs";
    fs::current_path(folder_);
#ifdef SHEAVE_FAULT_LIBRARY
    ::setenv("LD_PRELOAD", SHEAVE_FAULT_LIBRARY, 1);
    ::setenv("SHEAVE_FAULT_PROGRAMS", programs_.c_str(), 1);
#endif
  }
  ~Drawing() {
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("SHEAVE_FAULT_PROGRAMS");
    fs::current_path(before_);
    fs::remove_all(folder_);
    fs::remove(programs_);
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  [[nodiscard]] bool is_empty() const { return fs::is_empty(folder_); }
  /// Names of the programs started so far.
  [[nodiscard]] std::vector<std::string> programs() const {
    std::ifstream file(programs_);
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);) names.push_back(fs::path(line).filename());
    return names;
  }

 private:
  fs::path before_;
  fs::path folder_;
  std::string programs_;
};

// One text in 200 of SHEAVE_CASES, at least one hundred: only the pictures appear, and only gnuplot
// is started.
TEST(HostileTexts, AreDrawn) {
  if (!has_gnuplot()) GTEST_SKIP() << "no gnuplot";
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  const std::uint64_t charts =
      1 + from_environment("SHEAVE_CASES", 2000) / (200 * texts_of_a_chart);
  const Drawing drawing;
  std::size_t drawn = 0;
  for (std::uint64_t i = 0; i < charts; ++i) {
    const std::uint64_t seed = first + 200 * texts_of_a_chart * i;
    for (const auto& chart :
         charts_with(some_texts(seed, texts_of_a_chart), command::ChartFormat::svg)) {
      const std::string picture = std::to_string(drawn++) + ".svg";
      EXPECT_NO_THROW(command::draw_with_gnuplot(picture, chart)) << "seed " << seed;
      EXPECT_TRUE(fs::remove(picture)) << "seed " << seed;
      EXPECT_TRUE(drawing.is_empty()) << "seed " << seed;
    }
  }
#ifdef SHEAVE_FAULT_LIBRARY
  EXPECT_EQ(drawing.programs().size(), drawn);
  for (const std::string& program : drawing.programs()) {
    EXPECT_TRUE(program.starts_with("gnuplot")) << program;
  }
#endif
}

#endif

}  // namespace
}  // namespace sheave::fuzz
