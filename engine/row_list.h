#pragma once
// The rows that features append for a solver of all of them at once.
//
// Many rows are the same from round to round and from substep to substep but for their value. Such
// a row names the row that it is a copy of and which edition of it, so that neither it nor anything
// that follows from it is made anew where it already is.

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

  /// Begins anew; what was there is kept for append_copy().
  void clear() { count_ = 0; }
  /// An empty row.
  Row& emplace_back() {
    if (count_ == rows_.size()) rows_.emplace_back();
    Row& row = rows_[count_++];
    row.clear();
    return row;
  }
  /// A copy of `source`, whose `edition` must change whenever it does; value and `active` are the
  /// caller's to set.
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
