#pragma once
// What solvers know of a link, whatever its type.

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "cable/outline.h"
#include "engine/vector.h"

namespace sheave {

/// An outline placed on a body: coordinates of the body that carries the link.
struct LinkOutline {
  Outline curve;
  Vector3 x = Vector3::UnitX();  ///< axes of the outline's plane; x cross y is the link's normal
  Vector3 y = Vector3::UnitY();
  std::vector<Vector3> corners;  ///< of the curve, relative to the carrier's centre of mass [m]
};

/// A link as the step needs it. All link types share one geometry: a circle of signed radius in a
/// plane fixed to a body; a point is a circle of radius 0, and an outline has one such circle at
/// each corner.
struct LinkGeometry {
  int body = 0;     ///< the body whose turning moves cable: the one the cable touches, or `wheel`
  int carrier = 0;  ///< the body that carries `center` and `normal`: of a wheel on a mounted rotor
                    ///< the rotor's carrier, otherwise `body`
  bool mounted = false;               ///< whether `body` is a mounted rotor
  Vector3 center = Vector3::Zero();   ///< [m], own frame of the carrier
  bool centered = false;              ///< `center` is 0, so its position needs no rotation
  bool still = false;                 ///< the carrier is the world: centre and normal stay
  Vector3 normal = Vector3::UnitZ();  ///< unit normal of the link's plane, own frame of the carrier
  int side = 0;                       ///< +1 counter-clockwise, -1 clockwise, 0 a point
  double signed_radius = 0.0;         ///< side times the radius, of an outline at its corners [m]
  std::shared_ptr<const LinkOutline> outline;  ///< null: a circle about `center`, or a point
  /// Cable on the body at time 0 [m] as the user gave it; NaN: the arc between the tangents.
  double given_stored_length = 0.0;
  /// Whether the cable slides over the link instead of rolling with it: a pinhole.
  bool slides = false;
  /// Capstan coefficient of a link over which the cable can slide; NaN: it cannot.
  double friction = std::numeric_limits<double>::quiet_NaN();
  /// Of a massless wheel that takes a part of the tension: -ln of its efficiency, the exponent of
  /// its capstan whatever the wrap angle; 0: it takes none. The bearing that holds it, or lets it
  /// turn, is the carrier's, so `body` is the carrier: the cable slides over a post that stands on
  /// it. (A wheel that went on turning as in the substep before would hold the cable at a speed.)
  double loss_exponent = 0.0;
  /// Of a wheel with inertia: its bearing holds it, or brakes it, with at most this times the sum of
  /// the tensions on both sides [m]; 0: it turns freely (cable/cable_bearings.cpp).
  double bearing_arm = 0.0;
  /// The rotor that the cable turns as it slides, where `body` is its carrier; -1: there is none.
  int wheel = -1;
  /// The link's rotor has no inertia, so the tension is the same on both sides and the cable's
  /// motion turns it.
  bool massless = false;
  bool ends_here = false;      ///< the link type is one for the end of an open cable only
  bool starts_lifted = false;  ///< the cable passes it by at time 0
  bool lifts = false;          ///< the cable can leave it and touch it again: between the ends
  bool hybrid = false;         ///< becomes an attachment when its stored length is used up
  /// Hybrid links: centre [m] and normal in the own frame of `body`, whose rim then holds the end.
  Vector3 rim_center = Vector3::Zero();
  Vector3 rim_normal = Vector3::UnitZ();
  double layer_pitch = 0.0;  ///< growth of the radius with every turn wound on [m]
  bool feeds = false;        ///< an attachment out of which cable comes, if at any speed but 0
  double feed_speed = 0.0;  ///< cable that enters the scene there [m/s]: the mean of a substep, ...
  double feed_end_speed = 0.0;  ///< ... and at its end
  int extra_turns = 0;          ///< whole turns beyond the arc between the tangents
  /// A ball without friction: the cable lies on it the shortest way, whose plane turns with the
  /// spans beside it (cable/cable_geodesics.cpp).
  bool geodesic = false;
  /// Of a geodesic: what its outgoing span gains over it in the substep, up to where bodies are now
  /// [m].
  double passed_on = 0.0;

  /// Makes the link hybrid; its centre and normal are in the own frame of `body`.
  void hold_end() {
    hybrid = true;
    rim_center = center;
    rim_normal = normal;
  }
  /// The body that a user sees the cable on.
  [[nodiscard]] int touched() const { return wheel >= 0 ? wheel : body; }
  [[nodiscard]] bool wraps() const { return side != 0; }
  /// Whether geometry depends on the cable's state, not only on the bodies.
  [[nodiscard]] bool changes() const { return hybrid || layer_pitch > 0.0; }
  /// Whether cable can pass from the span before the link to the one after it other than by
  /// rolling.
  [[nodiscard]] bool passes() const { return massless || !std::isnan(friction); }
  /// Whether what passes slides along the link's arc.
  [[nodiscard]] bool slides_over() const { return wraps() && !massless && !std::isnan(friction); }
  [[nodiscard]] bool frictionless() const {
    return loss_exponent == 0.0 && (massless || friction == 0.0);
  }
  [[nodiscard]] bool rubs() const { return passes() && !frictionless(); }
  /// Length of cable once round the link [m]; 0 for a point.
  [[nodiscard]] double perimeter() const {
    return outline ? outline->curve.perimeter() : 2.0 * pi * std::abs(signed_radius);
  }
};

/// Whether both are outlines of one body in one plane, or one circle twice: no span can be between
/// them.
[[nodiscard]] bool on_one_outline(const LinkGeometry& a, const LinkGeometry& b);

}  // namespace sheave
