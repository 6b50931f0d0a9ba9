#pragma once
// Reports of cables between two steps, for users and renderers.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/body_id.h"
#include "engine/vector.h"

namespace sheave {

/// A smooth body on which a cable lies along a geodesic, or whose inside is an opening that a cable
/// passes: the points at one distance from a segment.
struct SurfaceReport {
  Vector3 center = Vector3::Zero();  ///< middle of the segment [m]
  Vector3 axis = Vector3::UnitZ();   ///< unit vector along it
  double half_length = 0.0;          ///< of the segment [m]; 0: a ball
  double radius = 0.0;               ///< [m]
  bool round_ends = true;            ///< half balls at the ends; false: the side of a cylinder
};

struct DrumGroove;

/// The rope on a drum with a groove.
struct GrooveReport {
  /// Place of the rope along the link's normal, from the centre of the drum [m].
  double axial_position = 0.0;
  /// Angle of the free rope to the plane of the drum [rad], > 0 towards the normal.
  double fleet_angle = 0.0;
  int layer = 0;             ///< 1: the innermost
  double drum_radius = 0.0;  ///< of the innermost layer [m]
  double wound = 0.0;        ///< angle of the rope in the groove [rad]
  /// The groove, for lines of the rope (cable/cable_polyline.h).
  std::shared_ptr<const DrumGroove> course;
};

/// One link of a cable.
struct LinkReport {
  std::string_view type;  ///< "attachment", "rolling", ...
  BodyId body;
  BodyId exit_body;  ///< the body at the exit: `body`, or the other one of a sheath between two
  Vector3 center = Vector3::Zero();   ///< of the wheel, or the point itself [m]
  Vector3 normal = Vector3::UnitZ();  ///< of the link's plane
  double radius = 0.0;                ///< [m], 0 for a point
  bool touched = true;                ///< false: the cable has left the wheel and does not touch it
  int winding = 0;                    ///< +1 counter-clockwise, -1 clockwise, 0 for a point
  /// Points where the cable meets and leaves the body [m]. At an end of an open cable one of the
  /// two does not exist; both members are then the other point.
  Vector3 entry = Vector3::Zero();
  Vector3 exit = Vector3::Zero();
  /// Smooth body in space: its surface; `center`, `normal` and `radius` are then those of a circle
  /// round the body near the cable. Opening: its surface; `center` is where the cable passes.
  std::optional<SurfaceReport> surface;
  /// Outlines: the polygon of the cable along the body from entry to exit, corner by corner [m]. At
  /// the end of an open cable it begins or ends at the end of the stored cable. Smooth bodies in
  /// space: points of the geodesic from entry to exit [m]. Sheaths: their curve; one between two
  /// bodies is drawn as a slack rope of its length. Empty for circles and points.
  std::vector<Vector3> path;
  double stored_length = 0.0;  ///< cable on the body, unstretched if the cable has a material [m]
  /// Stretch of the stored cable, due to the strain with which it came onto the link [m]. Only of a
  /// cable with a material, else 0.
  double stored_stretch = 0.0;
  double most_strain = 0.0;  ///< largest strain of any part of the stored cable
  /// Stretched stored length as an angle about the link [rad]: the turns of the perimeter that it
  /// covers times 2 pi, any number of turns. For a pinhole the angle between the directions of its
  /// two spans, 0 ... pi; for a smooth body in space the integral of the geodesic's curvature.
  double wrap_angle = 0.0;
  /// Length of cable that has slid over the link towards the next span since time 0 [m]. Cable that
  /// rolled with a wheel does not count.
  double slip = 0.0;
  /// Torque of the bearing on the wheel about its axle in the last substep [N m]. Only of a wheel
  /// with spin inertia and losses. The opposite torque acts on the body that holds
  /// the bearing.
  double bearing_torque = 0.0;
  /// Whether the drive of the link's body, or the link's feed, stopped or slowed down in the last
  /// substep because there was not enough cable.
  bool stalled = false;
  double fed = 0.0;  ///< length that an attachment with a feed speed has paid out since time 0 [m]
  /// Of a drum with a groove; `center` is then where the rope leaves, and `radius` the length per
  /// radian that it takes.
  std::optional<GrooveReport> groove;
};

/// A change of a cable's course.
struct CableEvent {
  enum class Kind {
    leave,   ///< the cable left a wheel
    touch,   ///< the cable touched a wheel that it had left
    attach,  ///< the stored length of a hybrid end was used up
    wind,    ///< the cable of a hybrid end is wound up again
    cut,     ///< the cable was cut or broke, in the span that begins at the link
    /// The drive of the link's body, or the link's feed, stops or slows down because it needs more
    /// cable than there is
    stall,
    /// Cable began to slide over a link that is defined without slip, because no cable was left
    /// there
    slip,
    full,  ///< the last layer of a drum is full, and a further one begins
  };
  double time = 0.0;  ///< end of the substep [s]
  std::string cable;
  int link = 0;  ///< index in the cable's list of links; -1: a wrap
  Kind kind = Kind::leave;
  std::string body{};  ///< name of the link's body; empty: the world
};
inline constexpr std::array<std::string_view, 8> cable_event_names{
    "leave", "touch", "attach", "wind", "cut", "stall", "slip", "full"};

/// Which tensions a report tells.
enum class SpanTensions {
  multipliers,  ///< of the rows: means over the last substep under `rattle`
  /// of the material, at the lengths and velocities of the state; of rigid cables, and of damped
  /// ones where the state does not determine them (cable/damped_tension.h), those of the rows
  material,
};

/// One free span of a cable.
struct SpanReport {
  Vector3 start = Vector3::Zero();  ///< tangent point on the span's first link [m]
  Vector3 end = Vector3::Zero();    ///< tangent point on the span's second link [m]
  double length = 0.0;              ///< distance of the ends [m]
  double rest_length = 0.0;         ///< [m]; greater than length: the span is slack, or it sags
  /// [N], >= 0. An elastic cable without damping has the tension of its material at these lengths,
  /// a damped one that of spring and damper at these lengths and velocities. A rigid cable has that
  /// of the last substep: at its end under `xpbd`, the mean over it under `rattle`; 0 at time 0. So
  /// has a damped cable where it passes a link or is fed, and one with an axial stiffness at wheels.
  double tension = 0.0;
  /// Forces of the span on the bodies of its links [N]. Of a rope without weight they are `tension`
  /// along the span. A rope with weight pulls its ends down as well, and its `tension` is the
  /// component of the mean of both along the chord.
  Vector3 start_force = Vector3::Zero();
  Vector3 end_force = Vector3::Zero();
  /// Strain that a rope with `unloading_stiffness` or `unloading_table` remembers
  /// (cable/rope_memory.h): of a rope that yields its permanent strain; 0 of others.
  double remembered = 0.0;
  double floored = 0.0;  ///< unstretched length that lies on the rope's floor [m]
  /// Where the rope comes onto its floor and where it leaves it; of a free rope above its floor the
  /// foot of its lowest point [m].
  std::array<Vector3, 2> touches{Vector3::Zero(), Vector3::Zero()};
  /// A place in the rope: the unstretched length from the start of the span [m], and the tension [N].
  struct Place {
    double length = 0.0;
    double tension = 0.0;
  };
  /// The tension of the rope on a floor with friction, from the anchor to the touch-down; it is linear
  /// between these places. Empty without friction. The force on the link at the anchor contains the
  /// friction, which the world bears with the anchor.
  std::vector<Place> laid{};
  bool hangs = false;       ///< the rope has weight, so the span is a catenary
  bool has_tangent = true;  ///< false: the wheels overlap and no tangent exists

  /// Tension in the rope at this share of the rest length from the start, 0 ... 1 [N]. The tension of
  /// a catenary is a vector that is linear in the unstretched length. With `axial_inertia` it is so
  /// up to the change of the acceleration along the span.
  [[nodiscard]] double tension_at(double share) const;
  /// Largest tension along the span, which is that at an end [N].
  [[nodiscard]] double largest_tension() const;
};

/// A wrap on a wrappable body that is no link of the cable's list.
struct WrapReport {
  /// the listed link behind which the wrap lies; several behind the same link are in order
  int after = 0;
  LinkReport link;  ///< of type "wrap"
  SpanReport span;  ///< the span that begins at the wrap
};

/// Measures of one cable without its geometry: a small part of its report.
struct CableGauge {
  double total_length = 0.0;  ///< as CableReport::total_length [m]
  double length_error = 0.0;  ///< as CableReport::length_error
  double max_stretch = 0.0;   ///< as CableReport::max_stretch
  double max_strain = 0.0;    ///< as CableReport::max_strain
  /// Sum of length - rest length over the spans of a rigid cable that are too long [m]. The free
  /// pieces of a cut cable do not count.
  double excess = 0.0;
};

/// One cable.
struct CableReport {
  std::string_view name;
  bool closed = false;
  std::vector<LinkReport> links;  ///< as listed
  /// Span k begins at link k and ends at the next link or wrap that the cable touches (cyclic if
  /// closed).
  std::vector<SpanReport> spans;
  std::vector<WrapReport> wraps;  ///< in their order along the cable
  bool cut = false;
  /// Lengths of the two pieces of a cut cable, from the first link and from the last [m].
  std::array<double, 2> pieces{};
  double total_length = 0.0;  ///< sum of rest lengths and stored lengths [m]
  /// Error of the length invariant: (total_length - its value at time 0 - length fed - length added
  /// by placements) / its value at time 0. The divisor is total_length if the value at time 0 is 0.
  double length_error = 0.0;
  /// Energy lost since time 0 where cable of a material came off a wheel with another strain than
  /// that of its span [J]: the creep of belts (cable/cable_material.cpp).
  double creep_loss = 0.0;
  /// Energy lost since time 0 by friction in sheaths [J] (cable/sheath_profile.h). While the fronts
  /// from both ends of a sheath meet, or the whole rope slides, of second order in the step.
  double sheath_loss = 0.0;
  /// Energy lost since time 0 by the law of a rope with `unloading_stiffness` or `unloading_table`
  /// [J], >= 0: between its loading and its unloading.
  double hysteresis_loss = 0.0;
  /// Energy lost since time 0 by friction on a floor [J] (cable/floor_profile.h), >= 0. Of second order
  /// in the step; of first where rope is laid while it slides.
  double floor_loss = 0.0;
  /// Length that a rope with `unloading_stiffness` has gained by yielding [m], >= 0: the sum of rest
  /// length times permanent strain. Rest lengths stay those of the rope at time 0.
  double permanent_stretch = 0.0;
  /// Largest (length - rest length) / rest length of a rigid span. For a span shorter than 1e-6 of
  /// the cable the divisor is 1e-6 of the cable.
  double max_stretch = 0.0;
  /// The same of an elastic cable, whose spans may be longer than their rest lengths; 0 if none is
  /// longer.
  double max_strain = 0.0;

  /// Largest tension along all spans, those that begin at wraps too [N].
  [[nodiscard]] double largest_tension() const;
  /// The measures of this report that a gauge has.
  [[nodiscard]] CableGauge gauge() const;
  /// The same report with each wrap inserted among links and spans at its place, for callers that
  /// follow the cable's whole course. `places` gets the index that each link has in this report, -1
  /// for wraps.
  [[nodiscard]] CableReport with_wraps_in_place(std::vector<int>* places = nullptr) const;
};

struct Simulation;

/// Reports in memory that is kept, for programs that read cables in every frame. Once a state has
/// been read, reading later states of the same world allocates no memory, unless the number of
/// wraps grows or a cable lies on smooth bodies.
class CableReports {
 public:
  CableReports();
  ~CableReports();
  CableReports(CableReports&&) noexcept;
  CableReports& operator=(CableReports&&) noexcept;

  /// Reads the present state. Call it again after an edit, a placement or a restored state.
  void read(const Simulation& simulation);
  /// One report per cable, in the order of their definitions; none before read(). The names in them
  /// are those of the simulation, which must exist as long as names are used.
  [[nodiscard]] std::span<const CableReport> all() const { return reports_; }

 private:
  struct Room;
  std::unique_ptr<Room> room_;
  std::vector<CableReport> reports_;
};

}  // namespace sheave
