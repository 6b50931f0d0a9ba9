#pragma once
// Files that appear completely or not at all: written under a temporary name in the same folder,
// then renamed.

#include <cstdint>
#include <span>
#include <string>

#include "engine/result.h"

namespace sheave::render {

/// The event that a committed file survives.
enum class Durability {
  process,     ///< any end of this process
  power_loss,  ///< also a power loss, which leaves the old or the new file; waits for the disk
};

/// The treatment of a symbolic link at the place of a file.
enum class Link {
  followed,  ///< the link stays, and its target is written: a user has named the link
  replaced,  ///< the file replaces the link: no user has named the link
};

/// A temporary file beside its destination, removed unless commit() succeeds.
class OutputFile {
 public:
  /// Creates the temporary; fails if the folder does not exist or cannot be written to, or if
  /// `path` is anything but a file, a link or new.
  static Result<OutputFile> create(const std::string& path, Link link = Link::followed);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::string& temporary_path() const { return temporary_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Appends bytes.
  Errors write(std::span<const std::uint8_t> bytes);
  /// Closes the file descriptor, so that another program can write to temporary_path().
  Errors close();
  /// Moves the file to its destination, replacing an existing file.
  Errors commit(Durability durability = Durability::power_loss);
  /// Removes the temporary; nothing appears at the destination.
  void discard();

 private:
  OutputFile(std::string path, std::string destination, std::string temporary, int descriptor);
  Errors synchronise_temporary();

  std::string path_;         ///< as it was given
  std::string destination_;  ///< with symbolic links followed
  std::string temporary_;    ///< empty once committed or discarded
  int descriptor_ = -1;
};

/// Writes a whole file in one go.
Errors write_file(const std::string& path, std::span<const std::uint8_t> bytes,
                  Durability durability = Durability::power_loss, Link link = Link::followed);

}  // namespace sheave::render
