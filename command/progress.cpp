#include "command/progress.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "command/terminal.h"

namespace sheave::command {
namespace {

// A short run needs no bar, and redrawing faster than people read only costs time.
constexpr std::chrono::milliseconds first_after{400};
constexpr std::chrono::milliseconds redraw_interval{100};

std::size_t terminal_width() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

void write_raw(const std::string& text) {
  // A bar that cannot be drawn must not stop the run.
  [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, text.data(), text.size());
}

std::string bar(double fraction, std::size_t cells) {
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(cells));
  const std::string on(filled, '#');
  const std::string off(cells - filled, '-');
  if (!stderr_has_color()) return "[" + on + off + "]";
  return "[\033[32m" + on + "\033[0m" + off + "]";
}

}  // namespace

Progress::Progress(std::string label, double begin, double end, bool quiet)
    : label_(printable(label)),
      begin_(begin),
      end_(end),
      shown_(!quiet && stderr_is_terminal()),
      next_(start_ + first_after) {}

Progress::~Progress() { clear(); }

bool Progress::due() const { return shown_ && Clock::now() >= next_; }

void Progress::update(double now, const std::string& text) {
  if (!due()) return;
  next_ = Clock::now() + redraw_interval;
  const double fraction =
      end_ > begin_ ? std::clamp((now - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::string head = label_ + " ";
  std::string tail = fmt::format(" {:3.0f} % {}", std::floor(100.0 * fraction), text);
  if (fraction > 0.0) tail += ", " + duration_text(elapsed / fraction - elapsed) + " left";
  const std::size_t columns = terminal_width() - 1;
  const std::size_t around = head.size() + tail.size() + 2;
  std::string line = head;
  std::size_t width = head.size() + tail.size();
  if (around + 5 <= columns) {
    const std::size_t cells = std::min<std::size_t>(columns - around, 40);
    line += bar(fraction, cells);
    width += cells + 2;
  }
  line += tail;
  if (width > columns) {  // a narrow terminal would wrap the line and scroll
    line = tail.substr(0, columns);
    width = line.size();
  }
  const std::size_t rest = width_ > width ? width_ - width : 0;
  write_raw("\r" + line + std::string(rest, ' '));
  width_ = std::max(width, width_);
}

void Progress::clear() {
  if (width_ > 0) write_raw("\r" + std::string(width_, ' ') + "\r");
  width_ = 0;
}

std::string duration_text(double seconds) {
  const double limit = 100.0 * 365.0 * 86400.0;
  if (!(seconds < limit)) return "more than a century";
  const auto whole = static_cast<long>(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace sheave::command
