#pragma once
// A world for interactive programs: step it, read it and set its controls while it runs.
//
//   auto world = sheave::load("crane.json");  // or LiveWorld::create(model, cables)
//   if (!world) report(world.errors());
//   const auto drum = *world->body("drum");
//   const auto rope = *world->cable("rope");
//   while (running) {
//     if (auto errors = world->set_speed(drum, lever()); !errors.empty()) report(errors);
//     if (!world->step().ok()) break;
//     show(*world->tension(rope, 2));
//   }
//
// Handles identify bodies, joints and cables. Errors are values: an error gives the reason and the
// allowed values, and a call that returns an error has changed nothing. Readers return
// the state between two steps. No reader allocates or searches, except energy() and length().

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable_polyline.h"
#include "cable/edit.h"
#include "cable/handle.h"
#include "cable/run_check.h"
#include "cable/simulation.h"
#include "cable/step_warnings.h"
#include "engine/wrench.h"

namespace sheave {

/// Pose and velocity of a body's frame.
struct BodyPose {
  Vector3 position = Vector3::Zero();               ///< of its origin [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
  Vector3 velocity = Vector3::Zero();               ///< of its origin [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]
};

/// The property of the cables that LiveWorld::place() keeps.
enum class Keep {
  /// Rest lengths stay. Spans become slack, or taut if the cable is elastic. A rigid cable must be
  /// long enough for the new place.
  length,
  tension,  ///< tensions and slack stay: the rest lengths change by the amount that the spans need
};

/// Result of LiveWorld::place().
struct Placement {
  struct Cable {
    CableHandle cable;
    double added = 0.0;  ///< change of the cable's length [m]; < 0: cable was taken out
  };
  double energy = 0.0;        ///< change of the world's energy [J]
  std::vector<Cable> cables;  ///< the cables whose lengths have changed
};

/// Report of one step of a LiveWorld.
struct LiveReport : StepReport {
  /// Largest number of events in one report.
  static constexpr std::size_t most_events = 64;
  std::vector<CableEvent> events;          ///< of cables, in their order
  std::vector<JointHandle> broken_joints;  ///< in this step
  std::size_t omitted = 0;                 ///< number of events beyond the first `most_events`
  /// Requests that the step could not meet. Warnings of solver and integrator are those of this
  /// step. A warning of a cable appears when its fault occurs for the first time; those of its
  /// start (cable/start_warnings.h) are in the report of the first step. `sheave run` prints the
  /// same warnings.
  std::vector<Warning> warnings;
};

struct LiveRevision;

/// A state of a LiveWorld together with the model and cables that the state belongs to. Restoring a
/// snapshot goes back across edits.
class LiveSnapshot {
 public:
  [[nodiscard]] const State& state() const { return state_; }

 private:
  friend class LiveWorld;
  LiveSnapshot(State state, std::shared_ptr<LiveRevision> revision,
               std::shared_ptr<const int> identity)
      : state_(std::move(state)), revision_(std::move(revision)), identity_(std::move(identity)) {}
  State state_;
  std::shared_ptr<LiveRevision> revision_;
  std::shared_ptr<const int> identity_;
};

class LiveWorld {
 public:
  static Result<LiveWorld> create(const Model& model, const std::vector<CableDef>& cables);
  /// Takes over an existing simulation, with its supervisor if it has one. The report of its first
  /// step begins with the warnings `at_start` (scenes/start_warnings.h).
  static LiveWorld of(Simulation simulation, std::vector<Warning> at_start = {}) {
    return LiveWorld(std::move(simulation), std::move(at_start));
  }
  ~LiveWorld();
  LiveWorld(LiveWorld&&) noexcept;
  LiveWorld& operator=(LiveWorld&&) noexcept;

  // Handles by name. The error lists similar names.
  [[nodiscard]] Result<BodyHandle> body(std::string_view name) const;
  [[nodiscard]] Result<JointHandle> joint(std::string_view name) const;
  [[nodiscard]] Result<CableHandle> cable(std::string_view name) const;
  // Handles by index in the model's list of bodies or joints, or in the list of cables. The index
  // must be in range.
  [[nodiscard]] BodyHandle body_at(int index) const;
  [[nodiscard]] JointHandle joint_at(int index) const;
  [[nodiscard]] CableHandle cable_at(int index) const;

  /// The joint's definition; null if the handle refers to nothing.
  [[nodiscard]] const JointDef* definition(JointHandle joint) const;
  // All handles of one kind, in the order of their slots.
  [[nodiscard]] std::vector<BodyHandle> bodies() const;
  [[nodiscard]] std::vector<JointHandle> joints() const;
  [[nodiscard]] std::vector<CableHandle> cables() const;

  /// Does a Simulation::step() and reports its events. `before_substep` is called after controllers
  /// and triggers and may set controls. A call from within a step or an edit does no step; its
  /// report says that the step was stopped.
  [[nodiscard]] LiveReport step(const StopRequest& stop = {},
                                const std::function<void()>& before_substep = {});

  /// Checks all further steps as `sheave run` does (cable/run_check.h). Restoring, placing and
  /// editing begin a new balance of energy.
  void check_run();
  /// The certificate of all steps since check_run(); empty if check_run() was not called.
  [[nodiscard]] Certificate run_certificate() const;

  // Readers.
  [[nodiscard]] double time() const { return state().time; }
  [[nodiscard]] Result<std::string> name(BodyHandle body) const;
  [[nodiscard]] Result<std::string> name(JointHandle joint) const;
  [[nodiscard]] Result<std::string> name(CableHandle cable) const;
  [[nodiscard]] Result<BodyPose> pose(BodyHandle body) const;
  /// World position of the body-frame point `local` [m].
  [[nodiscard]] Result<Vector3> point(BodyHandle body, const Vector3& local) const;
  /// Mean tension over the last substep [N], >= 0; SpanReport::tension is that of the instant for an
  /// elastic cable. `span` is an index in the cable's list; the tension is 0 where the cable passes
  /// its first link without touching it.
  [[nodiscard]] Result<double> tension(CableHandle cable, int span) const;
  /// Unstretched length of a span, and unstretched length that a listed link stores [m].
  [[nodiscard]] Result<double> rest_length(CableHandle cable, int span) const;
  [[nodiscard]] Result<double> stored_length(CableHandle cable, int link) const;
  /// Whether a part of the cable lies between two links. A cable of which this is false lies or
  /// hangs loose. A cable that has parted keeps its links, so ask is_cut() too. Both are false if
  /// the handle refers to nothing.
  [[nodiscard]] bool pulls(CableHandle cable) const;
  /// Whether the cable has parted and has no tension any more.
  [[nodiscard]] bool is_cut(CableHandle cable) const;
  /// Total length, loose ends included [m]. For a cable without loose ends this is
  /// CableReport::total_length. Allocates.
  [[nodiscard]] Result<double> length(CableHandle cable) const;
  /// Length beyond the link that holds a loose end [m]; nothing if the end is not loose.
  [[nodiscard]] Result<std::optional<double>> loose_length(CableHandle cable, CableEnd end) const;
  /// The line along which to draw the part of a cable that belongs to a listed span, or a piece of a
  /// cut cable (cable/cable_polyline.h). `cables` must have read the present state of this world.
  /// Returns the number of points of the line; `points` gets as many as it has room for.
  [[nodiscard]] Result<std::size_t> cable_polyline(CableHandle cable, int span,
                                                   const CableReports& cables,
                                                   const PolylineOptions& options,
                                                   std::span<Vector3> points) const;
  /// The wrench of the joint on its body_b in the last substep, as in JointReport.
  [[nodiscard]] Result<Wrench> force(JointHandle joint) const;
  /// Energy of the whole world. The cost is proportional to the number of bodies, joints and
  /// cables.
  [[nodiscard]] Energy energy() const { return simulation().world.energy(); }

  // Controls, as World and Simulation have them (engine/world.h, cable/simulation.h).
  [[nodiscard]] Errors set_gravity(const Vector3& gravity);
  void clear_gravity();
  /// Drive of a rotor: to a speed [rad/s], to an angle [rad], with a torque [N m].
  [[nodiscard]] Errors set_speed(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors set_angle(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors set_torque(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors clear_drive(BodyHandle body);
  [[nodiscard]] Errors set_force(BodyHandle body, const PointForce& force);
  [[nodiscard]] Errors clear_force(BodyHandle body);
  [[nodiscard]] Errors set_motion(BodyHandle body, const MotionTarget& target);
  [[nodiscard]] Errors clear_motion(BodyHandle body, std::optional<double> over = {});
  /// Drive of a joint's coordinate. `coordinate` is an index in JointDef::coordinates().
  [[nodiscard]] Errors set_drive(JointHandle joint, const DriveTarget& target, int coordinate = 0);
  [[nodiscard]] Errors set_drive_limit(JointHandle joint, double limit, int coordinate = 0);
  [[nodiscard]] Errors clear_drive(JointHandle joint, int coordinate = 0);
  [[nodiscard]] Errors release_joint(JointHandle joint);
  [[nodiscard]] Errors lock_joint(JointHandle joint);
  [[nodiscard]] Errors set_compliance(CableHandle cable, double compliance);
  [[nodiscard]] Errors clear_compliance(CableHandle cable);
  [[nodiscard]] Errors set_breaking_tension(CableHandle cable, double tension);
  [[nodiscard]] Errors clear_breaking_tension(CableHandle cable);
  /// Simulation::cut_cable(): the cable parts now, in the span with the largest tension. A cable
  /// without tension parts once it carries tension, unless clear_breaking_tension() is called
  /// before. The next report has the event. Nothing happens if the cable is cut already.
  [[nodiscard]] Errors cut(CableHandle cable);
  /// Cuts the cable at a length from its first link on [m, unstretched], cable on wheels and drums
  /// included, also without tension. The place must lie in a free span.
  [[nodiscard]] Errors cut(CableHandle cable, double place);
  [[nodiscard]] Errors set_wrap_friction(CableHandle cable, double friction);
  [[nodiscard]] Errors clear_wrap_friction(CableHandle cable);
  [[nodiscard]] Errors set_friction(CableHandle cable, int link, double friction);
  [[nodiscard]] Errors clear_friction(CableHandle cable, int link);
  [[nodiscard]] Errors set_feed_speed(CableHandle cable, int link, const DriveTarget& target);
  [[nodiscard]] Errors clear_feed_speed(CableHandle cable, int link);

  /// Sets several controls, all or none: if `set` returns faults, every control that `set` has set
  /// or cleared gets its previous value back.
  [[nodiscard]] Errors set_together(const std::function<Errors()>& set);

  /// Puts a body elsewhere, together with the bodies mounted on it. The body must be free, planar
  /// or a slider, and no joint may hold it. Its frame's origin goes to `position` [m]; its velocity
  /// stays. Cables follow: wheels take and give the arcs between the old and the new contacts.
  /// Bodies may overlap afterwards; the next step separates them.
  [[nodiscard]] Result<Placement> place(BodyHandle body, const Vector3& position,
                                        std::optional<Quaternion> orientation, Keep keep);

  /// Moves the bodies through these states, all or nothing; the last one becomes the present state.
  /// Only bodies, joints and controls of bodies count in `way`: cables follow from state to state,
  /// as in the place() above. No body may turn by pi or more between two states of `way`, which are
  /// states of this world. statics/place_joints.h makes such ways.
  [[nodiscard]] Result<Placement> place(std::span<const State> way, Keep keep);

  /// Calls `look` with the simulation. The features of the simulation may be used as scratch, but
  /// its state must stay as it is (statics/joint_space.h). Fails within a step or an edit.
  [[nodiscard]] Errors examine(const std::function<void(Simulation&)>& look);

  /// Changes bodies, joints and cables, all or nothing (cable/edit.h). A scene's controllers and
  /// triggers find their objects by name; an edit that removes one of these objects fails. edit(),
  /// place() and restore() fail if they are called from within a step or another edit.
  [[nodiscard]] Result<EditReport> edit(const std::function<void(Edit&)>& changes);

  /// The state, to be hashed, kept and restored. restore() refuses states of worlds whose bodies,
  /// joints, cables, links or colliders are others, as before an edit that changed them.
  [[nodiscard]] const State& state() const { return simulation().world.state(); }
  [[nodiscard]] Errors restore(const State& state);
  /// Restoring a snapshot works across edits. Handles of objects that existed at the snapshot
  /// become valid again.
  [[nodiscard]] LiveSnapshot snapshot() const;
  [[nodiscard]] Errors restore(const LiveSnapshot& snapshot);

  /// World::keep_in_place(). As long as the returned pointer is held, the state stays at its
  /// address across edits, too, with the values from before the edit.
  [[nodiscard]] std::shared_ptr<const void> keep_in_place();
  /// Sets controls as set_together() does, for callers without handles
  /// (scenes/control/control_point.h). `set` must do nothing else.
  [[nodiscard]] Errors set_in_simulation(const std::function<Errors(Simulation&)>& set);

  /// Access to reports and certificates. An edit, and restoring a snapshot, replace this object by
  /// another. Bodies that have been removed remain in its model as static bodies without a shape.
  [[nodiscard]] const Simulation& simulation() const;

 private:
  LiveWorld(Simulation simulation, std::vector<Warning> at_start);
  [[nodiscard]] Errors restore(std::shared_ptr<LiveRevision> revision, const State& state);
  [[nodiscard]] Errors set_drive_of(BodyHandle body, DriveKind kind, const DriveTarget& target);
  [[nodiscard]] std::string fault_of(BodyHandle body) const;
  [[nodiscard]] std::string fault_of(JointHandle joint) const;
  [[nodiscard]] std::string fault_of(CableHandle cable) const;
  /// Index in the simulation of a joint or cable that exists; -1 for a cable that lies or hangs
  /// loose as a whole.
  [[nodiscard]] int index_of(JointHandle joint) const;
  [[nodiscard]] int index_of(CableHandle cable) const;
  /// The error for a cable that does not lie between two holds.
  [[nodiscard]] std::string pull_fault(CableHandle cable) const;
  /// The error for a span or link index of that cable that is out of range.
  [[nodiscard]] std::string span_fault(CableHandle cable, int span) const;
  /// Why the body cannot be placed at all, or not at `there`.
  [[nodiscard]] std::string place_fault(int body) const;
  [[nodiscard]] std::string place_fault(int body, const BodyState& there) const;
  /// Lets the cables follow from the state `from` to the bodies of `next`, and adds the changes of
  /// their lengths to the controls of `next`. Returns the fault, empty if there is none.
  [[nodiscard]] std::string take_cables_along(const State& from, Keep keep, State& next);
  [[nodiscard]] Result<Placement> complete(const State& next);
  void note_events(LiveReport& report) const;
  [[nodiscard]] bool is_broken(int joint) const;
  [[nodiscard]] Simulation& running();
  /// Why the world cannot be exchanged now; empty if it can.
  [[nodiscard]] std::string busy_fault() const;

  std::shared_ptr<LiveRevision> revision_;
  std::uint32_t next_generation_ = 2;
  bool is_busy_ = false;  // true within a step or an edit
  std::optional<RunCheck> check_;
  std::vector<Warning> at_start_;        // that no step has reported yet
  std::shared_ptr<const int> identity_;  // its address distinguishes this world from others
};

}  // namespace sheave
