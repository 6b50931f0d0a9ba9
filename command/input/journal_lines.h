#pragma once
// Lines of journals, each with a checksum of itself and of all before it.
//
//   {"format":"sheave-sweep-journal/2",...,"rows":[ // 1 0b8f4cf2c11aab52
//   {"run":0,...}, // 2 5be1b67c2a0d4e11
//
// Without the marks a journal is JSON except for its end. The reader adds the end, so the file of a
// killed process is a journal. The marks are comments of one form to the byte, so no byte of a file
// can be changed without a line that is refused.

#include <cstddef>
#include <string>
#include <string_view>

#include "command/input/json_check.h"
#include "scenes/json/checksum_chain.h"

namespace sheave::command {

/// A line as it goes into the file: with its mark and a line break.
[[nodiscard]] std::string marked_line(json::ChecksumChain& chain, std::string_view line);

/// The formats of a kind of journal.
struct JournalFormats {
  std::string_view marked;    ///< that this version writes
  std::string_view unmarked;  ///< of earlier versions, whose lines have no marks
};

/// The content of a journal file.
struct JournalLines {
  std::string text;           ///< its whole lines without their marks
  std::size_t bytes = 0;      ///< that these take in the file, with the marks
  json::ChecksumChain chain;  ///< behind them
  bool marked = false;        ///< false: an earlier version has written it, without any mark
  bool cut = false;           ///< the line behind them is not complete, and is left out
};

/// Checks the marks of a text, which errors call `path`. A Failure (65) names the line, the fault and
/// the remedy.
[[nodiscard]] JournalLines read_journal_lines(std::string_view text, const std::string& path);

/// `lines.text` as JSON, with the brackets that close it. Empty if there is no line.
[[nodiscard]] std::string closed_journal(const JournalLines& lines, std::string_view brackets);

/// Checks `json`, made of the lines, as check_json() does. A journal without marks must be of the
/// version that had none. Warns of such a journal, and of a line that was left out.
void check_journal(const JournalLines& lines, std::string_view json, const std::string& path,
                   const JournalFormats& formats, const JsonRule& rule,
                   const json::Limits& limits = {});

}  // namespace sheave::command
