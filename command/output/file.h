#pragma once
// Output files that appear complete or not at all: they are written under a temporary name in the
// same folder and renamed at the end. render/output_file.h is not available in a build without the
// renderer. In addition to its function, OutputFile consists of records, can patch bytes already
// written, supports destinations that cannot be replaced (pipes, devices, standard output), and can
// save the records written before a fault.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sheave::command {

/// Every member function throws a Failure (74) that names the path if it fails.
class OutputFile {
 public:
  /// `path`: "-" is standard output; a pipe or device is written to directly.
  explicit OutputFile(std::string path);
  /// Removes the temporary file unless commit() or salvage() was called.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  /// Appends a record. After a fault a record is in the file completely or not at all. Records
  /// reach the system within a second, or with the next record if that comes later.
  void write(std::string_view record);
  /// Replaces bytes that have reached the file, beginning at `offset`. Only if is_seekable().
  void overwrite(std::size_t offset, std::string_view bytes);
  /// Passes all buffered records to the system.
  void flush();
  /// Completes the file and moves it to its destination, replacing an older file. The result
  /// survives a power loss.
  void commit();
  /// After a fault: cuts off an incomplete record and moves the rest to its destination.
  void salvage();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_seekable() const { return !temporary_.empty(); }
  /// Limits salvage() to the first `size` bytes.
  void keep_at_most(std::size_t size) { size_ = std::min(size_, size); }
  /// Whether the file could not be moved to its destination. The file then keeps its temporary
  /// name, which the Failure contained.
  [[nodiscard]] bool is_elsewhere() const { return elsewhere_; }
  /// Number of complete records passed to the system.
  [[nodiscard]] std::int64_t records() const { return records_; }

 private:
  using Clock = std::chrono::steady_clock;

  void create_temporary();
  void cut_to_whole_records();
  void put_in_place();
  void discard() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::string path_;         // as given by the user
  std::string destination_;  // the path with symbolic links followed
  // Empty if the destination is written directly, or after commit() or salvage().
  std::string temporary_;
  std::string buffer_;
  std::vector<std::size_t> ends_;  // ends of the records in buffer_
  std::int64_t records_ = 0;
  std::size_t size_ = 0;  // bytes of the records passed to the system
  Clock::time_point flushed_ = Clock::now();
  bool elsewhere_ = false;
  int descriptor_ = -1;
};

/// Writes a whole file. If that fails, an older file stays.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace sheave::command
