#pragma once
// Output files that appear whole or not at all: written under a temporary name in the same folder
// and renamed at the end. Unlike render/output_file.h, which a build without the renderer does not
// have, this one consists of records, can go back to patch what it wrote, knows destinations
// that cannot be replaced (pipes, devices, standard output), and can save what was written before a
// fault.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sheave::command {

/// Every member function throws a Failure (74) that names the path if something goes wrong.
class OutputFile {
 public:
  /// `path`: "-" is standard output; a pipe or device is written to directly.
  explicit OutputFile(std::string path);
  /// Removes the temporary file unless commit() or salvage() was called.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  /// Appends a record: after a fault it is there whole or not at all. What is written reaches the
  /// system within a second, or with the next record if that takes longer.
  void write(std::string_view record);
  /// Replaces bytes that have reached the file, from `offset` on. Only if is_seekable().
  void overwrite(std::size_t offset, std::string_view bytes);
  /// Hands everything to the system.
  void flush();
  /// Completes the file and puts it in place, replacing what was there, safe from a power loss.
  void commit();
  /// After a fault: cuts off what is no whole record and puts the rest in place.
  void salvage();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_seekable() const { return !temporary_.empty(); }
  /// What salvage() is to keep at most: the first `size` bytes.
  void keep_at_most(std::size_t size) { size_ = std::min(size_, size); }
  /// Whether it could not be put in place and stays under its temporary name, which the Failure
  /// told.
  [[nodiscard]] bool is_elsewhere() const { return elsewhere_; }
  /// Whole records that have been handed to the system.
  [[nodiscard]] std::int64_t records() const { return records_; }

 private:
  using Clock = std::chrono::steady_clock;

  void create_temporary();
  void cut_to_whole_records();
  void put_in_place();
  void discard() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::string path_;         // as the user wrote it
  std::string destination_;  // with symbolic links followed
  std::string temporary_;    // empty if written to directly, or done
  std::string buffer_;
  std::vector<std::size_t> ends_;  // of the records in buffer_
  std::int64_t records_ = 0;
  std::size_t size_ = 0;  // of the records that were handed to the system
  Clock::time_point flushed_ = Clock::now();
  bool elsewhere_ = false;
  int descriptor_ = -1;
};

/// Writes a whole file; if that fails, what was there stays.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace sheave::command
