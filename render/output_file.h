#pragma once
// Files that appear whole or not at all: written under a temporary name in the same folder, then
// renamed.

#include <cstdint>
#include <span>
#include <string>

#include "engine/result.h"

namespace sheave::render {

/// What a file that is in place outlives.
enum class Durability {
  process,     ///< the end of this process, however it comes
  power_loss,  ///< a power loss too: it is the old or the new one. Waits for the disk
};

/// A temporary file beside its destination, removed unless commit() succeeds.
class OutputFile {
 public:
  /// Creates the temporary; fails if the folder does not exist or cannot be written to, or if
  /// `path` is anything but a file, a link (which stays one) or new.
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
  /// Closes the file descriptor, for when another program writes to temporary_path().
  Errors close();
  /// Moves the file to its destination, replacing what was there.
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
