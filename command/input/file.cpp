#include "command/input/file.h"

#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

/// Closes its file on every way out.
class InputDescriptor {
 public:
  explicit InputDescriptor(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~InputDescriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

std::string read_input(const std::string& path, std::size_t most) {
  const InputDescriptor file(path);
  if (file.get() < 0 && (errno == ENOENT || errno == ENOTDIR)) {
    throw Failure(ExitCode::no_input, printable_line(path) + ": there is no such file");
  }
  const auto unreadable = [&] {
    return Failure(ExitCode::io,
                   printable_line(path) + ": cannot be read: " + std::strerror(errno));
  };
  if (file.get() < 0) throw unreadable();
  std::string bytes;
  std::vector<char> block(std::size_t{1} << 16U);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw unreadable();
    if (count == 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(count));
    if (bytes.size() > most) {
      throw Failure(ExitCode::bad_scene,
                    fmt::format("{}: has more than {} bytes, which are too many",
                                printable_line(path), most));
    }
  }
}

}  // namespace sheave::command
