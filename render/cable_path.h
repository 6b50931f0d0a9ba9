#pragma once
// The tubes of a cable, coloured by tension, along its lines (cable/cable_polyline.h).

#include <optional>
#include <vector>

#include "cable/cable_polyline.h"
#include "cable/cable_report.h"
#include "render/draw_list.h"

namespace sheave::render {

struct CableStyle {
  double radius = 0.01;      ///< of the drawn cable [m]
  double tolerance = 0.001;  ///< largest distance of drawn lines from the cable [m]
  double tension_max = 1.0;  ///< tension at the top of the colour map [N], > 0
  ColorMap map = ColorMap::tension;
  Vector3 gravity{0.0, -1.0, 0.0};  ///< direction in which slack spans sag; any length
  /// A floor on which slack spans come to rest instead of sagging through it.
  std::optional<Plane> floor{};
  /// Room along the axis for windings side by side [m], one per link; missing ones count as 0.
  std::vector<double> winding_room{};
};

/// Colour of a span with this tension [N]; slack_color if it carries none.
[[nodiscard]] Color tension_color(double tension, const CableStyle& style);

/// The centre lines of spans as drawn, one per span; slack ones as catenaries. All are empty for a
/// cut cable.
[[nodiscard]] std::vector<std::vector<Vector3>> span_lines(const CableReport& cable,
                                                           const CableStyle& style);

/// The centre lines on links as drawn, one per link: round wheels, along outlines; empty for
/// points, and where an arc is too short to blend colours over. Spans and links in order form the
/// whole cable.
[[nodiscard]] std::vector<std::vector<Vector3>> link_lines(const CableReport& cable,
                                                           const CableStyle& style);

/// The two pieces of a cut cable as they hang at rest; of a belt empty.
[[nodiscard]] std::vector<std::vector<Vector3>> piece_lines(const CableReport& cable,
                                                            const CableStyle& style);

/// Slack cable along a line.
[[nodiscard]] Tube slack_tube(const std::vector<Vector3>& line, double radius);

/// The whole cable, cut at points (attachments) where its colour jumps with the tension.
[[nodiscard]] std::vector<Tube> cable_tubes(const CableReport& cable, const CableStyle& style);

}  // namespace sheave::render
