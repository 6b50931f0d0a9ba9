#pragma once
// Writes the observables of a running simulation into tables.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command/output/table_writer.h"
#include "scenes/quantity_list.h"

namespace sheave::command {

/// Settings of the recording.
struct RecordOptions {
  std::vector<std::string> paths;  ///< of --out
  /// Lists of --columns: names, patterns with * ? [...], expressions; empty: everything
  std::vector<std::string> columns;
  std::int64_t every = 1;  ///< steps per row
};

/// One table of a run.
struct RecordedTable {
  std::string path;
  std::unique_ptr<TableWriter> writer;  ///< null once it is complete or at fault
  std::int64_t rows = 0;                ///< under its name; meaningful once there is no writer
  std::string fault;  ///< the fault, and the rows that are kept; empty if there is none

  [[nodiscard]] bool complete() const { return fault.empty(); }
};

/// A table that cannot be written is closed with the rows it has; the others go on.
class Recorder {
 public:
  /// Creates the files; a Failure if a path or pattern is wrong. Without paths nothing is recorded.
  Recorder(const RecordOptions& options, const Simulation& simulation);

  /// To be called at the start and after every step: writes a row if one is due. False if a table
  /// has come to a fault.
  bool observe(const Simulation& simulation);
  /// Puts the files in place.
  void finish();

  /// Rows of the tables without a fault.
  [[nodiscard]] std::int64_t rows() const { return rows_; }
  [[nodiscard]] const std::vector<RecordedTable>& tables() const { return tables_; }
  /// Whether any table is still written.
  [[nodiscard]] bool is_writing() const;

 private:
  void choose_columns(const std::vector<std::string>& lists);
  /// Does something with a table's writer; false if that failed, and then the table is closed.
  static bool attempt(RecordedTable& table, const std::function<void(TableWriter&)>& action);

  std::int64_t every_;
  QuantityList columns_;
  std::vector<double> values_;   // of a row
  std::vector<Course> courses_;  // of statistics over time in the columns
  std::vector<RecordedTable> tables_;
  std::int64_t rows_ = 0;
};

}  // namespace sheave::command
