#pragma once
// A bar on a terminal's last line while something runs; nothing at all if standard error is no
// terminal, so that logs stay clean.

#include <chrono>
#include <cstddef>
#include <string>

namespace sheave::command {

class Progress {
 public:
  /// Runs from `begin` to `end`; `label` stands before the bar.
  Progress(std::string label, double begin, double end, bool quiet);
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws the bar if enough time has passed since the last time. `text` stands behind it.
  void update(double now, const std::string& text);
  /// Whether updates are shown at all: if not, the caller need not make a text.
  [[nodiscard]] bool shown() const { return shown_; }
  /// Whether an update now would be drawn.
  [[nodiscard]] bool due() const;
  /// Removes the bar from the screen, for other text.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  double begin_;
  double end_;
  bool shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
  std::size_t width_ = 0;  // of what is on the screen now
};

/// "42 s", "3 min 10 s", "2 h 05 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace sheave::command
