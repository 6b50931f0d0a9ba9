#pragma once
// The journal of `sheave sweep --resume FILE` keeps every run as soon as the run has ended.
//
// One line of JSON describes the sweep. A line per run follows, written at once and whole: a killed
// process loses only the runs in progress. A last line that a power loss has cut off is left out,
// with a warning. Each line has a checksum (command/input/journal_lines.h).

#include <string>
#include <vector>

#include "command/input/journal_lines.h"
#include "command/sweep/table.h"

namespace sheave::command {

inline constexpr JournalFormats sweep_journal_formats{"sheave-sweep-journal/2",
                                                      "sheave-sweep-journal/1"};

/// Reads a journal. A Failure: 65 with all faults, located, if it is anything else; 66, 74. Warns
/// of one without checksums, and of a last line that was cut off.
[[nodiscard]] SweepTable read_sweep_journal(const std::string& path);

/// "a sweep of runs", "a tune of statics", for messages.
[[nodiscard]] std::string task_text(const SweepHead& head);

class SweepJournal {
 public:
  /// `path` empty: nothing is kept. Begins the file, or takes the rows of an earlier sitting into
  /// `known`. A Failure: 2 if it is of another sweep, shard or program, or if another process
  /// writes it; 65 if it is no journal; 74.
  SweepJournal(std::string path, const SweepHead& head, std::vector<SweepRow>& known);
  ~SweepJournal();
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;

  /// Appends a row and, at most once a second, waits until the disk has all rows. A Failure (74).
  void keep(const SweepRow& row);
  /// Waits until the disk has everything.
  void finish();

 private:
  void write(const std::string& line);

  std::string path_;
  json::ChecksumChain chain_;
  int descriptor_ = -1;
  double synced_at_ = 0.0;
};

}  // namespace sheave::command
