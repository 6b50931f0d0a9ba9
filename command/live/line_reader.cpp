#include "command/live/line_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <unistd.h>

#include "command/failure.h"

namespace sheave::command {

std::optional<LineReader::Line> LineReader::next() {
  const std::size_t end = buffer_.find('\n', searched_);
  if (end == std::string::npos) {
    if (buffer_.size() > longest_) skipping_ = true;
    if (skipping_) {
      skipped_ += buffer_.size();
      buffer_.clear();
      if (skipped_ > most_skipped) {
        throw Failure(ExitCode::io, what_ + ": a line has more than 64 MiB; a line may have " +
                                        std::to_string(longest_) +
                                        " bytes, so end it with a line break");
      }
    }
    searched_ = buffer_.size();
    if (!at_end_ || (buffer_.empty() && !skipping_)) return {};
    Line last{std::exchange(buffer_, {}), std::exchange(skipping_, false)};
    searched_ = 0;
    return last;
  }
  Line line{buffer_.substr(0, end), std::exchange(skipping_, false) || end > longest_};
  if (line.too_long) line.text.clear();
  skipped_ = 0;
  buffer_.erase(0, end + 1);
  searched_ = 0;
  return line;
}

void LineReader::read() {
  // Reads into the heap buffer: a small stack may have no room for a block.
  constexpr std::size_t block = 65536;
  const std::size_t before = buffer_.size();
  buffer_.resize(before + block);
  const ssize_t count = ::read(descriptor_, buffer_.data() + before, block);
  const int fault = errno;
  buffer_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (count < 0 && (fault == EINTR || fault == EAGAIN)) return;
  if (count < 0) {
    throw Failure(ExitCode::io, what_ + ": cannot be read: " + std::strerror(fault));
  }
  if (count == 0) at_end_ = true;
}

}  // namespace sheave::command
