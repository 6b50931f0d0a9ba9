#pragma once
// Geometry of a link, common to all link types.

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "cable/bearing_loss.h"
#include "cable/drum_groove.h"
#include "cable/outline.h"
#include "cable/smooth_surface.h"
#include "engine/vector.h"

namespace sheave {

/// An outline on a body, in the frame of the body that carries the link.
struct LinkOutline {
  Outline curve;
  Vector3 x = Vector3::UnitX();  ///< axes of the outline's plane; x cross y is the link's normal
  Vector3 y = Vector3::UnitY();
  std::vector<Vector3> corners;  ///< of the curve, relative to the carrier's centre of mass [m]
};

/// A smooth body on which the cable follows a geodesic and can slide sideways, in the own frame of
/// the carrier. A span sees either end of the geodesic as a point (cable/cable_geodesics.cpp).
struct GeodesicLink {
  SmoothSurface surface;
  SurfaceFrame entry;   ///< start of the geodesic
  SurfaceFrame exit;    ///< end of the geodesic
  double length = 0.0;  ///< length of the geodesic [m]
  double turned = 0.0;  ///< integral of the geodesic's curvature over its length [rad]
  /// Length that the incoming span has gained over the entry in this substep so far [m].
  double taken_on = 0.0;
  /// Length that the outgoing span has gained over the link in this substep so far [m].
  double passed_on = 0.0;
  bool settled = false;  ///< false: no geodesic exists on this side of the body
  /// For the guess at time 0, own frame of the carrier: the direction about which the cable runs
  /// counter-clockwise, or the point beside which the cable passes the body [m].
  Vector3 about = Vector3::Zero();
  std::optional<Vector3> beside;

  /// Whether the cable has slid off the body.
  [[nodiscard]] bool slides_off() const {
    return !settled || surface.beyond_ends(0.5 * (entry.point + exit.point)) > 0.0;
  }
};

/// A sheath that is fixed to a body, or to two.
struct SheathCurve {
  /// From the entry to the exit, in the own frame of the body [m]; at least 2. The last one is in
  /// the own frame of the body at the exit.
  std::vector<Vector3> points;
  int exit_body = 0;
  double length = 0.0;    ///< of the rope's way through it [m], > 0
  double bend = 0.0;      ///< sum of the angles by which it bends the rope [rad], >= 0
  double friction = 0.0;  ///< Coulomb's coefficient, >= 0
};

/// A link as the step uses it. All link types share one geometry: a circle of signed radius in a
/// plane fixed to a body. A point is a circle of radius 0. An outline has one such circle at each
/// corner. A geodesic has two points, which move on its body, and so has a sheath, at its ends.
struct LinkGeometry {
  /// the body whose rotation moves cable: the body that the cable touches, or the carrier of
  /// `wheel`
  int body = 0;
  /// The body that carries `center` and `normal`: for a wheel on a mounted rotor the rotor's
  /// carrier, otherwise `body`.
  int carrier = 0;
  bool mounted = false;               ///< whether `body` is a mounted rotor
  Vector3 center = Vector3::Zero();   ///< [m], own frame of the carrier
  bool centered = false;              ///< `center` is 0, so its position needs no rotation
  bool still = false;                 ///< the carrier is the world: centre and normal are constant
  Vector3 normal = Vector3::UnitZ();  ///< unit normal of the link's plane, own frame of the carrier
  int side = 0;                       ///< +1 counter-clockwise, -1 clockwise, 0 a point
  bool takes_shortest = false;  ///< `side` is the one on which the cable is shortest at time 0
  double signed_radius = 0.0;   ///< side times the radius [m]; for an outline the corner radius
  std::shared_ptr<const LinkOutline> outline;  ///< null: a circle about `center`, or a point
  /// Cable on the body at time 0 as given by the user [m]; NaN: the arc between the tangent points.
  double given_stored_length = 0.0;
  /// Whether the link is a pinhole: the cable slides through instead of rolling.
  bool slides = false;
  /// Capstan coefficient of a link over which cable can slide; NaN: it cannot slide.
  double friction = std::numeric_limits<double>::quiet_NaN();
  /// The way in which the link lets no cable slide: +1 towards the next span, -1 back, 0 none.
  int blocked = 0;
  /// Wheel with a bending loss or a bearing with friction.
  BearingLoss loss;
  /// Massless wheel with losses: the exponent of its capstan, -ln(efficiency), independent of the
  /// wrap angle; with friction of the pin that at half a turn. 0: no losses. The bearing that holds or releases the wheel
  /// belongs to the carrier, so `body` is the carrier, and the cable slides over a post that is
  /// fixed to the carrier. (A wheel that kept its rotation rate from the last substep would
  /// prescribe the cable's speed.)
  double loss_exponent = 0.0;
  /// Wheel with inertia: largest torque of its bearing divided by the sum of the tensions on both
  /// sides [m]; 0: it turns freely (cable/cable_bearings.cpp).
  double bearing_arm = 0.0;
  /// Share of the pin in `bearing_arm`: the load of the pin counts in place of the sum of the
  /// tensions.
  double pin_share = 0.0;
  /// The rotor that the sliding cable turns, if `body` is its carrier; -1: none.
  int wheel = -1;
  /// The link's rotor has no inertia. The tension is then equal on both sides, and the cable's
  /// motion determines the rotor's.
  bool massless = false;
  bool ends_here = false;      ///< the link type is allowed only at the end of an open cable
  bool starts_lifted = false;  ///< the cable does not touch it at time 0
  bool lifts = false;   ///< the cable can leave it and touch it again: a link between the ends
  bool hybrid = false;  ///< becomes an attachment when its stored length is used up
  /// Hybrid links: centre [m] and normal in the own frame of `body`, whose rim holds the end.
  Vector3 rim_center = Vector3::Zero();
  Vector3 rim_normal = Vector3::UnitZ();
  double layer_pitch = 0.0;  ///< growth of the radius per turn [m]
  /// Of a drum with a groove; null: another link. `center` and `signed_radius`, which is then
  /// side x dS/da, follow the rope along the groove (cable/span_groove.h).
  std::shared_ptr<const DrumGroove> groove;
  double wound = 0.0;        ///< angle of the rope in the groove at the start of a substep [rad]
  double axial_slope = 0.0;  ///< dz/da of the groove [m/rad]
  bool feeds = false;        ///< an attachment with a feed speed, which may be 0
  double feed_speed = 0.0;   ///< cable that enters the scene there [m/s]: mean over the substep
  /// cable that enters the scene there [m/s]: at the end of the substep
  double feed_end_speed = 0.0;
  int extra_turns = 0;  ///< whole turns beyond the arc between the tangents
  /// Smooth body in space. `center`, `normal` and `signed_radius` are then those of a circle round
  /// the body near the cable, for reports only.
  std::optional<GeodesicLink> geodesic;
  /// Opening: the ball or the endless cylinder whose inside the cable passes, own frame of the
  /// carrier. `center` is then where it passes (cable/opening.h), for the positions of the last
  /// settle_opening(). Null: no opening.
  std::shared_ptr<const SmoothSurface> opening;
  /// The rope runs through a sheath from `center` to the other end of the curve; null: no sheath.
  std::shared_ptr<const SheathCurve> sheath;

  /// Makes the link hybrid; its centre and normal are in the own frame of `body`.
  void hold_end() {
    hybrid = true;
    rim_center = center;
    rim_normal = normal;
  }
  /// The body on which the span behind the link begins.
  [[nodiscard]] int exit_body() const { return sheath ? sheath->exit_body : body; }
  /// The body on which a user sees the cable.
  [[nodiscard]] int touched() const { return wheel >= 0 ? wheel : body; }
  [[nodiscard]] bool wraps() const { return side != 0; }
  /// Lays the cable round the other side of the wheel.
  void take_other_side() {
    side = -side;
    signed_radius = -signed_radius;
  }
  /// Whether the geometry depends on the cable's state, not only on the bodies.
  [[nodiscard]] bool changes() const { return hybrid || is_layered(); }
  /// Whether the place or the radius of the rope on a drum depends on the angle.
  [[nodiscard]] bool is_layered() const { return layer_pitch > 0.0 || groove != nullptr; }
  /// Centre of the rim where the rope's end is held, own frame of `body` [m].
  [[nodiscard]] Vector3 end_center() const {
    if (groove == nullptr) return rim_center;
    return rim_center + groove->at(0.0).axial * rim_normal;
  }
  /// Puts the rope of a drum with a groove where it leaves at this angle [rad].
  void follow_groove(double angle) {
    const DrumGroove::Place place = groove->at(angle);
    center = rim_center + place.axial * rim_normal;
    centered = center.isZero(0.0);
    signed_radius = side * place.gain;
    axial_slope = place.slope;
  }
  void wind_groove(double angle) {
    wound = angle;
    follow_groove(angle);
  }
  /// Whether cable can pass the link from one span to the other other than by rolling.
  [[nodiscard]] bool passes() const { return massless || !std::isnan(friction); }
  /// Whether the passing cable slides along the link's arc.
  [[nodiscard]] bool slides_over() const { return wraps() && !massless && !std::isnan(friction); }
  [[nodiscard]] bool frictionless() const {
    return loss_exponent == 0.0 && blocked == 0 && (massless || friction == 0.0);
  }
  [[nodiscard]] bool rubs() const { return passes() && !frictionless(); }
  /// Length of cable once round the link [m]; 0 for a point.
  [[nodiscard]] double perimeter() const {
    return outline ? outline->curve.perimeter() : 2.0 * pi * std::abs(signed_radius);
  }
};

/// Whether both links are outlines of one body in one plane, or the same circle. No span can lie
/// between such links.
[[nodiscard]] bool on_one_outline(const LinkGeometry& a, const LinkGeometry& b);

}  // namespace sheave
