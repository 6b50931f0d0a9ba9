#include "tools/line_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <unistd.h>

#include "tools/failure.h"

namespace sheave::tools {

std::optional<LineReader::Line> LineReader::next() {
  const std::size_t end = buffer_.find('\n', searched_);
  if (end == std::string::npos) {
    if (buffer_.size() > longest_) skipping_ = true;
    if (skipping_) buffer_.clear();
    searched_ = buffer_.size();
    if (!at_end_ || (buffer_.empty() && !skipping_)) return {};
    Line last{std::exchange(buffer_, {}), std::exchange(skipping_, false)};
    searched_ = 0;
    return last;
  }
  Line line{buffer_.substr(0, end), std::exchange(skipping_, false) || end > longest_};
  if (line.too_long) line.text.clear();
  buffer_.erase(0, end + 1);
  searched_ = 0;
  return line;
}

void LineReader::read() {
  std::array<char, 65536> block{};
  const ssize_t count = ::read(descriptor_, block.data(), block.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count < 0) {
    throw Failure(ExitCode::io, what_ + ": cannot be read: " + std::strerror(errno));
  }
  if (count == 0) at_end_ = true;
  buffer_.append(block.data(), static_cast<std::size_t>(count));
}

}  // namespace sheave::tools
