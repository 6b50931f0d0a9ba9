// What fuzzing has found once is tried in every build: fuzz/regressions/TARGET/ has the inputs that
// broke a promise, fuzz/corpus/ TARGET/ a few that reach most of the code.

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "fuzz/target.h"

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

TEST_P(Replay, no_promise_is_broken) {
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

INSTANTIATE_TEST_SUITE_P(fuzz, Replay, testing::ValuesIn(targets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace sheave::fuzz
