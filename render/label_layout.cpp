// A greedy layout with one round of repair. Each label takes its cheapest place from a fixed set,
// given the labels placed before it; then each label is placed once more, given all others. Cost: 2
// rounds x labels x places x (labels + lines).
#include "render/label_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheave::render {
namespace {

/// Turns off the preferred direction, in order of preference [rad].
constexpr std::array<double, 10> turns{0.0, 0.5, -0.5, 1.0, -1.0, 1.57, -1.57, 2.3, -2.3, 3.14};
/// Distances from the anchor, in gaps. The far ones, drawn with a leader, serve labels that find no
/// room near their anchors, for example between the parts of a tackle.
constexpr std::array<double, 8> distances{1.0, 2.2, 3.8, 6.0, 9.0, 13.0, 18.0, 24.0};
/// Fractions of the slide.
constexpr std::array<double, 7> slides{0.0, 0.35, -0.35, 0.7, -0.7, 1.0, -1.0};

/// With more labels than this the layout ignores the lines that labels cover: the picture is full
/// anyway, and the work would take noticeable time.
constexpr std::size_t many_labels = 60;

double covered_length(const Rectangle& r, const ScreenSegment& s) {
  // Clips the segment to the rectangle (Liang and Barsky).
  double t0 = 0.0;
  double t1 = 1.0;
  const double dx = s[2] - s[0];
  const double dy = s[3] - s[1];
  const std::array<std::array<double, 2>, 4> sides{{{-dx, s[0] - r.x},
                                                    {dx, r.x + r.width - s[0]},
                                                    {-dy, s[1] - r.y},
                                                    {dy, r.y + r.height - s[1]}}};
  for (const auto& [p, q] : sides) {
    if (p == 0.0) {
      if (q < 0.0) return 0.0;
    } else if (p < 0.0) {
      t0 = std::max(t0, q / p);
    } else {
      t1 = std::min(t1, q / p);
    }
  }
  return t1 > t0 ? (t1 - t0) * std::hypot(dx, dy) : 0.0;
}

LabelPlace place(const LabelRequest& label, double slide, double direction, double distance) {
  const double x = label.x + slide * label.slide_x;
  const double y = label.y + slide * label.slide_y;
  const double c = std::cos(direction);
  const double s = std::sin(direction);
  // The distance holds for the nearest side of the text, not for its centre.
  const double reach = 0.5 * std::min(label.width / std::max(std::abs(c), 1e-9),
                                      label.height / std::max(std::abs(s), 1e-9));
  const Rectangle text{x + c * (reach + distance) - 0.5 * label.width,
                       y + s * (reach + distance) - 0.5 * label.height, label.width, label.height};
  return {text, x, y};
}

class Layout {
 public:
  Layout(std::span<const LabelRequest> labels, const LabelSurroundings& around)
      : labels_(labels), around_(around), places_(labels.size()), placed_(labels.size(), false) {}

  std::vector<LabelPlace> run() {
    for (int round = 0; round < 2; ++round) {
      for (std::size_t i = 0; i < labels_.size(); ++i) choose(i);
    }
    for (LabelPlace& place : places_) place.covers = covers(place.text);
    return std::move(places_);
  }

 private:
  void choose(std::size_t i) {
    const LabelRequest& label = labels_[i];
    const bool any = label.direction_x == 0.0 && label.direction_y == 0.0;
    const double preferred = any ? 0.0 : std::atan2(label.direction_y, label.direction_x);
    const bool fixed = label.slide_x == 0.0 && label.slide_y == 0.0;
    best_ = std::numeric_limits<double>::infinity();
    const auto allowed_slides = std::span(slides).first(fixed ? 1 : slides.size());
    for (std::size_t d = 0; d < distances.size(); ++d) {
      for (const double turn : turns) {
        for (const double slide : allowed_slides) {
          const double own = 3.0 * static_cast<double>(d) + (any ? 0.4 : 1.0) * std::abs(turn) +
                             1.2 * std::abs(slide);
          if (own >= best_) continue;
          consider(place(label, slide, preferred + turn, distances[d] * around_.gap), own, i);
        }
      }
    }
    placed_[i] = true;
  }

  /// Takes the candidate for label i if it is the best one so far.
  void consider(const LabelPlace& candidate, double own, std::size_t i) {
    const double cost = own + conflicts(candidate, i);
    if (cost >= best_) return;
    best_ = cost;
    places_[i] = candidate;
  }

  [[nodiscard]] bool covers(const Rectangle& text) const {
    const auto& lines = around_.lines;
    const auto& bodies = around_.bodies;
    return std::any_of(lines.begin(), lines.end(),
                       [&](const ScreenSegment& l) { return covered_length(text, l) > 0.0; }) ||
           std::any_of(bodies.begin(), bodies.end(),
                       [&](const Rectangle& body) { return overlap(text, body) > 0.0; });
  }

  [[nodiscard]] double conflicts(const LabelPlace& candidate, std::size_t self) const {
    const Rectangle& r = candidate.text;
    const double area = std::max(r.width * r.height, 1.0);
    const Rectangle padded{r.x - 3.0, r.y - 1.0, r.width + 6.0, r.height + 2.0};
    // Text needs more space at its sides than above and below; otherwise it reads as part of the
    // lines beside it.
    const double air = std::max(3.0, 0.45 * around_.gap);
    const Rectangle airy{r.x - air, r.y - 1.0, r.width + 2.0 * air, r.height + 2.0};
    const Rectangle picture{2.0, 2.0, around_.width - 4.0, around_.height - 4.0};
    double cost = 300.0 * (1.0 - overlap(r, picture) / area);
    for (const Rectangle& other : around_.occupied) cost += 200.0 * overlap(padded, other) / area;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (k != self && placed_[k]) cost += 100.0 * overlap(padded, places_[k].text) / area;
    }
    if (labels_.size() <= many_labels) {
      double covered = 0.0;
      for (const ScreenSegment& line : around_.lines) covered += covered_length(airy, line);
      cost += 10.0 * std::min(4.0, covered / std::max(r.height, 1.0));
      double hidden = 0.0;
      for (const Rectangle& body : around_.bodies) hidden += overlap(r, body) / area;
      cost += 5.0 * std::min(1.0, hidden);
    }
    return cost;
  }

  std::span<const LabelRequest> labels_;
  const LabelSurroundings& around_;
  std::vector<LabelPlace> places_;
  std::vector<bool> placed_;
  double best_ = 0.0;  ///< cost of the place chosen so far for the present label
};

}  // namespace

double overlap(const Rectangle& a, const Rectangle& b) {
  const double w = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  const double h = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  return w > 0.0 && h > 0.0 ? w * h : 0.0;
}

std::vector<LabelPlace> place_labels(std::span<const LabelRequest> labels,
                                     const LabelSurroundings& around) {
  return Layout(labels, around).run();
}

}  // namespace sheave::render
