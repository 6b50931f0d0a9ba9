#pragma once
// The line of a cable as points, for programs that draw it.
//
//   CableReports cables;  // once
//   std::vector<Vector3> points(1000);
//   cables.read(world.simulation());  // in every frame
//   const auto count = world.cable_polyline(rope, 0, cables, {.tolerance = 1e-3}, points);
//
// No function here allocates memory. Each returns the number of points of the line. If that is more
// than `points` has room for, the first ones are written, and the rest of the line is left out.

#include <cstddef>
#include <optional>
#include <span>

#include "cable/cable_report.h"
#include "engine/vector.h"

namespace sheave {

/// A floor on which slack cable comes to rest.
struct PolylineFloor {
  Vector3 point = Vector3::Zero();    ///< any of its points [m]
  Vector3 normal = Vector3::UnitY();  ///< unit vector out of the floor
};

struct PolylineOptions {
  /// Largest distance of the polyline from the cable [m], > 0. A line has at most 2001 points for
  /// a span and 8000 for a link, however small the tolerance.
  double tolerance = 1e-3;
  Vector3 gravity{0.0, -1.0, 0.0};  ///< direction in which slack cable hangs; any length
  double radius = 0.0;              ///< of the drawn cable [m], >= 0: its height above a floor
  std::optional<PolylineFloor> floor{};
  /// Room along the axis for windings side by side [m], one per listed link; missing ones count as
  /// 0, and all windings then lie in one plane.
  std::span<const double> winding_room{};
};

/// Whether a span sags: its rest length exceeds the distance between its ends, and it has no
/// tension.
[[nodiscard]] bool is_slack(const SpanReport& span);

/// The angle from the point where the cable meets the wheel to the point where it leaves it [rad],
/// counted in the direction of the winding. The fraction of a turn follows from the two points, so
/// that the drawn line meets the spans exactly; the number of whole turns follows from the stored
/// length. At the end of an open cable the two points coincide and only the stored length counts. A
/// little negative for a cable that is just leaving its wheel.
[[nodiscard]] double wound_angle(const LinkReport& link, bool is_end);

/// The span number `span` of the report [0 ... spans - 1]: straight, or hanging if it is slack or has
/// weight. Wraps on other bodies are not in it; use CableReport::with_wraps_in_place().
std::size_t span_polyline(const CableReport& cable, std::size_t span,
                          const PolylineOptions& options, std::span<Vector3> points);

/// The cable on the link number `link` of the report [0 ... links - 1]: round a wheel, along an
/// outline or a geodesic. No points where the link is a point. Of a cut cable only its ends have
/// cable on their wheels.
std::size_t link_polyline(const CableReport& cable, std::size_t link,
                          const PolylineOptions& options, std::span<Vector3> points);

/// A piece of a cut cable as it hangs at rest: piece 0 from the first link, piece 1 to the last one.
/// The cable on the wheel of the end is in it. Cable that reaches the floor lies along it. No points
/// for a belt, whose pieces nothing holds.
std::size_t piece_polyline(const CableReport& cable, std::size_t piece,
                           const PolylineOptions& options, std::span<Vector3> points);

/// The part of a cable that belongs to a listed span: from where the cable meets the link at which
/// the span begins to where it meets the next listed link, with the wraps between the two. The last
/// span of an open cable includes the last link. All spans in order are the whole cable. Of a cut
/// cable `span` is the number of a piece instead, 0 or 1.
std::size_t cable_polyline(const CableReport& cable, std::size_t span,
                           const PolylineOptions& options, std::span<Vector3> points);

}  // namespace sheave
