#pragma once
// Writes lines to a reader who may be slow. A line that has been begun is always completed.
// Optional lines are dropped instead of waiting for the reader.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace sheave::command {

class LineWriter {
 public:
  /// `dropped` makes the line that reports how many lines were dropped.
  LineWriter(int descriptor, std::function<std::string(std::int64_t)> dropped);

  /// Writes a line that must not be lost. Waits if the reader is far behind, but only until a
  /// signal comes.
  void write(std::string_view line);
  /// Writes an optional line: it is dropped while the reader is far behind. Never waits.
  void offer(std::string_view line);
  /// Passes on as many bytes as the reader accepts. Waits for the reader at most this time [s], or
  /// until a signal comes.
  void wait(double seconds);
  /// Passes on all bytes. After a signal the reader has two seconds to accept them, or until
  /// another signal comes.
  void finish();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool has_pending() const { return !pending_.empty(); }
  /// Why no more can be written; empty if writing is possible.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Called when a wait has shown that nobody reads any more.
  void break_off();

 private:
  void append(std::string_view line);
  void flush();
  [[nodiscard]] bool is_ready(int milliseconds) const;

  int descriptor_;
  bool is_file_ = false;
  std::function<std::string(std::int64_t)> dropped_line_;
  std::string pending_;
  std::size_t written_ = 0;  // bytes of the buffer already written
  std::int64_t dropped_ = 0;
  std::string fault_;
};

}  // namespace sheave::command
