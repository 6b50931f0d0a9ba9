#pragma once
// Writes the observables of a running simulation into tables.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scenes/observables.h"
#include "tools/table_writer.h"

namespace sheave::tools {

/// What to record.
struct RecordOptions {
  std::vector<std::string> paths;     ///< of --out
  std::vector<std::string> patterns;  ///< of --columns, with * ? [...]; empty: everything
  std::int64_t every = 1;             ///< steps per row
};

class Recorder {
 public:
  /// Creates the files; a Failure if a path or pattern is wrong. Without paths nothing is recorded.
  Recorder(const RecordOptions& options, const Simulation& simulation);

  /// To be called at the start and after every step: writes a row if one is due.
  void observe(const Simulation& simulation);
  /// Puts the files in place.
  void finish();

  [[nodiscard]] std::int64_t rows() const { return rows_; }

 private:
  void choose_columns(const std::vector<std::string>& patterns);

  ObservableSet observables_;
  std::int64_t every_;
  std::vector<int> columns_;    // indices of observables
  std::vector<double> values_;  // of a row
  std::vector<std::unique_ptr<TableWriter>> tables_;
  std::int64_t rows_ = 0;
};

}  // namespace sheave::tools
