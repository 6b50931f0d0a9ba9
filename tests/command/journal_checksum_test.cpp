// Journals that are not as they were written: each byte that is another one, lines that are gone,
// doubled or elsewhere, files that a crash has cut off, and those of earlier versions.

#include <algorithm>
#include <functional>
#include <limits>

#include <sys/mman.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/sweep/journal.h"
#include "command/trade/journal.h"
#include "command/trade/journal_check.h"
#include "tests/command/journal_text.h"
#include "tests/command/process.h"

namespace sheave::test {
namespace {

using command::Failure;
using command::SweepHead;
using command::SweepJournal;
using command::SweepRow;
using testing::ContainsRegex;
using testing::HasSubstr;

/// What reads a journal that errors call "journal".
using Reader = std::function<void(const std::string& text)>;

/// The message with which a text is refused; empty if it is taken.
std::string refusal(const Reader& read, const std::string& text) {
  try {
    read(text);
    return {};
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), command::ExitCode::bad_scene) << failure.what();
    return failure.what();
  }
}

/// Changes each byte to others: a bit of it, and those that mean something in such a file.
void expect_each_change_is_refused(const Reader& read, const std::string& good) {
  ASSERT_EQ(refusal(read, good), "");
  std::size_t line = 1;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string others = "\n 0}/";
    for (unsigned bit = 0; bit < 8; ++bit) others += static_cast<char>(good[i] ^ (1U << bit));
    for (const char other : others) {
      if (other == good[i]) continue;
      std::string bad = good;
      bad[i] = other;
      const std::string message = refusal(read, bad);
      const std::string start = "journal:" + std::to_string(line) + ":";
      ASSERT_TRUE(message.starts_with(start) && message.find("copy") != std::string::npos)
          << "byte " << i << " is now " << static_cast<int>(other) << ": " << message;
    }
    if (good[i] == '\n') ++line;
  }
}

/// Lines with their line breaks.
std::vector<std::string> whole_lines(const std::string& text) {
  std::vector<std::string> lines = split(text, '\n');
  if (lines.back().empty()) lines.pop_back();
  for (std::string& line : lines) line += '\n';
  return lines;
}

void expect_lines_in_their_order(const Reader& read, const std::string& good) {
  const std::vector<std::string> lines = whole_lines(good);
  ASSERT_GE(lines.size(), 4U);
  const auto refused = [&](const std::vector<std::string>& some, std::size_t at) {
    std::string text;
    for (const std::string& line : some) text += line;
    EXPECT_THAT(refusal(read, text),
                ContainsRegex("journal:" + std::to_string(at + 1) +
                              ":1: .*lines were removed, repeated or moved.*from a copy"));
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> some = lines;
    some.erase(some.begin() + static_cast<std::ptrdiff_t>(i));
    // Without its last line it is what it was a run ago.
    if (i + 1 < lines.size()) refused(some, i);
    some = lines;
    some.insert(some.begin() + static_cast<std::ptrdiff_t>(i), lines[i]);
    refused(some, i + 1);
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      some = lines;
      std::swap(some[i], some[j]);
      refused(some, i);
    }
  }
}

class SweepJournalFile : public testing::Test {
 protected:
  SweepJournalFile() {
    head.key = "0123456789abcdef";
    head.scene = "two weights";
    head.axes = {"/bodies/heavy/mass"};
    head.measures = {{"rope.0.tension", "N", {}}};
    head.runs = 3;
    for (std::size_t run = 0; run < head.runs; ++run) {
      SweepRow row;
      row.run = run;
      row.values = {std::to_string(run + 2)};
      row.measured = {run == 1 ? std::numeric_limits<double>::quiet_NaN()
                               : 14.25 + 0.1 * static_cast<double>(run)};
      row.end = 1.0;
      row.doubt = 1e-9;
      row.doubt_of = "energy // 2 0123456789abcdef";
      row.message = "a \"quoted\"\ntext";
      rows.push_back(row);
    }
    path = folder.path("a.sweep");
    keep(rows);
    good = read_file(path);
  }

  /// Goes on in the file that there is; how many runs were known.
  std::size_t keep(const std::vector<SweepRow>& some) {
    std::vector<SweepRow> known;
    SweepJournal journal(path, head, known);
    for (std::size_t i = known.size(); i < some.size(); ++i) journal.keep(some[i]);
    return known.size();
  }

  TemporaryFolder folder;
  SweepHead head;
  std::vector<SweepRow> rows;
  std::string path, good;
  const Reader read = [](const std::string& text) {
    const int file = memfd_create("journal", 0);
    ASSERT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    const std::string name = "/proc/self/fd/" + std::to_string(file);
    try {
      (void)command::read_sweep_journal(name);
      close(file);
    } catch (const Failure& failure) {
      close(file);
      std::string message = failure.what();
      throw Failure(failure.code(), message.replace(message.find(name), name.size(), "journal"));
    }
  };
};

TEST_F(SweepJournalFile, AnyChangedByteIsRefused) { expect_each_change_is_refused(read, good); }

TEST_F(SweepJournalFile, EachLineOccursOnceAndInOrder) { expect_lines_in_their_order(read, good); }

// Of a line that is not complete nothing is kept, whatever is in it; and the file is then, to the
// byte, that of a sweep that was never interrupted.
TEST_F(SweepJournalFile, ContinuesFromAnyCut) {
  // Each waits for the disk: all places near the ends of lines, and some between them.
  for (std::size_t size = 0; size <= good.size(); ++size) {
    const std::size_t next = std::min(good.find('\n', size), good.size() - 1);
    if (next > size + 2 && size % 16 != 0) continue;
    folder.write("a.sweep", good.substr(0, size));
    const auto whole = static_cast<std::size_t>(
        std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size), '\n'));
    EXPECT_EQ(keep(rows), whole == 0 ? 0 : whole - 1) << size;
    ASSERT_EQ(read_file(path), good) << size;
  }
}

TEST_F(SweepJournalFile, ReportsAMissingLine) {
  folder.write("a.sweep", good.substr(0, good.size() - 7));
  const ProcessResult result = run_sheave({"merge", path, "--csv", "-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("the last line is incomplete, as after a crash"));
  EXPECT_THAT(result.err, HasSubstr("1 of 3 runs are missing, the first of them run 2"));
  const ProcessResult whole = run_sheave({"merge", folder.write("b.sweep", good), "--csv", "-"});
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_EQ(whole.err, "");
}

TEST_F(SweepJournalFile, WarnsOfFilesOfEarlierVersions) {
  std::string old = without_checksums(good);
  old.replace(old.find("journal/2"), 9, "journal/1");
  const ProcessResult result = run_sheave({"merge", folder.write("b.sweep", old), "--csv", "-"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("\"sheave-sweep-journal/1\" without checksums"));
  EXPECT_EQ(result.out, run_sheave({"merge", path, "--csv", "-"}).out);
  // Neither is a journal of this version without them, nor one of a version to come.
  EXPECT_THAT(refusal(read, without_checksums(good)), HasSubstr("journal:1:1: the line has been"));
  old.replace(old.find("journal/1"), 9, "journal/3");
  EXPECT_THAT(refusal(read, old), HasSubstr("\"sheave-sweep-journal/3\"; this program reads and "
                                            "writes \"sheave-sweep-journal/2\""));
}

class TradeJournalFile : public testing::Test {
 protected:
  TradeJournalFile() {
    path = folder.path("a.trade");
    command::TradeJournal journal(path, "0123456789abcdef");
    measure::Reference reference;
    reference.substeps = 16;
    reference.differences = {1e-3, 2.5e-4};
    journal.keep(reference, 2.0);
    for (const int substeps : {1, 2, 4}) {
      command::TradeRow row;
      row.setting.step.substeps = substeps;
      row.error = {0.01 / substeps, 0.02 / substeps, std::numeric_limits<double>::infinity(), 0.0};
      if (substeps == 4) row.fault = "diverged \"at once\"";
      journal.keep(row);
    }
    journal.save();
    good = read_file(path);
  }

  TemporaryFolder folder;
  std::string path, good;
  const Reader read = [](const std::string& text) {
    (void)command::checked_trade_journal(text, "journal");
  };
};

TEST_F(TradeJournalFile, AnyChangedByteIsRefused) { expect_each_change_is_refused(read, good); }

TEST_F(TradeJournalFile, EachLineOccursOnceAndInOrder) { expect_lines_in_their_order(read, good); }

TEST_F(TradeJournalFile, ContinuesFromAnyCutBehindItsFirstLine) {
  for (std::size_t size = good.find('\n') + 1; size <= good.size(); ++size) {
    const nlohmann::json json = nlohmann::json::parse(
        command::checked_trade_journal(good.substr(0, size), "journal"), nullptr, false);
    const auto whole = static_cast<std::size_t>(
        std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size), '\n'));
    ASSERT_EQ(json.at("rows").size(), whole - 1) << size;
  }
}

TEST_F(TradeJournalFile, WarnsOfFilesOfEarlierVersions) {
  nlohmann::json old = trade_journal_json(good);
  old["format"] = "sheave-trade-journal/1";
  testing::internal::CaptureStderr();
  EXPECT_EQ(refusal(read, old.dump(1)), "");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("\"sheave-trade-journal/1\" without checksums"));
  old["format"] = "sheave-trade-journal/2";
  EXPECT_THAT(refusal(read, old.dump(1)), HasSubstr("the line has been changed"));
}

}  // namespace
}  // namespace sheave::test
