#include "tools/output_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/failure.h"

namespace sheave::tools {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18U;

/// `path` with symbolic links followed, so that a link stays one; `path` itself if it is new.
std::string followed(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                         &std::free);
  return real ? std::string(real.get()) : path;
}

/// mkostemp makes files private; output should be as readable as the user's umask says.
mode_t default_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return static_cast<mode_t>(0666U & ~mask);
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  if (path_ == "-") {
    descriptor_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail("cannot write to standard output");
    return;
  }
  destination_ = followed(path_);
  struct stat status {};
  const bool exists = ::stat(destination_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    fail("cannot write");
  }
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(destination_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot write");
    return;
  }
  // A rename would replace a file that its owner protected.
  if (exists && ::access(destination_.c_str(), W_OK) != 0) fail("cannot write");
  create_temporary();
}

void OutputFile::create_temporary() {
  const std::size_t slash = destination_.find_last_of('/');
  const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
  // Names have a limit (255 bytes nearly everywhere) that the addition must not exceed.
  std::string name =
      destination_.substr(0, start) + "." + destination_.substr(start, 200) + ".XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot create it");
  ::fchmod(descriptor_, default_mode());
  temporary_ = std::move(name);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      destination_(std::move(other.destination_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::move(other.buffer_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() { discard(); }

void OutputFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::flush() {
  write_through(buffer_);
  buffer_.clear();
}

void OutputFile::write_through(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot write");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void OutputFile::overwrite(std::size_t offset, std::string_view bytes) {
  flush();
  const auto at = static_cast<off_t>(offset);
  if (::lseek(descriptor_, at, SEEK_SET) != at) fail("cannot go back in it");
  write_through(bytes);
  if (::lseek(descriptor_, 0, SEEK_END) < 0) fail("cannot go back in it");
}

void OutputFile::commit() {
  flush();
  // Some file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot write");
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) fail("cannot put it in place");
  temporary_.clear();
}

void OutputFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void OutputFile::fail(const char* what) const {
  const std::string reason = std::strerror(errno);
  const std::string name = path_ == "-" ? "standard output" : path_;
  throw Failure(ExitCode::io, name + ": " + what + ": " + reason);
}

void write_file(const std::string& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace sheave::tools
