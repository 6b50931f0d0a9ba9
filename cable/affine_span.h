#pragma once
// Spans whose row is affine; internal to the cable library.
//
// The value of a span's row (cable/span_row.h) is nonlinear only if the span's direction turns.
// Between wheels on fixed axles the direction is constant, in any planes. The direction is
// also constant between such wheels and bodies that slide along the span: a weight on its rails
// below a sheave, or the sheaves of a sliding block. With the length l along the direction u,
//   C = L + q1 n1.b1 - q2 n2.b2 - l,   l = l0 + u.(x2 - x1),
// holds exactly, where b are the rotations of the wheels since the start of the substep and x the
// positions of the sliding bodies. The gradient is constant. So no geometry needs to be computed,
// neither for the row nor at the end of the substep.
//
// The formula holds while l > 0. A span that might vanish within a substep because its ends slide
// is left to the general row.

#include <array>
#include <vector>

#include "cable/winding_kernels.h"
#include "engine/row.h"
#include "engine/substep.h"

namespace sheave {

/// Depends only on the course of the cable and on the bodies' positions at time 0, so that a run
/// does not depend on the moment of this computation.
struct AffineSpan {
  /// One end of the span.
  struct End {
    int wheel = -1;                  ///< the body that turns it; -1: none
    int slider = -1;                 ///< the body that slides it along the span; -1: none
    Vector3 turn = Vector3::Zero();  ///< cable that the wheel adds per rotation [m]
  };

  bool possible = false;
  Row row;  ///< complete except for its value
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
  /// Cable that the wheel has given to the span since the start of the substep [m].
  [[nodiscard, gnu::always_inline]] static double given(const Substep& substep, const End& end) {
    if (end.wheel < 0) return 0.0;
    return dot(end.turn, substep.moving[static_cast<std::size_t>(end.wheel)].turn);
  }
  /// C [m] with the rest length at the start.
  [[nodiscard, gnu::always_inline]] double value(const Substep& substep, double rest_length) const {
    return rest_length + given(substep, first) + given(substep, second) - length_now(substep);
  }
  /// Whether the span is too long to vanish within the substep, at whose start the bodies are.
  [[nodiscard]] bool lasts(const Substep& substep) const;
  // The span is longer than `margin` times the displacement of its sliding ends, and than
  // `shortest` times the size of the scene.
  static constexpr double margin = 4.0;
  static constexpr double shortest = 1e-6;

 private:
  static const Vector3& position(const Substep& substep, const End& end) {
    return substep.moving[static_cast<std::size_t>(end.slider)].position;
  }
};

/// An affine span if every motion is a single number (engine/dynamics/affine_bodies.h).
struct MovingSpan {
  struct End {
    int wheel = 0;       ///< number of the wheel; 0: none
    double given = 0.0;  ///< cable that the wheel gives per radian [m]
    int slider = 0;      ///< number of the sliding body
    double along = 0.0;  ///< component of u along the slider's direction
    int link = 0;
    bool runs_out = false;  ///< the cable ends there, and no attachment holds it
    bool bounded = false;   ///< without stored cable the link is left, or ends in another way
  };
  std::array<End, 2> ends;
  double length = 0.0;  ///< with all displacements 0 [m]
  bool slides = false;
  bool driven = false;  ///< a drive turns one of the wheels
  int cable = 0;
};

/// The data of a sliding span that every substep needs, stored contiguously.
struct FlatSlide {
  int span = 0;
  // For both ends:
  std::array<int, 2> sliders{};  ///< number of the sliding body; 0: none, at displacement 0
  std::array<double, 2> along{};
  double length = 0.0;    ///< with all displacements 0 [m]
  double shortest = 0.0;  ///< [m]
};

/// All moving spans of the scene.
struct MovingSpans {
  std::vector<MovingSpan> spans;
  WindingSpans winding;            ///< of each span: the data that every substep needs
  std::vector<double> moved;       ///< scratch of winding: two per span, and a 0
  std::vector<FlatSlide> sliding;  ///< of the sliding spans
  std::vector<int> driven;         ///< indices of the spans that a driven wheel feeds
  bool elastic = false;            ///< some are springs
  const BodySet* bodies = nullptr;

  /// To be called when all spans are known; `links`: number of links.
  void find_link_ends(std::size_t links);
};

}  // namespace sheave
