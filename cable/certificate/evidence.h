#pragma once
// Evidence of one substep: the states at both ends and all reported quantities. All checks read
// from here.
//
// Forces of `rattle` act in two halves, along the directions at the start and at the end
// (engine/world.h). Reports are therefore taken twice: with the first part of each force at the
// starting poses, and with the second part at the final poses. `xpbd` has only the second part.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "cable/cable_report.h"
#include "cable/certificate/findings.h"
#include "cable/certificate/grooves.h"
#include "cable/simulation.h"
#include "engine/index.h"
#include "engine/joint_report.h"
#include "engine/joints/joint_hold.h"

namespace sheave::certify {

/// The ends of a substep.
enum End : int { first_end, last_end };

/// Poses at one moment. Points of bodies are in their own frames (origin at the centre of mass);
/// the number of the world is bodies.count().
struct Moment {
  const BodySet* bodies = nullptr;
  const std::vector<BodyState>* states = nullptr;

  [[nodiscard]] bool is_world(int body) const { return body == bodies->count(); }
  [[nodiscard]] Vector3 center(int body) const {
    return is_world(body) ? Vector3(Vector3::Zero()) : (*states)[at(body)].position;
  }
  [[nodiscard]] Quaternion orientation(int body) const {
    return is_world(body) ? Quaternion(Quaternion::Identity()) : (*states)[at(body)].orientation;
  }
  [[nodiscard]] Vector3 point(int body, const Vector3& own) const {
    return center(body) + orientation(body) * own;
  }
  [[nodiscard]] Vector3 own_point(int body, const Vector3& world) const {
    return orientation(body).conjugate() * (world - center(body));
  }
  /// Velocity of the body's material at a world point.
  [[nodiscard]] Vector3 velocity(int body, const Vector3& world) const {
    if (is_world(body)) return Vector3::Zero();
    const BodyState& state = (*states)[at(body)];
    return state.velocity + state.angular_velocity.cross(world - state.position);
  }
};

struct LaidEvidence;  // cable/certificate/hanging.h

/// One end of a span.
struct SpanSide {
  int body = 0;
  int link = -1;                   ///< index along the cable's course, wraps included
  int place = -1;                  ///< index in the cable's list; -1: a wrap
  std::array<double, 2> radius{};  ///< at both ends of the substep [m]; drums grow by layers
  int winding = 0;
  bool outlined = false;
  bool slides = false;            ///< PassEvidence::stretches: the cable does not roll there
  double unsure = 0.0;            ///< if it slides: PassEvidence::unsure [m]
  std::array<Vector3, 2> point;   ///< point of action of its force at both ends of the substep [m]
  Vector3 laid;                   ///< at the end, after frozen attachments were computed again [m]
  std::array<Vector3, 2> center;  ///< centre of its circle [m]
  std::array<Vector3, 2> normal;
  // Rope with weight on a wheel, at both ends of the substep.
  std::array<double, 2> stored{};  ///< unstretched length on the wheel [m]
  std::array<double, 2> lies{};    ///< arc that it covers [m]
  /// Strain with which rope comes onto the wheel in the substep.
  double strain = 0.0;
  /// Tension at the wheel less the chord tension, in the mean over the substep [N].
  double above = 0.0;
  std::shared_ptr<const GrooveLaw> groove;  ///< null: no drum with a groove
  std::array<double, 2> wound{};            ///< angle of the rope in its groove [rad]
};

/// A free span during a substep.
struct SpanEvidence {
  std::string_view cable;
  int place = -1;  ///< index in its cable's list; -1: behind a wrap
  SpanSide from;
  SpanSide to;
  std::array<Vector3, 2> direction;
  std::array<double, 2> length{};
  std::array<double, 2> rest_length{};
  std::array<double, 2> force{};  ///< the two parts of the tension [N]
  double told = 0.0;              ///< tension as reported [N]
  /// Whether it has weight and shares its rope with other spans, so that `force` follows from theirs.
  bool shares = false;
  /// Strain that a rope with memory remembers, at both ends of the substep.
  std::array<double, 2> remembered{};
  double fed = 0.0;                          ///< length fed into it in the substep [m]
  std::shared_ptr<const LaidEvidence> laid;  ///< null: no friction of a floor holds its rope
  /// Rope with weight: its forces on its ends besides the tension along the chord, in the two parts
  /// of the substep [N].
  std::array<Vector3, 2> load_from{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> load_to{Vector3::Zero(), Vector3::Zero()};
  /// The points at which these forces act [m].
  std::array<Vector3, 2> loaded_from{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> loaded_to{Vector3::Zero(), Vector3::Zero()};
  /// Forces of the inertia of its rope, in the two parts of the substep [N]: half of the first one
  /// acts on each end, and the second one acts backwards on the start and forwards on the end.
  std::array<Vector3, 2> inertia_mean{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> inertia_difference{Vector3::Zero(), Vector3::Zero()};
  bool has_tangent = true;
  [[nodiscard]] double tension() const { return force[0] + force[1]; }
  [[nodiscard]] std::string name() const;
};

/// A link between two spans of the cable's course.
struct PassEvidence {
  int before = 0;  ///< indices of the spans, among all
  int after = 0;
  bool passes = false;    ///< whether cable can pass other than by rolling
  bool massless = false;  ///< whether it passes because the wheel has no inertia
  double friction = 0.0;  ///< capstan coefficient, if cable passes
  int blocked = 0;  ///< way in which no cable slides: +1 towards the next span, -1 back, 0 none
  std::array<double, 2> wrap_angle{};  ///< [rad], at both ends of the substep
  double slip = 0.0;                   ///< slip in the substep, towards the next span [m]
  /// Path along which friction does work: travel of the cable over the rubbing surface, towards the
  /// next span [m]. The travel is the slip, stretched if the cable has a material, or for a braking
  /// bearing the travel of the wheel's rim relative to the carrier.
  double travel = 0.0;
  /// Whether cable with a material slides over an arc and is stretched there. `laid` is then the
  /// link at the end, `gained` the unstretched length that it has gained, and `start_strain` the
  /// mean strain at the start.
  bool stretches = false;
  bool has_arc = false;  ///< the link is a wheel or a post that cable does not turn
  LinkReport laid;
  double gained = 0.0;
  double start_strain = 0.0;
  /// Unstretched length that cable without slip would have passed on, from the poses [m], and the
  /// range in which it lies, because the strain on the arc is known at its ends only.
  double carried = 0.0;
  double unsure = 0.0;
  /// Length that has left the span before, and length that has come into the span behind [m].
  [[nodiscard]] double left() const { return slip + carried + 0.5 * gained; }
  [[nodiscard]] double came() const { return slip + carried - 0.5 * gained; }
  int link = 0;  ///< index in the list; -1: a wrap
  std::string_view cable;
};

/// A bearing that brakes a wheel with inertia.
struct BearingEvidence {
  std::string_view cable;
  int link = 0;  ///< index in the cable's list
  int rotor = 0;
  double size = 0.0;               ///< the largest arm of its friction [m]
  std::array<double, 2> torque{};  ///< on the wheel, about its axle [N m]
  std::array<double, 2> bound{};   ///< largest torque by the tensions [N m]
  double turn = 0.0;  ///< rotation of the wheel relative to its carrier in the substep [rad]
  double rate = 0.0;  ///< rate of that rotation at the end [rad/s]
};

/// The rope on a wheel, of a rope with inertia.
struct WheelRopeEvidence {
  int body = 0;
  int link = 0;                    ///< index in the cable's list
  double radius = 0.0;             ///< [m]
  double mass = 0.0;               ///< of the rope on it, mean over the substep [kg]
  double last_mass = 0.0;          ///< the same at the end [kg]
  std::array<Vector3, 2> center;   ///< of the wheel, at both ends of the substep [m]
  std::array<Vector3, 2> arm;      ///< from there to the rope's centre of mass [m]
  std::array<Vector3, 2> axle;     ///< unit vector
  std::array<Vector3, 2> force;    ///< of its inertia at that centre, in the two parts [N]
  std::array<double, 2> torque{};  ///< about the axle [N m]
};

struct CableEvidence {
  std::string_view name;
  /// With the values set by controls, except the friction and feeds of its links.
  const CableDef* definition = nullptr;
  int first_link = 0;  ///< index among the links of all cables
  std::vector<SpanEvidence> spans;
  std::vector<PassEvidence> passes;
  std::vector<WheelRopeEvidence> wheels;  ///< of a rope with inertia
  /// its course or an end has changed, so the links at the end are not those on which the forces
  /// acted
  bool has_changed = false;
  /// its course had changed in the substep before, so spans may begin too long
  bool was_changed = false;
  /// Contacts keep their places on the bodies: `tangent_update` asks for it, and no span ends on an
  /// outline or leans out of a wheel's plane.
  bool frozen = false;
  double free_length = 0.0;  ///< sum of the lengths of all spans [m]
  CableReport start;
  CableReport end;
};

struct JointEvidence {
  const JointDef* definition = nullptr;
  int first_coordinate = 0;           ///< index among the coordinates of all joints
  std::array<JointReport, 2> acting;  ///< at both ends, with the parts of the forces
  JointReport start;
  JointReport end;
  bool broken = false;  ///< broken before the substep
  JointHold hold;       ///< of a joint that has been locked again
};

/// A contact force between two bodies, or between a body and the floor (body_b is the world).
struct ContactEvidence {
  int body_a = 0;
  int body_b = 0;
  bool ground = false;
  Vector3 normal = Vector3::UnitY();
  std::array<Vector3, 2> point_a;  ///< on the two surfaces
  std::array<Vector3, 2> point_b;
  std::array<double, 2> press{};
  std::array<Vector3, 2> drag;
  /// travel of A's surface relative to B's, with its component along the normal [m]
  Vector3 slip = Vector3::Zero();
  std::array<double, 2> gap{};
  bool sticks = false;
  const ColliderDef* collider_a = nullptr;
  const ColliderDef* collider_b = nullptr;
};

/// The drive of a mounted rotor.
struct MountedDriveEvidence {
  int rotor = 0;
  std::array<double, 2> torque{};  ///< on the rotor, about the axle [N m]
};

/// Forces and torques on a body other than its loads.
struct Balance {
  std::array<Vector3, 2> force{Vector3::Zero(), Vector3::Zero()};
  /// About the centre of mass. For a carrier without the torques that spin its rotors; for a
  /// mounted rotor only these, along its axle.
  std::array<Vector3, 2> torque{Vector3::Zero(), Vector3::Zero()};
  /// Forces on the body itself, torque about its centre. For a mounted rotor before the bearing
  /// passes them on.
  std::array<Vector3, 2> own_force{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> own_torque{Vector3::Zero(), Vector3::Zero()};
  double largest_force = 0.0;
  double largest_torque = 0.0;
  double power = 0.0;    ///< sum of all |force . velocity| [W]
  bool unknown = false;  ///< a force acts that is not reported in full
};

class Evidence {
 public:
  explicit Evidence(const Simulation& observed, const LastSubstep& last);

  const Simulation& simulation;
  const Model& model;
  const BodySet& bodies;
  const State& start;
  const State& end;
  /// Gravity during the substep: the value set by a control, or the model's [m/s2].
  Vector3 gravity;
  double h;
  bool rattle;
  std::array<Moment, 2> moments;
  std::vector<CableEvidence> cables;
  std::vector<JointEvidence> joints;
  std::vector<ContactEvidence> contacts;
  std::vector<MountedDriveEvidence> mounted_drives;
  std::vector<BearingEvidence> bearings;
  std::vector<Balance> balances;  ///< per body, then the world
  double largest_force = 0.0;     ///< largest force on any body [N]
  /// Force that moves all bodies by the rounding error of their positions within the substep [N].
  /// Smaller forces are indistinguishable from zero.
  double force_rounding = 0.0;
  /// The same for a tension shared by rigid spans that depend on each other [N].
  double shared_rounding = 0.0;

  /// Radius about the centre of mass of a ball that contains the body [m]; without a shape its
  /// radius of gyration.
  [[nodiscard]] double size_of(int body) const;
  /// Load of a body itself, without its rotors: constant, or set by a control. Torque about its
  /// centre of mass.
  [[nodiscard]] Vector3 load_force(int body, End when) const;
  [[nodiscard]] Vector3 load_torque(int body, End when) const;
  /// Rotation of the body in the substep as the integrator counts it: a rotation vector [rad]
  /// (cable/certificate/free_rotation.h).
  [[nodiscard]] Vector3 turn_of(int body) const;
  /// Whether it is a wheel without inertia whose bearing takes a part of the cable's tension. Such
  /// a wheel turns exactly as far as cable has passed.
  [[nodiscard]] bool brakes(int body) const;
  [[nodiscard]] std::string body_name(int body) const {
    return "body \"" + bodies.name(body) + "\"";
  }
  /// Displacement of the material at `point` in the substep, whose product with a force is the
  /// force's work. `point` is given at the end `end`.
  [[nodiscard]] Vector3 displacement(int body, const Vector3& point, End end) const;

 private:
  void find_brakes();
  void collect_cables(const LastSubstep& last);
  void collect_cable(CableEvidence& cable, const CableReport& first, const CableReport& second);
  void collect_passes(CableEvidence& cable, const CableReport& first, const CableReport& second,
                      const std::vector<int>& places);
  /// Forces of the inertia of ropes: rope_motion.cpp.
  void collect_rope_inertia(const LastSubstep& last, std::size_t feature);
  void apply_rope_inertia();
  void collect_joints(const LastSubstep& last);
  void collect_mounted_drives(const LastSubstep& last, std::size_t feature);
  void collect_ground(const LastSubstep& last, std::size_t feature);
  void collect_contacts(const LastSubstep& last, std::size_t feature);
  /// Moves the points of action of a frozen span to the places that its attachments keep.
  void freeze(SpanEvidence& span) const;
  void apply_cables();
  void apply_joints();
  void apply_mounted_drives();
  void collect_bearing(const CableEvidence& cable, const PassEvidence& pass,
                       const std::array<const LinkReport*, 2>& link);
  void apply_bearings();
  void apply_contacts();
  /// A force of the half `when` of the substep, at the body's pose of `place`.
  void push(End when, End place, int body, const Vector3& point, const Vector3& force);
  void twist(End when, int body, const Vector3& torque);
  void mark_unknown(int body);
  [[nodiscard]] double rounding_of_forces() const;
  /// Applies the values set by controls to the definitions of cables.
  void follow_controls();

  std::vector<Vector3> turns_;  ///< per body
  std::vector<char> brakes_;    ///< per body
  std::vector<CableDef>
      controlled_;  ///< definitions of cables with values set by controls; empty if none is set
};

/// Splits each entry of `total` into two parts; `late` is the second part.
[[nodiscard]] std::array<std::vector<double>, 2> parts(std::span<const double> total, bool rattle,
                                                       std::span<const double> late);

}  // namespace sheave::certify
