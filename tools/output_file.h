#pragma once
// Output files that appear whole or not at all: written under a temporary name in the same folder
// and renamed at the end. Unlike render/output_file.h, which a build without the renderer does not
// have, this one buffers small writes, can go back to patch what it wrote, and knows destinations
// that cannot be replaced (pipes, devices, standard output).

#include <cstddef>
#include <string>
#include <string_view>

namespace sheave::tools {

/// Every member function throws a Failure (74) that names the path if something goes wrong.
class OutputFile {
 public:
  /// `path`: "-" is standard output; a pipe or device is written to directly.
  explicit OutputFile(std::string path);
  /// Removes the temporary file unless commit() was called.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view bytes);
  /// Replaces bytes that were written earlier, from `offset` on. Only if is_seekable().
  void overwrite(std::size_t offset, std::string_view bytes);
  /// Completes the file and puts it in place, replacing what was there.
  void commit();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_seekable() const { return !temporary_.empty(); }

 private:
  void create_temporary();
  void flush();
  void write_through(std::string_view bytes);
  void discard() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::string path_;         // as the user wrote it
  std::string destination_;  // with symbolic links followed
  std::string temporary_;    // empty if written to directly, or done
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a whole file.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace sheave::tools
