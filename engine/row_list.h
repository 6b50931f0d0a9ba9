#pragma once
// The rows that features append for a solver of all rows at once.
//
// From round to round and substep to substep, many rows change in their value alone. Such a row
// names the row of which it is a copy, and its edition. Neither the row nor data derived from it is
// then computed again.

#include <vector>

#include "engine/row.h"

namespace sheave {

class RowList {
 public:
  [[nodiscard]] std::size_t size() const { return count_; }
  Row& operator[](std::size_t i) { return rows_[i]; }
  const Row& operator[](std::size_t i) const { return rows_[i]; }
  [[nodiscard]] auto begin() { return rows_.begin(); }
  [[nodiscard]] auto end() { return rows_.begin() + static_cast<std::ptrdiff_t>(count_); }
  [[nodiscard]] auto begin() const { return rows_.begin(); }
  [[nodiscard]] auto end() const { return rows_.begin() + static_cast<std::ptrdiff_t>(count_); }

  /// Removes all rows, but keeps their contents for append_copy().
  void clear() { count_ = 0; }
  /// An empty row.
  Row& emplace_back() {
    if (count_ == rows_.size()) rows_.emplace_back();
    Row& row = rows_[count_++];
    row.clear();
    return row;
  }
  /// A copy of `source`. The edition of `source` must change whenever `source` does. The caller
  /// sets the value and `active`.
  Row& append_copy(const Row& source) {
    if (count_ == rows_.size()) rows_.emplace_back();
    Row& row = rows_[count_++];
    if (row.source != &source || row.edition != source.edition) {
      row = source;
      row.source = &source;
    }
    return row;
  }

 private:
  std::vector<Row> rows_;
  std::size_t count_ = 0;
};

}  // namespace sheave
