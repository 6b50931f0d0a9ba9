#pragma once
// Files that appear whole or not at all: written under a temporary name in the same folder, then
// renamed.

#include <cstdint>
#include <span>
#include <string>

#include "engine/result.h"

namespace sheave::render {

/// A temporary file beside its destination, removed unless commit() succeeds.
class OutputFile {
 public:
  /// Creates the temporary; fails if the folder does not exist or cannot be written to.
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
  Errors commit();
  /// Removes the temporary; nothing appears at the destination.
  void discard();

 private:
  OutputFile(std::string path, std::string temporary, int descriptor);

  std::string path_;
  std::string temporary_;  ///< empty once committed or discarded
  int descriptor_ = -1;
};

/// Writes a whole file in one go.
Errors write_file(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace sheave::render
