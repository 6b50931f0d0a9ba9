#pragma once
// A knot of cables in a substep: cable/knots.h.

#include <vector>

#include "cable/cable_parts.h"
#include "cable/knot_point.h"
#include "engine/row.h"

namespace sheave::cable_parts {

/// A cable that ends at a knot.
struct KnotEnd {
  int cable = 0;
  bool at_start = true;  ///< the first link of the cable is on the knot; otherwise the last one
};

struct KnotWork {
  // Constants.
  int body = 0;  ///< the knot, among the bodies
  /// Index of its first multiplier, the force of its row x h^2; each of its rows has one, of the same
  /// value.
  int index = 0;
  std::vector<KnotEnd> ends;
  // Scratch, which begin() fills anew.
  std::vector<Run> runs;  ///< per end: the spans that share the tension of the span at the knot
  bool bends = false;     ///< the end of a span on a wheel moves with the knot
  bool pulls = false;     ///< it had a force in the last substep
  // As last evaluated.
  std::vector<KnotArm> arms;  ///< per end
  KnotPlace place;
  std::vector<Row> rows;             ///< of all spans of the runs
  std::vector<int> row_ends;         ///< per row: its end
  double value = 0.0;                ///< of the knot's row [m]
  std::vector<double> start_shares;  ///< at the start of a substep of `rattle`; empty: not known
};

}  // namespace sheave::cable_parts
