#include "render/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/destination.h"

namespace sheave::render {
namespace {

Error fault(const std::string& path, const char* action) {
  return {"", "'" + path + "': cannot " + action + ": " + std::strerror(errno)};
}

/// The folder and a hidden name with six places for mkostemp. The places stand before the
/// extension, so that programs that judge a file by its name see the right extension.
std::string temporary_pattern(const std::string& path, std::size_t& suffix_length) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
  const std::string name = path.substr(start);
  const std::size_t dot = name.find_last_of('.');
  const std::string extension = dot == std::string::npos || dot == 0 ? "" : name.substr(dot);
  suffix_length = extension.size();
  // File names have a limit (255 bytes on nearly every file system); the added characters must not
  // push a long name over it.
  const std::string stem = name.substr(0, std::min<std::size_t>(name.size() - suffix_length, 100));
  return path.substr(0, start) + "." + stem + ".XXXXXX" + extension;
}

}  // namespace

OutputFile::OutputFile(std::string path, std::string destination, std::string temporary,
                       int descriptor)
    : path_(std::move(path)),
      destination_(std::move(destination)),
      temporary_(std::move(temporary)),
      descriptor_(descriptor) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      destination_(std::move(other.destination_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    destination_ = std::move(other.destination_);
    temporary_ = std::exchange(other.temporary_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

OutputFile::~OutputFile() { discard(); }

Result<OutputFile> OutputFile::create(const std::string& path, Link link) {
  if (path.empty() || path.back() == '/') return Error{"", "'" + path + "' names no file"};
  std::string destination = link == Link::followed ? followed(path) : path;
  struct stat status {};
  bool exists = ::lstat(destination.c_str(), &status) == 0;
  if (exists && S_ISLNK(status.st_mode)) exists = false;  // it is replaced
  if (exists && S_ISDIR(status.st_mode)) {
    return Error{"", "'" + path + "' is a folder; a file name is needed"};
  }
  if (exists && !S_ISREG(status.st_mode)) {
    return Error{"", "'" + path + "' is a device or a pipe; only a file can be replaced"};
  }
  // The rename would replace a file that its owner has protected.
  if (exists && ::access(destination.c_str(), W_OK) != 0) return fault(path, "write to it");
  std::size_t suffix_length = 0;
  std::string name = temporary_pattern(destination, suffix_length);
  const int descriptor = ::mkostemps(name.data(), static_cast<int>(suffix_length), O_CLOEXEC);
  if (descriptor < 0) return fault(path, "create a file there");
  ::fchmod(descriptor, default_mode());
  return OutputFile(path, std::move(destination), std::move(name), descriptor);
}

Errors OutputFile::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      return {fault(path_, "write")};
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

Errors OutputFile::close() {
  if (descriptor_ < 0) return {};
  // Some file systems report a full disk at close only.
  if (::close(std::exchange(descriptor_, -1)) != 0) return {fault(path_, "write")};
  return {};
}

Errors OutputFile::synchronise_temporary() {
  // Another program may have written to the temporary file, or even replaced it.
  if (descriptor_ < 0) descriptor_ = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) return {fault(path_, "read the written file")};
  if (!synchronise(descriptor_)) return {fault(path_, "write")};
  return {};
}

Errors OutputFile::commit(Durability durability) {
  Errors errors;
  if (durability == Durability::power_loss) errors = synchronise_temporary();
  if (errors.empty()) errors = close();
  if (errors.empty() && std::rename(temporary_.c_str(), destination_.c_str()) != 0) {
    errors.push_back(fault(path_, "put the finished file in place"));
  }
  if (!errors.empty()) {
    discard();
    return errors;
  }
  temporary_.clear();
  if (durability == Durability::power_loss) synchronise_folder(destination_);
  return {};
}

void OutputFile::discard() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(std::exchange(temporary_, {}).c_str());
}

Errors write_file(const std::string& path, std::span<const std::uint8_t> bytes,
                  Durability durability, Link link) {
  Result<OutputFile> file = OutputFile::create(path, link);
  if (!file) return file.errors();
  if (Errors errors = file->write(bytes); !errors.empty()) return errors;
  return file->commit(durability);
}

}  // namespace sheave::render
