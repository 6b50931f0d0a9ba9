#pragma once
// Spans whose row is affine; internal to the cable library.
//
// The value of a span's row (cable/span_row.h) bends only where the span's direction turns. Between
// wheels on fixed axles it never does, in whatever planes they lie, nor between these and what
// slides along the span: a weight on its rails below a sheave, or the sheaves of a block that
// slides. Then, with the length l along the direction u,
//   C = L + q1 n1.b1 - q2 n2.b2 - l,   l = l0 + u.(x2 - x1),
// exactly, with the turns b of the wheels since the start of the substep and the places x of what
// slides, and the gradient is a constant. So there is no geometry to find, neither for the row nor
// at the end of the substep.
//
// It holds while the length is above 0. What can slide so far within a substep that it might end is
// left to the general row.

#include <array>
#include <vector>

#include "cable/winding_kernels.h"
#include "engine/row.h"
#include "engine/substep.h"

namespace sheave {

/// Follows from the course of the cable and from where bodies are at time 0 alone, so that a run
/// does not depend on when it was found.
struct AffineSpan {
  /// One end of the span.
  struct End {
    int wheel = -1;                  ///< the body that turns it; -1: none
    int slider = -1;                 ///< the body that slides it along the span; -1: none
    Vector3 turn = Vector3::Zero();  ///< cable that the wheel gives the span per rotation [m]
  };

  bool possible = false;
  Row row;  ///< but for its value
  End first;
  End second;
  Vector3 direction = Vector3::Zero();  ///< u
  double length = 0.0;                  ///< l0 [m]

  /// l [m]
  [[nodiscard, gnu::always_inline]] double length_now(const Substep& substep) const {
    double sum = length;
    if (second.slider >= 0) sum += dot(direction, position(substep, second));
    if (first.slider >= 0) sum -= dot(direction, position(substep, first));
    return sum;
  }
  /// What the wheel gives the span since the start of the substep [m].
  [[nodiscard, gnu::always_inline]] static double given(const Substep& substep, const End& end) {
    if (end.wheel < 0) return 0.0;
    return dot(end.turn, substep.moving[static_cast<std::size_t>(end.wheel)].turn);
  }
  /// C [m] with the rest length at the start.
  [[nodiscard, gnu::always_inline]] double value(const Substep& substep, double rest_length) const {
    return rest_length + given(substep, first) + given(substep, second) - length_now(substep);
  }
  /// Whether the span is too long to end within the substep, whose start is where bodies are now.
  [[nodiscard]] bool lasts(const Substep& substep) const;
  // It is longer than `margin` times what its ends could slide, and than `shortest` of the scene.
  static constexpr double margin = 4.0;
  static constexpr double shortest = 1e-6;

 private:
  static const Vector3& position(const Substep& substep, const End& end) {
    return substep.moving[static_cast<std::size_t>(end.slider)].position;
  }
};

/// The same where all that moves is counted in single numbers (engine/dynamics/affine_bodies.h).
struct MovingSpan {
  struct End {
    int wheel = 0;       ///< number of the wheel; 0: none
    double given = 0.0;  ///< cable that it gives the span per radian [m]
    int slider = 0;      ///< number of what slides
    double along = 0.0;  ///< u along its direction
    int link = 0;
    bool runs_out = false;  ///< the cable ends there, and nothing holds it
    bool bounded = false;   ///< without stored cable it is left, or ends in another way
  };
  std::array<End, 2> ends;
  double length = 0.0;  ///< with all places at 0 [m]
  bool slides = false;
  bool driven = false;  ///< one of the wheels is
  int cable = 0;
};

/// What every substep needs of one that slides, close together.
struct FlatSlide {
  int span = 0;
  // Of both ends.
  std::array<int, 2> sliders{};  ///< number of what slides; 0: nothing, at place 0
  std::array<double, 2> along{};
  double length = 0.0;    ///< with all places at 0 [m]
  double shortest = 0.0;  ///< [m]
};

/// All of them.
struct MovingSpans {
  std::vector<MovingSpan> spans;
  WindingSpans winding;            ///< of each, what every substep needs
  std::vector<double> moved;       ///< scratch of winding: two per span, and a 0
  std::vector<FlatSlide> sliding;  ///< of those that slide
  std::vector<int> driven;         ///< and which ones a driven wheel gives cable
  bool elastic = false;            ///< some are springs
  const BodySet* bodies = nullptr;

  /// Of so many links, when all spans are known.
  void find_link_ends(std::size_t links);
};

}  // namespace sheave
