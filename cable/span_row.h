#pragma once
// One free span as a constraint row; internal to the cable library.
//
// C = L - l >= 0 with the length l and the rest length L. Without slip L follows from the motion of
// the bodies since the start of the substep (design 5.2). With the change A of the angle of the
// span's tangent point in the link's plane and the rotation B of the body about the plane's normal,
//   incoming end:  L += q2 (A2 - B2)        outgoing end:  L -= q1 (A1 - B1);
// On an outline q (A - B) is replaced by the path along it (cable/outline.h), and the rest of this
// text holds for the circle at the corner where the span ends. In one plane A1 = A2 is the change
// of the span's direction. So C is a function of the positions and cannot drift.
//
// Gradient: a tangent point that moves along its wheel changes l and L by the same amount, so only
// the material points count (envelope theorem): grad C = +u at the start, -u at the end. In one
// plane the reason is that the span is tangent to the circle. In different planes the reason is
// that its line has the moment q about the axle (cable/span_geometry.h): when the end moves by da
// in the wheel's frame and turns by df about the axle, l changes by u.da = q df, and L changes by
// the same amount. The row contains the whole force: the span pulls its ends together, and the
// wheel gets the torque q T. The groove's flank, which bends the rope, acts on the wheel itself.
// C's gradient is exact, so the motion conserves energy, and the tension is equal on both sides of
// a skew wheel. (Without a tangent in one plane the centres count, too; see add_turning_terms(). In
// space no terms are added.)
//
// A drum with layers has the radius q of its outermost layer, which depends on the winding angle
// psi = A - B: dq = pitch / 2 pi dpsi (cable/cable_layers.cpp). The drum takes up the integral of q
// dpsi. If only the radius changes, the end moves perpendicular to u except for q df, so a radius
// that depends on the angle adds nothing to the gradient. A groove that leads the rope along the
// axle changes the moment q (cable/span_groove.h).

#include <cstddef>

#include "cable/link.h"
#include "cable/span_contact.h"
#include "cable/span_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// How the geometry of a span is computed.
enum class SpanKind {
  straight,  ///< between two points
  planar,    ///< both links stay in one plane that never turns
  spatial,   ///< all other cases but the next one
  grooved,   ///< one end or both on a drum with a groove (cable/span_groove.h)
};

/// Constants of one span.
struct SpanSetup {
  int cable = 0;
  int first = 0;   ///< link it leaves; index into the links of all cables
  int second = 0;  ///< link it meets
  SpanKind kind = SpanKind::straight;
  Vector3 normal = Vector3::UnitZ();  ///< planar: of the common plane, world frame
  double first_radius = 0.0;          ///< planar: signed radii, seen against `normal` [m]
  double second_radius = 0.0;
  bool active = true;        ///< false: its first link is lifted, so the span does not exist
  bool outlined = false;     ///< at least one of the links is an outline
  double first_sense = 1.0;  ///< planar: +1 if the link's normal is `normal`, -1 if opposite
  double second_sense = 1.0;
};

/// The data of a span during a substep: the reference for its transport.
struct SpanReference {
  double rest_length = 0.0;                 ///< at the start of the substep [m]
  SpanGuess ends;                           ///< spatial: last position of the ends
  Vector3 direction = Vector3::Zero();      ///< planar: u at the start
  Vector3 left = Vector3::Zero();           ///< planar: n x u at the start
  double expected_turn = 0.0;               ///< planar: of u over the substep [rad]
  Vector3 first_radial = Vector3::Zero();   ///< spatial: e1 at the start, carrier's own frame
  Vector3 second_radial = Vector3::Zero();  ///< spatial: e2 at the start
  int first_corner = 0;                     ///< outlines: contact corner at the start
  int second_corner = 0;
  double first_angle = 0.0;  ///< outlines: normal angle at the start [rad], carrier's own frame
  double second_angle = 0.0;
  Vector3 first_far =
      Vector3::Zero();  ///< spatial outlines: the span's other end at the start, own frame
  Vector3 second_far = Vector3::Zero();   ///< of the carrier
  Vector3 first_point = Vector3::Zero();  ///< tangent_update substep: own frame of the body
  Vector3 second_point = Vector3::Zero();
};

/// Rest length that has entered the span since the start of the substep.
struct SpanTransport {
  double from_first = 0.0;   ///< from the first link [m]
  double from_second = 0.0;  ///< from the second link [m]
};

/// The span at the present positions; a guess shortens the search (cable/span_geometry.h).
[[nodiscard]] SpanGeometry span_geometry(const Substep& substep, const SpanSetup& setup,
                                         const LinkGeometry& first, const LinkGeometry& second,
                                         const SpanGuess* guess = nullptr);

/// The reference for the coming substep, at whose start the bodies are. `known`, if it is not null,
/// is the span at that start.
[[nodiscard]] SpanReference span_reference(const Substep& substep, const SpanSetup& setup,
                                           const LinkGeometry& first, const LinkGeometry& second,
                                           double rest_length, const SpanGeometry* known = nullptr);

/// Transport since the start of the substep, for the present positions and span.
[[nodiscard]] SpanTransport span_transport(const Substep& substep, const SpanSetup& setup,
                                           const LinkGeometry& first, const LinkGeometry& second,
                                           const SpanReference& reference,
                                           const SpanGeometry& geometry);

/// The span at the present positions, and its transport since the start of the substep.
SpanGeometry moved_span(const Substep& substep, const SpanSetup& setup, const LinkGeometry& first,
                        const LinkGeometry& second, const SpanReference& reference,
                        SpanTransport& transport);

/// Value and gradient of the row; bounds and compliance are left to the caller. Returns the span;
/// `transport` gets the part of the value that is transport.
SpanGeometry evaluate_span(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second,
                           const SpanReference& reference, Row& row, SpanTransport& transport);

/// The same with attachments that stay fixed to the bodies during the substep, as in the paper.
SpanGeometry evaluate_span_frozen(const Substep& substep, const LinkGeometry& first,
                                  const LinkGeometry& second, const SpanReference& reference,
                                  Row& row);

}  // namespace sheave
