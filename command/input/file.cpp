#include "command/input/file.h"

#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/interrupt.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

/// Closes its file on every way out. Opening a pipe does not wait for its writer; reading does.
class InputDescriptor {
 public:
  explicit InputDescriptor(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~InputDescriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

[[nodiscard]] Failure input_failure(const std::string& name) {
  return {ExitCode::io, name + ": cannot be read: " + std::strerror(errno)};
}

/// Waits for bytes of a pipe, or its end; a signal ends the wait after 0.1 s at most. A file is read
/// after a signal, too: a run that was interrupted still writes its outputs.
void wait_for_bytes(int descriptor, const std::string& name) {
  constexpr int poll_ms = 100;
  pollfd file{descriptor, POLLIN, 0};
  for (;;) {
    const int ready = ::poll(&file, 1, poll_ms);
    if (ready > 0) return;
    if (ready < 0 && errno != EINTR) throw input_failure(name);
    if (interrupted()) throw Failure(ExitCode::interrupted, name + ": not read: interrupted");
  }
}

/// The bytes up to the end, or somewhat more than `most`.
std::string read_up_to(int descriptor, const std::string& name, std::size_t most) {
  std::string bytes;
  std::vector<char> block(std::size_t{1} << 16U);
  while (bytes.size() <= most) {
    wait_for_bytes(descriptor, name);
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) throw input_failure(name);
    if (count == 0) break;
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
  return bytes;
}

}  // namespace

std::string read_input(const std::string& path, std::size_t most) {
  const std::string name = printable_line(path);
  const InputDescriptor file(path);
  if (file.get() < 0 && (errno == ENOENT || errno == ENOTDIR)) {
    throw Failure(ExitCode::no_input, name + ": there is no such file");
  }
  if (file.get() < 0) throw input_failure(name);
  std::string bytes = read_up_to(file.get(), name, most);
  if (bytes.size() > most) {
    throw Failure(ExitCode::bad_scene,
                  fmt::format("{}: has more than {} bytes, which are too many", name, most));
  }
  return bytes;
}

std::string read_standard_input(std::size_t most) {
  return read_up_to(STDIN_FILENO, "standard input", most);
}

}  // namespace sheave::command
