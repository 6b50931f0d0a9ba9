#pragma once
// A row of smooth bodies of a cable, with no other link between them; internal to the library.

#include <span>

#include "cable/link_geometry.h"
#include "cable/span_row.h"
#include "engine/substep.h"

namespace sheave {

/// The links beside a row, and the spans between them and the row.
struct RowEnds {
  const SpanSetup& in;
  const LinkGeometry& first;
  const SpanSetup& out;
  const LinkGeometry& last;
};

/// Finds the geodesics of the row for the present positions. Of a belt on nothing but smooth bodies
/// all of them are the row. Where no geodesic exists, `settled` is false and the rest is unchanged.
void settle_row(const Substep& substep, std::span<LinkGeometry* const> row, const RowEnds& ends);

}  // namespace sheave
