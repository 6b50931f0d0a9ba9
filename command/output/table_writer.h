#pragma once
// Files of numbers: a row per recorded moment, a column per observable.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sheave::command {

class OutputFile;

/// The remainder of a table after a fault.
struct Salvage {
  std::int64_t rows = 0;  ///< rows under the table's final name
  std::string message;    ///< description of the remainder; empty if the fault has described it
};
/// Keeps the contents of `file` if they are `rows` complete rows.
[[nodiscard]] Salvage salvage_rows(OutputFile& file, std::int64_t rows);

/// The file of one table, which appears when finish() is called. Throws a Failure (74), for
/// instance if the disk is full; then salvage() saves the rows written so far.
class TableWriter {
 public:
  virtual ~TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;

  /// One value per column; NaN is a missing value.
  virtual void write_row(std::span<const double> values) = 0;
  virtual void finish() = 0;
  /// After a fault: moves the complete rows to the destination, as a valid table.
  virtual Salvage salvage() = 0;

 protected:
  TableWriter() = default;
};

/// A writer for a path that ends in .csv or .npy, or for CSV on standard output ("-"). A Failure
/// (2) for another ending.
[[nodiscard]] std::unique_ptr<TableWriter> open_table(const std::string& path,
                                                      const std::vector<std::string>& columns);

/// Comma-separated values: a line of column names, then a line per row with the shortest decimals
/// that read back as the same doubles. Missing values are empty.
[[nodiscard]] std::unique_ptr<TableWriter> open_csv(const std::string& path,
                                                    const std::vector<std::string>& columns);

/// NumPy's format, a structured array with a field of float64 per column:
/// numpy.load(path)["rope.0.tension"].
[[nodiscard]] std::unique_ptr<TableWriter> open_npy(const std::string& path,
                                                    const std::vector<std::string>& columns);

}  // namespace sheave::command
