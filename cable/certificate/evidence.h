#pragma once
// What is known of a substep: the states at both ends and what was reported of it. All balances
// read from here.
//
// Forces of `rattle` act in two halves, along the directions at the start and at the end
// (engine/world.h), so reports are taken twice: with the first part of each force where the bodies
// were at the start, and with the second where they are at the end. `xpbd` has the second part
// alone.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "cable/cable_report.h"
#include "cable/certificate/findings.h"
#include "cable/simulation.h"
#include "engine/index.h"
#include "engine/joint_report.h"
#include "engine/joints/joint_hold.h"

namespace sheave::certify {

/// The ends of a substep.
enum End : int { first_end, last_end };

/// Poses at one moment. Points of bodies are in their own frames (origin at the centre of mass);
/// the world has number bodies.count().
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
  /// Of the body's material at a world point.
  [[nodiscard]] Vector3 velocity(int body, const Vector3& world) const {
    if (is_world(body)) return Vector3::Zero();
    const BodyState& state = (*states)[at(body)];
    return state.velocity + state.angular_velocity.cross(world - state.position);
  }
};

/// One end of a span.
struct SpanSide {
  int body = 0;
  int link = -1;                   ///< within the cable's way, wraps included
  int place = -1;                  ///< within the cable's list; -1: a wrap
  std::array<double, 2> radius{};  ///< at either end of the substep [m]: drums grow by layers
  int winding = 0;
  bool outlined = false;
  bool slides = false;            ///< PassEvidence::stretches: it does not roll there
  std::array<Vector3, 2> point;   ///< at either end of the substep [m]: where its force acts
  Vector3 laid;                   ///< at its end, where what is frozen has been laid anew [m]
  std::array<Vector3, 2> center;  ///< of its circle [m]
  std::array<Vector3, 2> normal;
};

/// A free span through a substep.
struct SpanEvidence {
  std::string_view cable;
  int place = -1;  ///< within its cable's list; -1: behind a wrap
  SpanSide from;
  SpanSide to;
  std::array<Vector3, 2> direction;
  std::array<double, 2> length{};
  std::array<double, 2> rest_length{};
  std::array<double, 2> force{};  ///< the parts of the tension [N]
  double fed = 0.0;               ///< into it in the substep [m]
  bool has_tangent = true;
  [[nodiscard]] double tension() const { return force[0] + force[1]; }
  [[nodiscard]] std::string name() const;
};

/// Where the cable passes from one span to the next.
struct PassEvidence {
  int before = 0;  ///< spans, among all
  int after = 0;
  bool passes = false;                 ///< whether cable can come over it other than by rolling
  bool massless = false;               ///< because nothing resists its turning
  double friction = 0.0;               ///< capstan coefficient, if it passes
  std::array<double, 2> wrap_angle{};  ///< [rad], at the ends of the substep
  double slip = 0.0;                   ///< in the substep, towards the next span [m]
  /// What friction has worked against: the way of the cable over what rubs it, towards the next
  /// span [m]. That is the slip, or where a bearing brakes a wheel the way of its rim over the
  /// carrier.
  double travel = 0.0;
  /// Whether cable of a material slides over an arc, and is stretched there: at the end so much of
  /// it lies on the link, and it has gained so much [m, unstretched].
  bool stretches = false;
  bool has_arc = false;  ///< it is a wheel or a post, and none that cable turns
  LinkReport laid;
  double gained = 0.0;
  /// What has left the span before, and come into the one behind [m].
  [[nodiscard]] double left() const { return slip + 0.5 * gained; }
  [[nodiscard]] double came() const { return slip - 0.5 * gained; }
  int link = 0;  ///< within the list; -1: a wrap
  std::string_view cable;
};

/// The bearing of a wheel with inertia that brakes it.
struct BearingEvidence {
  std::string_view cable;
  int link = 0;  ///< within the cable's list
  int rotor = 0;
  double arm = 0.0;                 ///< most torque per sum of the tensions beside the wheel [m]
  std::array<double, 2> torque{};   ///< on the wheel, about its axle [N m]
  std::array<double, 2> pressed{};  ///< sum of the tensions beside it [N]
  double turn = 0.0;                ///< of the wheel on what carries it, in the substep [rad]
  double rate = 0.0;                ///< and how fast it turns there at the end [rad/s]
};

struct CableEvidence {
  std::string_view name;
  /// With what has been set instead; but for friction and feeds of its links.
  const CableDef* definition = nullptr;
  int first_link = 0;  ///< among those of all cables
  std::vector<SpanEvidence> spans;
  std::vector<PassEvidence> passes;
  bool has_changed =
      false;  ///< its course or an end: what acted is not what is reported at the end
  bool was_changed = false;  ///< at the end of the substep before: spans may begin too long
  /// Attachments keep their places on the bodies: it is asked for, and no span ends on an outline
  /// or leans to a wheel's plane.
  bool frozen = false;
  double free_length = 0.0;  ///< of all spans [m]
  CableReport start;
  CableReport end;
};

struct JointEvidence {
  const JointDef* definition = nullptr;
  int first_coordinate = 0;           ///< among those of all joints
  std::array<JointReport, 2> acting;  ///< with the parts of the forces
  JointReport start;
  JointReport end;
  bool broken = false;  ///< before the substep
  JointHold hold;       ///< of one that has been locked again
};

/// A force at a point of contact, of bodies with each other or with the floor (body_b is the
/// world).
struct ContactEvidence {
  int body_a = 0;
  int body_b = 0;
  bool ground = false;
  Vector3 normal = Vector3::UnitY();
  std::array<Vector3, 2> point_a;  ///< on the surfaces
  std::array<Vector3, 2> point_b;
  std::array<double, 2> press{};
  std::array<Vector3, 2> drag;
  Vector3 slip = Vector3::Zero();  ///< way of A's surface over B's, and along the normal [m]
  std::array<double, 2> gap{};
  bool sticks = false;
  const ColliderDef* collider_a = nullptr;
  const ColliderDef* collider_b = nullptr;
};

/// The drive of a mounted rotor.
struct MountedDriveEvidence {
  int rotor = 0;
  std::array<double, 2> torque{};  ///< on it, about the axle [N m]
};

/// What acts on a body besides its loads.
struct Balance {
  std::array<Vector3, 2> force{Vector3::Zero(), Vector3::Zero()};
  /// About the centre of mass; of a carrier without what spins its rotors, of a mounted rotor only
  /// that, along its axle.
  std::array<Vector3, 2> torque{Vector3::Zero(), Vector3::Zero()};
  /// What acts on the body itself, its torque about the centre: of a mounted rotor before the
  /// bearing passes it on.
  std::array<Vector3, 2> own_force{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> own_torque{Vector3::Zero(), Vector3::Zero()};
  double largest_force = 0.0;
  double largest_torque = 0.0;
  double power = 0.0;    ///< sum of all |force . velocity| [W]
  bool unknown = false;  ///< something acts that is not reported in full
};

class Evidence {
 public:
  explicit Evidence(const Simulation& observed, const LastSubstep& last);

  const Simulation& simulation;
  const Model& model;
  const BodySet& bodies;
  const State& start;
  const State& end;
  /// That the substep was made with: what has been set, or the model's [m/s2].
  Vector3 gravity;
  double h;
  bool rattle;
  std::array<Moment, 2> moments;
  std::vector<CableEvidence> cables;
  std::vector<JointEvidence> joints;
  std::vector<ContactEvidence> contacts;
  std::vector<MountedDriveEvidence> mounted_drives;
  std::vector<BearingEvidence> bearings;
  std::vector<Balance> balances;  ///< per body and the world
  double largest_force = 0.0;     ///< of all [N]
  /// What no force is told apart from nothing by: the rounding of positions, as a force that moves
  /// all bodies by it within the substep [N].
  double force_rounding = 0.0;
  /// The same of a tension that spans share which depend on each other [N].
  double shared_rounding = 0.0;

  /// Radius of the ball about the centre of mass that contains the body, or that of gyration
  /// without a shape [m].
  [[nodiscard]] double size_of(int body) const;
  /// What acts on a body by itself, without its rotors: constant, or set. The torque is about its
  /// centre of mass.
  [[nodiscard]] Vector3 load_force(int body, End when) const;
  [[nodiscard]] Vector3 load_torque(int body, End when) const;
  /// How far the body has turned in the substep [rad], as the integrator counts it: a rotation
  /// vector (cable/certificate/free_rotation.h).
  [[nodiscard]] Vector3 turn_of(int body) const;
  /// Whether it is a wheel without inertia whose bearing takes a part of its cable's tension: it
  /// turns as far as cable has passed, no further.
  [[nodiscard]] bool brakes(int body) const;
  [[nodiscard]] std::string body_name(int body) const {
    return "body \"" + bodies.name(body) + "\"";
  }
  /// Work of the gradient of a pair of forces: force . displacement of the material at `point`,
  /// which is of that end.
  [[nodiscard]] Vector3 displacement(int body, const Vector3& point, End end) const;

 private:
  void find_brakes();
  void collect_cables(const LastSubstep& last);
  void collect_cable(CableEvidence& cable, const CableReport& first, const CableReport& second);
  void collect_passes(CableEvidence& cable, const CableReport& first, const CableReport& second,
                      const std::vector<int>& places);
  void collect_joints(const LastSubstep& last);
  void collect_mounted_drives(const LastSubstep& last, std::size_t feature);
  void collect_ground(const LastSubstep& last, std::size_t feature);
  void collect_contacts(const LastSubstep& last, std::size_t feature);
  /// Forces of cables that keep their attachments for the substep act between these.
  void freeze(SpanEvidence& span) const;
  void apply_cables();
  void apply_joints();
  void apply_mounted_drives();
  void collect_bearing(const CableEvidence& cable, const PassEvidence& pass,
                       const std::array<const LinkReport*, 2>& link);
  void apply_bearings();
  void apply_contacts();
  void push(End when, int body, const Vector3& point, const Vector3& force);
  void twist(End when, int body, const Vector3& torque);
  void mark_unknown(int body);
  [[nodiscard]] double rounding_of_forces() const;
  /// Makes the definitions of cables what has been set.
  void follow_controls();

  std::vector<Vector3> turns_;  ///< per body
  std::vector<char> brakes_;    ///< per body
  std::vector<CableDef>
      controlled_;  ///< definitions of cables with what has been set; empty if nothing is
};

/// Two parts of each of `total`, by what was late.
[[nodiscard]] std::array<std::vector<double>, 2> parts(std::span<const double> total, bool rattle,
                                                       std::span<const double> late);

}  // namespace sheave::certify
