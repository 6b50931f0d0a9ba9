#pragma once
// Checksums of lines in a row: of journals, and of the logs of sessions.

#include <cstdint>
#include <string>
#include <string_view>

namespace sheave::json {

/// FNV-1a, 64 bits, of all lines so far, each followed by a line break.
///
/// Each byte is taken up by a one-to-one function of the hash so far (an exclusive or, then a
/// multiplication by an odd number modulo 2^64). So two rows of lines that differ in one byte, with
/// as many bytes behind it, never have the same checksum; others that differ have it with a chance
/// of 2^-64. Lines that were removed, repeated or moved change it for all lines behind them.
class ChecksumChain {
 public:
  /// Takes up a line (without a line break in it) and tells its mark: its number, counted from 1,
  /// and the checksum, "7 0123456789abcdef".
  std::string add(std::string_view line);
  [[nodiscard]] std::int64_t lines() const { return lines_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
  std::int64_t lines_ = 0;
};

/// A mark as it is read.
struct ChecksumMark {
  std::string_view number;    ///< digits
  std::string_view checksum;  ///< 16 hexadecimal digits
};

/// Whether `text` is a mark as add() writes them; then `mark` refers to it.
[[nodiscard]] bool is_checksum_mark(std::string_view text, ChecksumMark& mark);

/// Why a line with this mark is not the line of which the chain, having taken it up, tells
/// `expected`. Empty if it is.
[[nodiscard]] std::string checksum_fault(std::string_view mark, std::string_view expected);

}  // namespace sheave::json
