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

/// A temporary file beside its destination, removed unless commit() succeeds.
class OutputFile {
 public:
  /// Creates the temporary file. Fails if the folder does not exist or is not writable, or if
  /// `path` is neither new nor a file or a link (which stays a link).
  static Result<OutputFile> create(const std::string& path);
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
                  Durability durability = Durability::power_loss);

}  // namespace sheave::render
