#pragma once
// Lines to a reader who may be slow: what has been begun is always completed, and what can be done
// without is left out rather than waited for.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace sheave::command {

class LineWriter {
 public:
  /// `dropped` makes the line that tells how many have been left out.
  LineWriter(int descriptor, std::function<std::string(std::int64_t)> dropped);

  /// Writes a line that must not be lost; waits for the reader if there is much that he has not
  /// taken yet, but not beyond a signal.
  void write(std::string_view line);
  /// Writes a line that may be left out while the reader has much to take; never waits.
  void offer(std::string_view line);
  /// Hands on what the reader takes now; waits for him up to this time [s], less if a signal comes.
  void wait(double seconds);
  /// Hands on all of it. After a signal the reader has two seconds to take it, or until another
  /// signal.
  void finish();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool has_pending() const { return !pending_.empty(); }
  /// Why nothing more can be written; empty: it can.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Nobody reads any more: found out by waiting.
  void break_off();

 private:
  void append(std::string_view line);
  void flush();
  [[nodiscard]] bool is_ready(int milliseconds) const;

  int descriptor_;
  bool is_file_ = false;
  std::function<std::string(std::int64_t)> dropped_line_;
  std::string pending_;
  std::size_t written_ = 0;  // of it
  std::int64_t dropped_ = 0;
  std::string fault_;
};

}  // namespace sheave::command
