#pragma once
// The line along which a cable is drawn: straight or sagging spans, and the turns round its wheels.

#include <optional>
#include <vector>

#include "cable/cable_report.h"
#include "render/draw_list.h"

namespace sheave::render {

struct CableStyle {
  double radius = 0.01;      ///< of the drawn cable [m]
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

/// Whether a span sags: its rest length exceeds the distance between its ends, and it has no
/// tension.
[[nodiscard]] bool is_slack(const SpanReport& span);

/// The angle from the point where the cable meets the wheel to the point where it leaves it [rad],
/// counted in the direction of the winding. The fraction of a turn follows from the two points, so
/// that the drawn line meets the spans exactly; the number of whole turns follows from the stored
/// length. At the end of an open cable the two points coincide and only the stored length counts. A
/// little negative for a cable that is just leaving its wheel.
[[nodiscard]] double wound_angle(const LinkReport& link, bool is_end);

/// The centre lines of spans as drawn, one per span; slack ones as catenaries.
[[nodiscard]] std::vector<std::vector<Vector3>> span_lines(const CableReport& cable,
                                                           const CableStyle& style);

/// The centre lines on links as drawn, one per link: round wheels, along outlines; empty for
/// points. Spans and links in order form the whole cable. All are empty for a cut cable.
[[nodiscard]] std::vector<std::vector<Vector3>> link_lines(const CableReport& cable,
                                                           const CableStyle& style);

/// The whole cable, cut at points (attachments) where its colour jumps with the tension.
[[nodiscard]] std::vector<Tube> cable_tubes(const CableReport& cable, const CableStyle& style);

}  // namespace sheave::render
