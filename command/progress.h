#pragma once
// A progress bar on a terminal's last line. Nothing is written if standard error is not a terminal,
// so logs stay clean.

#include <chrono>
#include <cstddef>
#include <string>

namespace sheave::command {

class Progress {
 public:
  /// The bar runs from `begin` to `end`; `label` stands before it.
  Progress(std::string label, double begin, double end, bool quiet);
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws the bar if enough time has passed since the last update. `text` stands behind the bar.
  void update(double now, const std::string& text);
  /// Whether updates are shown at all. If not, the caller need not build a text.
  [[nodiscard]] bool shown() const { return shown_; }
  /// Whether update() would redraw the bar now.
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
  std::size_t width_ = 0;  // characters on the screen now
};

/// "42 s", "3 min 10 s", "2 h 05 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace sheave::command
