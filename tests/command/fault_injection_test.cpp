// Every call that brings something to a disk fails once, and from then on; every allocation fails.
// Whatever happens: an exit code of the contract, the name of what failed, healthy outputs whole,
// what was written kept, nothing half under a final name.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/fault_log.h"
#include "tests/command/npy_file.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string before = "what was there before\n";

/// A run of the command with all its outputs, in a folder of its own each time.
struct Job {
  std::vector<std::string> arguments;  ///< "@name" is a file in the folder
  std::vector<std::string> outputs;    ///< their names
  bool prints = true;                  ///< something to standard output
};

Job run_job() {
  return {{"run", "@atwood.json", "--json", "--steps", "20", "--out", "@a.csv", "--out", "@b.npy",
           "--save-state", "@c.state"},
          {"a.csv", "b.npy", "c.state"}};
}

/// What is in the folder after a job, and how it ended.
struct Outcome {
  ProcessResult result;
  std::map<std::string, std::string> files;  // by name; "" is not there
  std::vector<std::string> others;           // names that nobody asked for
  FaultLog log;
};

Outcome execute(const Job& job, Fault fault) {
  const TemporaryFolder folder;
  const TemporaryFolder aside;
  folder.write("atwood.json", atwood_scene);
  // A link must not lead to a file that is lost, and a file that was there is replaced whole or not
  // at all.
  for (const std::string& name : job.outputs) folder.write(name, before);
  std::vector<std::string> arguments;
  for (const std::string& word : job.arguments) {
    arguments.push_back(word.starts_with('@') ? folder.path(word.substr(1)) : word);
  }
  fault.log = aside.path("log");
  Outcome outcome;
  outcome.result = run_sheave(arguments, with_fault(fault));
  outcome.log = read_fault_log(fault.log);
  for (const std::string& name : folder.entries()) {
    const bool asked = std::count(job.outputs.begin(), job.outputs.end(), name) > 0;
    if (asked) outcome.files[name] = read_file(folder.path(name));
    if (!asked && name != "atwood.json") outcome.others.push_back(name);
  }
  return outcome;
}

/// Whether `left` is a table that holds the first rows of `whole`.
/// `in_order`: not ended by a lack of memory, where rows may be there that are not told yet.
bool is_prefix(const std::string& name, const std::string& left, const std::string& whole,
               bool in_order) {
  if (name.ends_with(".npy")) {
    const NpyFile part = parse_npy(left, in_order);
    const NpyFile all = parse_npy(whole);
    return part.columns == all.columns && part.rows <= all.rows &&
           part.data.size() <= all.data.size() &&
           (part.data.empty() ||
            std::memcmp(part.data.data(), all.data.data(), part.data.size() * sizeof(double)) == 0);
  }
  return name.ends_with(".csv") && left.ends_with('\n') && whole.starts_with(left);
}

void expect_contract(const Job& job, const Outcome& truth, const Outcome& found) {
  const ProcessResult& result = found.result;
  EXPECT_EQ(result.signal, 0);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 74 || result.exit_code == 70)
      << result.exit_code;
  // What cannot even be begun is told before anything is done.
  bool untouched = result.out.empty();
  for (const std::string& name : job.outputs) untouched &= found.files.at(name) == before;
  for (const std::string& name : job.outputs) {
    const std::string& left = found.files.at(name);
    const std::string& whole = truth.files.at(name);
    const bool named = result.err.find(name) != std::string::npos;
    if (result.exit_code == 0 || (!named && !untouched && result.exit_code == 74)) {
      EXPECT_EQ(left, whole) << name << " is healthy";
    } else {
      EXPECT_TRUE(left == whole || left == before ||
                  is_prefix(name, left, whole, result.exit_code != 70))
          << name << " has " << left.size() << " bytes";
    }
  }
  for (const std::string& name : found.others) {
    EXPECT_THAT(result.err, HasSubstr("remains in")) << name;
    EXPECT_THAT(result.err, HasSubstr(name));
  }
  if (result.exit_code != 0) {
    EXPECT_THAT(result.err,
                testing::AnyOf(HasSubstr("sheave: error: "), HasSubstr("out of memory")));
    EXPECT_THAT(result.err, testing::Not(HasSubstr("internal")));
  }
  if (result.exit_code == 70) {
    EXPECT_THAT(result.err, HasSubstr("out of memory"));
  }
}

TEST(FaultInjection, EveryOutputCallOfARunMayFail) {
  const Job job = run_job();
  const Outcome truth = execute(job, {});
  ASSERT_EQ(truth.result.exit_code, 0) << truth.result.err;
  ASSERT_GE(truth.log.calls, 15)
      << "three files, each created, written, synchronised, closed and renamed";
  int failed = 0;
  for (const bool stays : {false, true}) {
    for (long n = 1; n <= truth.log.calls; ++n) {
      const Outcome found = execute(job, {.call = n, .stays = stays});
      SCOPED_TRACE(testing::Message()
                   << "call " << n << (stays ? " and all after it" : "") << ": exit code "
                   << found.result.exit_code << ", " << found.result.err);
      expect_contract(job, truth, found);
      EXPECT_NE(found.result.exit_code, 70);
      failed += found.result.exit_code == 74 ? 1 : 0;
    }
  }
  // Only where names in a folder are not synchronised, or nothing was in a descriptor any more, is
  // there nothing to tell.
  EXPECT_GT(failed, truth.log.calls);
}

TEST(FaultInjection, AllocationsOfARunMayFail) {
  if (SHEAVE_SANITIZED) GTEST_SKIP() << "allocations are the sanitizer's there";
  const Job job = run_job();
  const Outcome truth = execute(job, {});
  ASSERT_EQ(truth.result.exit_code, 0) << truth.result.err;
  ASSERT_GT(truth.log.allocations, 1000);
  int failed = 0;
  // dev/inject lets every one fail; here they are spread over the run.
  const char* rounds = std::getenv("SHEAVE_INJECT");
  const long samples =
      rounds == nullptr ? 100 : std::max(100L, 10 * std::strtol(rounds, nullptr, 10));
  for (long i = 0; i < samples; ++i) {
    const long n = 1 + i * (truth.log.allocations - 1) / (samples - 1);
    const Outcome found = execute(job, {.allocation = n, .stays = i % 2 == 1});
    SCOPED_TRACE(testing::Message() << "allocation " << n << ": exit code "
                                    << found.result.exit_code << ", " << found.result.err);
    expect_contract(job, truth, found);
    failed += found.result.exit_code == 70 ? 1 : 0;
  }
  EXPECT_GT(failed, samples / 2);
}

TEST(FaultInjection, OnlyPicturesNeedTheLibraryThatDrawsThem) {
  if (!SHEAVE_HAS_RENDER) GTEST_SKIP() << "built without the renderer";
  const TemporaryFolder folder;
  folder.write("atwood.json", atwood_scene);
  // The loader takes the first file of the name, and these are no libraries.
  const TemporaryFolder libraries;
  for (int version = 6; version < 12; ++version) {
    libraries.write("libOSMesa.so." + std::to_string(version), "text");
  }
  ProcessOptions options;
  options.environment.push_back("LD_LIBRARY_PATH=" + libraries.path(""));
  const auto sheave = [&](const std::vector<std::string>& arguments) {
    return run_sheave(arguments, options);
  };
  const ProcessResult run = sheave({"run", folder.path("atwood.json"), "--steps", "5"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const ProcessResult still =
      sheave({"render", folder.path("atwood.json"), "--still", folder.path("picture.png")});
  EXPECT_EQ(still.exit_code, 70);
  EXPECT_THAT(still.err, HasSubstr("OSMesa (Debian: libosmesa6), which cannot be loaded"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"atwood.json"});
}

}  // namespace
}  // namespace sheave::test
