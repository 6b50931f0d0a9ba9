#pragma once
// Reads lines from standard input as they arrive.

#include <cstddef>
#include <optional>
#include <string>

namespace sheave::command {

class LineReader {
 public:
  /// A line of more than `longest` bytes is discarded. A line of more than most_skipped bytes is a
  /// Failure (74), because its end may never come. Failures call the source `what`.
  static constexpr std::size_t most_skipped = std::size_t{64} << 20U;
  LineReader(int descriptor, std::size_t longest, std::string what)
      : descriptor_(descriptor), longest_(longest), what_(std::move(what)) {}

  struct Line {
    std::string text;  ///< the line without its line break
    bool too_long = false;
  };
  /// The next complete line. At the end of the input also a last line without line break.
  [[nodiscard]] std::optional<Line> next();
  /// Reads the available bytes. If there are none, waits for some or for a signal. Throws a Failure
  /// (74).
  void read();
  /// Whether the input has ended. Complete lines may still be buffered.
  [[nodiscard]] bool at_end() const { return at_end_; }

 private:
  int descriptor_;
  std::size_t longest_;
  std::string what_;
  std::string buffer_;
  std::size_t searched_ = 0;  // bytes of the buffer already searched for a line break
  bool skipping_ = false;     // discarding the rest of a line that is too long
  std::size_t skipped_ = 0;   // bytes of that line
  bool at_end_ = false;
};

}  // namespace sheave::command
