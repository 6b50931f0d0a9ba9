#pragma once
// Destination of a file that is first written under another name, and its durability.

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace sheave::render {

/// The folder part of a path, with its slash; empty for a name alone.
[[nodiscard]] inline std::string folder_part(const std::string& path) {
  return path.substr(0, path.find_last_of('/') + 1);
}

/// `path` with symbolic links of its last part followed, so that a link stays a link, also if its
/// target does not exist yet.
[[nodiscard]] inline std::string followed(std::string path) {
  constexpr int most_links = 40;  // the limit of Linux
  constexpr std::size_t longest = 4096;
  for (int i = 0; i < most_links; ++i) {
    std::string target(longest, '\0');
    const ssize_t length = ::readlink(path.c_str(), target.data(), target.size());
    if (length <= 0) break;
    target.resize(static_cast<std::size_t>(length));
    path = target.front() == '/' ? target : folder_part(path) + target;
  }
  return path;
}

/// mkostemp makes files private; output files should have the permissions of the user's umask.
[[nodiscard]] inline mode_t default_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return static_cast<mode_t>(0666U & ~mask);
}

/// Waits until a file's content is on the disk; false, with errno, on failure. Without this, a
/// rename may reach the disk before the content, and a power loss then leaves an empty file.
[[nodiscard]] inline bool synchronise(int descriptor) {
  for (;;) {
    if (::fsync(descriptor) == 0) return true;
    // Some file systems do not support it and need no waiting.
    if (errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return true;
    if (errno != EINTR) return false;
  }
}

/// The same for the names in the folder of `path`. If that fails, a power loss still leaves the old
/// or the new file.
inline void synchronise_folder(const std::string& path) {
  const std::string folder = folder_part(path);
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(synchronise(descriptor));
  ::close(descriptor);
}

/// Waits until all files on the file system of the folder of `path` are on the disk, if possible.
inline void synchronise_files_beside(const std::string& path) {
  const std::string folder = folder_part(path);
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::syncfs(descriptor));
  ::close(descriptor);
}

}  // namespace sheave::render
