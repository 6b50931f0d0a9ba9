#include "command/live/line_writer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command/interrupt.h"

namespace sheave::command {
namespace {

using Clock = std::chrono::steady_clock;

/// Pending bytes above which optional lines are dropped, and above which other lines wait.
constexpr std::size_t most_for_offers = std::size_t{1} << 18U;
constexpr std::size_t most_for_lines = std::size_t{1} << 20U;
/// A pipe that is ready accepts this many bytes without blocking (PIPE_BUF).
constexpr std::size_t piece = 4096;
constexpr int tick = 100;  // [ms]; short, because a signal just before a wait does not end it

}  // namespace

LineWriter::LineWriter(int descriptor, std::function<std::string(std::int64_t)> dropped)
    : descriptor_(descriptor), dropped_line_(std::move(dropped)) {
  struct stat status {};
  is_file_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
}

bool LineWriter::is_ready(int milliseconds) const {
  pollfd wanted{descriptor_, POLLOUT, 0};
  // The next write reports an error of the descriptor.
  return ::poll(&wanted, 1, milliseconds) > 0;
}

void LineWriter::append(std::string_view line) {
  if (dropped_ > 0) {
    pending_ += dropped_line_(std::exchange(dropped_, 0));
    pending_ += '\n';
  }
  pending_ += line;
  pending_ += '\n';
}

void LineWriter::flush() {
  while (fault_.empty() && written_ < pending_.size() && is_ready(0)) {
    const std::size_t left = pending_.size() - written_;
    const std::size_t size = is_file_ ? left : std::min(left, piece);
    const ssize_t count = ::write(descriptor_, pending_.data() + written_, size);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (count < 0) {
      fault_ = std::string("standard output: ") + std::strerror(errno);
    } else {
      written_ += static_cast<std::size_t>(count);
    }
  }
  if (written_ == pending_.size() || !fault_.empty()) {
    pending_.clear();
    written_ = 0;
  } else if (written_ > most_for_lines) {
    pending_.erase(0, std::exchange(written_, 0));
  }
}

void LineWriter::write(std::string_view line) {
  if (!fault_.empty()) return;
  append(line);
  flush();
  while (pending_.size() - written_ > most_for_lines && !interrupted()) wait(1e-3 * tick);
}

void LineWriter::offer(std::string_view line) {
  if (!fault_.empty()) return;
  flush();
  if (pending_.size() - written_ > most_for_offers) {
    ++dropped_;
    return;
  }
  append(line);
  flush();
}

void LineWriter::wait(double seconds) {
  const auto milliseconds = static_cast<int>(std::min(1e3 * seconds, static_cast<double>(tick)));
  if (!has_pending()) {
    static_cast<void>(::poll(nullptr, 0, milliseconds));
  } else if (is_ready(milliseconds)) {
    flush();
  }
}

void LineWriter::finish() {
  if (dropped_ > 0 && fault_.empty()) {
    pending_ += dropped_line_(std::exchange(dropped_, 0));
    pending_ += '\n';
  }
  flush();
  std::optional<Clock::time_point> since;
  while (has_pending() && !hurried()) {
    if (interrupted() && !since) since = Clock::now();
    if (since && Clock::now() - *since > std::chrono::seconds(2)) return;
    wait(1e-3 * tick);
  }
}

void LineWriter::break_off() {
  if (fault_.empty()) fault_ = std::string("standard output: ") + std::strerror(EPIPE);
  pending_.clear();
  written_ = 0;
}

}  // namespace sheave::command
