// After a power loss at any moment, a file is the old or the new one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/disk_model.h"
#include "tests/command/fault_log.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

/// Moments at which `path` could be neither what it was nor what it became.
int bad_moments(const std::map<std::string, std::string>& files, const std::string& path,
                const std::vector<RecordedCall>& calls) {
  DiskModel disk(files);
  std::set<std::string> good{files.at(path)};
  int bad = 0;
  for (const RecordedCall& call : calls) {
    disk.apply(call);
    good.insert(disk.completed(path).begin(), disk.completed(path).end());
    for (const std::string& content : disk.after_power_loss(path))
      bad += good.contains(content) ? 0 : 1;
  }
  EXPECT_GT(good.size(), 1U) << path << " was written";
  return bad;
}

void expect_old_or_new(const std::map<std::string, std::string>& files,
                       const std::vector<RecordedCall>& calls) {
  std::vector<RecordedCall> careless;
  for (const RecordedCall& call : calls) {
    if (call.name != "fsync") careless.push_back(call);
  }
  for (const auto& [path, content] : files) {
    EXPECT_EQ(bad_moments(files, path, calls), 0) << path;
    EXPECT_GT(bad_moments(files, path, careless), 0)
        << path << ": the model sees what fsync is for";
  }
}

TEST(PowerLoss, TablesAndTheStateAreOldOrNew) {
  const TemporaryFolder folder;
  const TemporaryFolder aside;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::map<std::string, std::string> files;
  for (const char* name : {"a.csv", "b.npy", "c.state"}) {
    files[folder.write(name, "what was there before\n")] = "what was there before\n";
  }
  const std::string log = aside.path("log");
  const ProcessResult result =
      run_sheave({"run", scene, "-q", "--out", folder.path("a.csv"), "--out", folder.path("b.npy"),
                  "--save-state", folder.path("c.state")},
                 with_fault({.log = log}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  expect_old_or_new(files, read_fault_log(log).recorded);
}

TEST(PowerLoss, TheSceneAndTheJournalAreOldOrNew) {
  const TemporaryFolder folder;
  const TemporaryFolder aside;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string journal = folder.path("a.trade");
  // Whichever of these is the cheapest, which the clock says, it is not what the scene has.
  const std::vector<std::string> command{
      "trade",      scene, "--resume",    journal,         "--solver", "direct",
      "--substeps", "2,3", "--no-ladder", "--repetitions", "1",        "--reference-seconds",
      "1e6"};
  ASSERT_EQ(run_sheave(command).exit_code, 0);
  // Of another scene, so that it is begun anew, and the scene is changed at the end.
  std::map<std::string, std::string> files;
  files[journal] = read_file(journal);
  const std::string log = aside.path("log");
  std::string text = atwood_scene;
  text.replace(text.find("\"mass\": 4"), 9, "\"mass\": 5");
  files[folder.write("atwood.json", text)] = text;
  std::vector<std::string> applying = command;
  applying.insert(applying.end(), {"--error", "50%", "--apply"});
  const ProcessResult result = run_sheave(applying, with_fault({.log = log}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  expect_old_or_new(files, read_fault_log(log).recorded);
}

}  // namespace
}  // namespace sheave::test
