#include "command/output/file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command/failure.h"
#include "render/destination.h"

namespace sheave::command {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18U;
constexpr std::chrono::seconds longest_wait{1};

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  if (path_ == "-") {
    descriptor_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail("cannot write to standard output");
    return;
  }
  destination_ = render::followed(path_);
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
  // A rename would replace a file whose owner has made it read-only.
  if (exists && ::access(destination_.c_str(), W_OK) != 0) fail("cannot write");
  create_temporary();
}

void OutputFile::create_temporary() {
  const std::string folder = render::folder_part(destination_);
  // The temporary name must not exceed the limit of 255 bytes of most file systems.
  std::string name = folder + "." + destination_.substr(folder.size(), 200) + ".XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot create it");
  ::fchmod(descriptor_, render::default_mode());
  temporary_ = std::move(name);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      destination_(std::move(other.destination_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::move(other.buffer_)),
      ends_(std::move(other.ends_)),
      records_(other.records_),
      size_(other.size_),
      flushed_(other.flushed_),
      elsewhere_(other.elsewhere_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() { discard(); }

void OutputFile::write(std::string_view record) {
  buffer_.append(record);
  ends_.push_back(buffer_.size());
  // Limits the loss if the process is killed.
  if (buffer_.size() >= buffer_size || Clock::now() - flushed_ >= longest_wait) flush();
}

void OutputFile::flush() {
  flushed_ = Clock::now();
  std::size_t done = 0;
  int reason = 0;
  while (done < buffer_.size() && reason == 0) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count >= 0) done += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) reason = errno;
  }
  const auto whole = std::upper_bound(ends_.begin(), ends_.end(), done);
  records_ += whole - ends_.begin();
  size_ += whole == ends_.begin() ? 0 : *(whole - 1);
  buffer_.clear();
  ends_.clear();
  if (reason == 0) return;
  errno = reason;
  fail("cannot write");
}

void OutputFile::overwrite(std::size_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot write");
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += static_cast<std::size_t>(count);
  }
}

void OutputFile::commit() {
  flush();
  // Some file systems report a full disk only when synchronising.
  if (!temporary_.empty() && !render::synchronise(descriptor_)) fail("cannot write");
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot write");
  put_in_place();
}

void OutputFile::cut_to_whole_records() {
  while (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) {
    if (errno != EINTR) fail("cannot shorten it");
  }
}

void OutputFile::salvage() {
  buffer_.clear();
  ends_.clear();
  if (temporary_.empty()) return;
  if (descriptor_ >= 0) {
    cut_to_whole_records();
    // The records are worth keeping even if the file system cannot make them durable.
    static_cast<void>(render::synchronise(descriptor_));
    ::close(std::exchange(descriptor_, -1));
  }
  put_in_place();
}

void OutputFile::put_in_place() {
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) {
    const int reason = errno;
    // Keeps the temporary file: it may hold the results of hours.
    const std::string left = std::exchange(temporary_, {});
    elsewhere_ = true;
    errno = reason;
    fail(("the finished file cannot be moved to its name and remains in " + left).c_str());
  }
  temporary_.clear();
  render::synchronise_folder(destination_);
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

}  // namespace sheave::command
