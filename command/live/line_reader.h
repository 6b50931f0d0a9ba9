#pragma once
// Lines from standard input, as they come.

#include <cstddef>
#include <optional>
#include <string>

namespace sheave::command {

class LineReader {
 public:
  /// A line of more than `longest` bytes is not kept. `what` is what failures call the source.
  LineReader(int descriptor, std::size_t longest, std::string what)
      : descriptor_(descriptor), longest_(longest), what_(std::move(what)) {}

  struct Line {
    std::string text;  ///< without its end
    bool too_long = false;
  };
  /// The next line that is there as a whole; at the end also one without its end.
  [[nodiscard]] std::optional<Line> next();
  /// Reads what there is; waits if there is nothing, but not beyond a signal. Throws a Failure
  /// (74).
  void read();
  /// Whether there is nothing more to read. Lines may be left.
  [[nodiscard]] bool at_end() const { return at_end_; }

 private:
  int descriptor_;
  std::size_t longest_;
  std::string what_;
  std::string buffer_;
  std::size_t searched_ = 0;  // of it, for the end of a line
  bool skipping_ = false;     // the rest of a line that is too long
  bool at_end_ = false;
};

}  // namespace sheave::command
