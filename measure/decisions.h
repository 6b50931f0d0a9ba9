#pragma once
// Decisions of a run, and by how much they were made.
//
// The least margin of a branch (measure/margin_watch.h) has an error, as every number of a run. Three runs
// with shorter and shorter substeps have the margins m1, m2 and m3, and the error of m1 is estimated like
// that of a position without an order: |m1 - m3| + max(|m2 - m3|, |m1 - m2| / 2). A decision is close if the
// margin is no larger than its error, or if one of the runs has gone into a branch that another one has
// never entered. The exact motion may then belong to the other branch.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/margin_watch.h"

namespace sheave::measure {

struct Decision {
  std::string alternative;  ///< in words, such as "span rope.0"
  std::string_view branch;  ///< of the run at that time, such as "is taut"
  std::string_view other;   ///< the other branch
  double margin =
      0.0;  ///< least distance from the other branch; 0 if the runs differ and it was left
  std::string_view unit;  ///< of the margin; empty: a share
  double time = 0.0;      ///< [s]; if the runs differ, when one of them first changed the branch
  std::optional<double>
      error{};  ///< of the margin; unknown if the runs differ or have no such margin
  std::array<bool, 3> took_other{};  ///< whether the runs have ever entered the other branch
  bool close = false;

  /// Whether some runs entered the other branch, and others did not.
  [[nodiscard]] bool differs() const {
    return took_other[0] != took_other[1] || took_other[1] != took_other[2];
  }
  /// Margin in units of its error; infinite without an error.
  [[nodiscard]] double safety() const;
};

/// The decisions of the first of three runs, the closest first.
[[nodiscard]] std::vector<Decision> find_decisions(
    const BranchReader& reader, const std::array<std::map<AlternativeKey, BranchRecord>, 3>& runs);

}  // namespace sheave::measure
