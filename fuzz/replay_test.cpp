// What fuzzing has found once is tried in every build: fuzz/regressions/TARGET/ has the inputs that
// broke a promise, fuzz/corpus/ TARGET/ a few that reach most of the code.

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "fuzz/machine.h"
#include "fuzz/target.h"
#include "tests/property/shrink.h"

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

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// The scene of a machine whose run broke a promise, for a look at it.
void keep_scene(Bytes bytes, std::uint64_t seed) {
  const char* folder = std::getenv("SHEAVE_FAULTS");
  if (folder == nullptr) return;
  std::ofstream(fs::path(folder) / ("machine-" + std::to_string(seed) + ".json"))
      << test::scene_of(trial_from(bytes).machine);
}

// SHEAVE_CASES machines that follow from the seeds from SHEAVE_SEED on: `tools/fuzz random`.
// Scenes of those that break a promise are written to the folder SHEAVE_FAULTS.
TEST(RandomMachines, keep_every_promise) {
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

// The same for edits, of random bytes.
TEST(RandomEdits, keep_every_promise) {
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

}  // namespace
}  // namespace sheave::fuzz
