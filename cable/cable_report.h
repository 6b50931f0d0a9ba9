#pragma once
// Cables as a user or a renderer sees them, between two steps.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "engine/body_id.h"
#include "engine/vector.h"

namespace sheave {

/// One link of a cable.
struct LinkReport {
  std::string_view type;  ///< "attachment", "rolling", ...
  BodyId body;
  Vector3 center = Vector3::Zero();   ///< of the wheel, or the point itself [m]
  Vector3 normal = Vector3::UnitZ();  ///< of the link's plane
  double radius = 0.0;                ///< [m], 0 for a point
  bool touched = true;                ///< false: the cable has left the wheel and passes it by
  int winding = 0;                    ///< +1 counter-clockwise, -1 clockwise, 0 for a point
  /// Where the cable meets and leaves the body [m]. At the ends of an open cable, where one of the
  /// two does not exist, both are the one that does.
  Vector3 entry = Vector3::Zero();
  Vector3 exit = Vector3::Zero();
  /// Outlines: the cable's way along the body from entry to exit, corner by corner [m]. At the end
  /// of an open cable from the last point of the stored cable. Empty for circles and points.
  std::vector<Vector3> path;
  double stored_length = 0.0;  ///< cable on the body, of a material unstretched [m]
  /// By how much what is stored is longer as it lies there, with the strain that it came on with
  /// [m]; of a material.
  double stored_stretch = 0.0;
  double most_strain = 0.0;  ///< the largest strain with which any of it lies there
  /// Stored length, stretched, in turns of the link's perimeter, as an angle [rad]; any number of
  /// turns. Of a pinhole the angle by which the cable's direction changes there, 0 ... pi.
  double wrap_angle = 0.0;
  /// Cable that has slid over the link towards the next span since time 0 [m]; what rolled with a
  /// wheel is not counted.
  double slip = 0.0;
  /// Of a wheel with spin inertia that loses tension: the torque of its bearing on it about its axle
  /// in the last substep [N m]; the opposite acts on what holds the bearing.
  double bearing_torque = 0.0;
  /// The drive of the link's body, or the link's feed, stood still or slowed down in the last
  /// substep, for want of cable.
  bool stalled = false;
  double fed = 0.0;  ///< cable that an attachment with a feed speed has paid out since time 0 [m]
};

/// Something that changed the course of a cable.
struct CableEvent {
  enum class Kind {
    leave,   ///< the cable left a wheel
    touch,   ///< it touched it again
    attach,  ///< a hybrid end's cable was used up
    wind,    ///< and is wound up again
    cut,     ///< the cable was cut or broke, in the span that begins at the link
    /// The drive of the link's body, or the link's feed, needs more cable than there is and stops
    /// or slows down
    stall,
    /// Cable began to slide over a link on which it ought not to, because there is no more of it
    slip,
  };
  double time = 0.0;  ///< end of the substep [s]
  std::string cable;
  int link = 0;  ///< within the cable's list of links; -1: a wrap
  Kind kind = Kind::leave;
  std::string body{};  ///< that the link is on; empty: the world
};
inline constexpr std::array<std::string_view, 7> cable_event_names{
    "leave", "touch", "attach", "wind", "cut", "stall", "slip"};

/// One free span of a cable.
struct SpanReport {
  Vector3 start = Vector3::Zero();  ///< where it leaves its first link [m]
  Vector3 end = Vector3::Zero();    ///< where it meets its second link [m]
  double length = 0.0;              ///< [m]
  double rest_length = 0.0;         ///< [m]; greater than length: the span is slack
  double tension = 0.0;             ///< in the last substep [N], >= 0
  bool has_tangent = true;          ///< false: the wheels overlap so that no tangent exists
};

/// A wrap on a wrappable body that is no link of the cable's list.
struct WrapReport {
  int after = 0;    ///< the listed link behind which it lies; several behind one are in order
  LinkReport link;  ///< of type "wrap"
  SpanReport span;  ///< from here on
};

/// What is measured of one cable, without where it runs: a small part of its report.
struct CableGauge {
  double total_length = 0.0;  ///< as CableReport::total_length [m]
  double length_error = 0.0;  ///< as CableReport::length_error
  double max_stretch = 0.0;   ///< as CableReport::max_stretch
  double max_strain = 0.0;    ///< as CableReport::max_strain
  /// How much longer than allowed the spans of a rigid cable are, all together [m]. What is left of
  /// one that is cut hangs free.
  double excess = 0.0;
};

/// One cable.
struct CableReport {
  std::string_view name;
  bool closed = false;
  std::vector<LinkReport> links;  ///< as listed
  /// Span k begins at link k and ends at the next one that is touched (cyclic if closed), be it a
  /// link or a wrap.
  std::vector<SpanReport> spans;
  std::vector<WrapReport> wraps;  ///< in their order along the cable
  bool cut = false;
  /// Of a cut cable the lengths of its two pieces, from the first link and from the last [m].
  std::array<double, 2> pieces{};
  double total_length = 0.0;  ///< sum of rest lengths and stored lengths [m]
  /// (total_length - its value at time 0 - what was fed, or put in by placements) / that value, or
  /// total_length where that is 0; the length invariant.
  double length_error = 0.0;
  /// Energy lost since time 0 where cable of a material came off a wheel with another strain than
  /// its span's [J]: the creep of belts (cable/cable_material.cpp).
  double creep_loss = 0.0;
  /// Largest (length - rest length) / rest length of a rigid span; of one shorter than 1e-6 of the
  /// cable over that.
  double max_stretch = 0.0;
  /// The same of an elastic cable, whose spans may be longer than their rest lengths; 0 if none is.
  double max_strain = 0.0;

  /// The part of it that a gauge has.
  [[nodiscard]] CableGauge gauge() const;
  /// The same with the wraps among links and spans, each at its place, for those that follow the
  /// cable's whole way; `places` gets the place that each link has in this report, -1 for wraps.
  [[nodiscard]] CableReport with_wraps_in_place(std::vector<int>* places = nullptr) const;
};

}  // namespace sheave
