#pragma once
// Places each label near its anchor, clear of other labels, the cables and the edges of the
// picture. Pure geometry in pixels; the same input gives the same places.

#include <array>
#include <span>
#include <vector>

namespace sheave::render {

struct Rectangle {
  double x = 0.0;  ///< left edge [pixels]
  double y = 0.0;  ///< top edge [pixels]
  double width = 0.0;
  double height = 0.0;
};

/// Area that two rectangles share [pixels^2].
[[nodiscard]] double overlap(const Rectangle& a, const Rectangle& b);

struct LabelRequest {
  double x = 0.0;  ///< anchor [pixels]
  double y = 0.0;
  double direction_x = 0.0;  ///< preferred direction from the anchor (y down); both zero: any
  double direction_y = 0.0;
  double slide_x = 0.0;  ///< the anchor may move by this in both directions [pixels]
  double slide_y = 0.0;
  double width = 0.0;  ///< of the text [pixels]
  double height = 0.0;
};

/// From (x0, y0) to (x1, y1).
using ScreenSegment = std::array<double, 4>;

struct LabelSurroundings {
  double width = 0.0;  ///< of the picture [pixels]
  double height = 0.0;
  double gap = 8.0;                      ///< nearest distance from anchor to text [pixels]
  std::span<const Rectangle> occupied;   ///< other text; must not be covered
  std::span<const ScreenSegment> lines;  ///< should not be covered
  std::span<const Rectangle> bodies;     ///< better not covered
};

struct LabelPlace {
  Rectangle text;
  double anchor_x = 0.0;  ///< anchor after its move [pixels]
  double anchor_y = 0.0;
  bool covers = false;  ///< the text covers a line or a body, so it needs a leader
};

/// The place for each request, in order.
[[nodiscard]] std::vector<LabelPlace> place_labels(std::span<const LabelRequest> labels,
                                                   const LabelSurroundings& around);

}  // namespace sheave::render
