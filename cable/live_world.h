#pragma once
// A world that one holds in one's hands: steps it, reads it, and steers it while it runs.
//
//   auto world = sheave::load("crane.json");                        // or LiveWorld::create(model, cables)
//   if (!world) report(world.errors());
//   const auto drum = *world->body("drum");
//   const auto rope = *world->cable("rope");
//   while (running) {
//     if (auto errors = world->set_speed(drum, lever()); !errors.empty()) report(errors);
//     if (!world->step().ok()) break;
//     show(*world->tension(rope, 2));
//   }
//
// Bodies, joints and cables are told by handles. Errors are values: what cannot be done says why
// and what can, and nothing has changed. Readers look at the state as it is between two steps; but
// for energy() none of them allocates or searches.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/edit.h"
#include "cable/handle.h"
#include "cable/run_check.h"
#include "cable/simulation.h"
#include "cable/step_warnings.h"
#include "engine/wrench.h"

namespace sheave {

/// Where a body's frame is and how it moves.
struct BodyPose {
  Vector3 position = Vector3::Zero();               ///< of its origin [m]
  Quaternion orientation = Quaternion::Identity();  ///< body frame to world frame
  Vector3 velocity = Vector3::Zero();               ///< of its origin [m/s]
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s]
};

/// What is kept of the cables when a body is put elsewhere.
enum class Keep {
  /// Their lengths: they get slack, or taut where they are elastic. A rigid one must be long enough
  length,
  tension,  ///< their tensions, and their slack: what spans need comes in or goes out
};

/// What a placement did.
struct Placement {
  struct Cable {
    CableHandle cable;
    double added = 0.0;  ///< to its length [m]; < 0: taken out
  };
  double energy = 0.0;        ///< by how much there is more of it [J]
  std::vector<Cable> cables;  ///< those whose lengths have changed
};

/// What a step of a LiveWorld did.
struct LiveReport : StepReport {
  /// The most events that a report has.
  static constexpr std::size_t most_events = 64;
  std::vector<CableEvent> events;          ///< of cables, in their order
  std::vector<JointHandle> broken_joints;  ///< in this step
  std::size_t omitted = 0;                 ///< events beyond those
  /// What could not be done as asked: of solver and integrator in this step, of cables if it was
  /// the first time. The command prints the same of a run.
  std::vector<Warning> warnings;
};

struct LiveRevision;

/// A state of a LiveWorld with all that it is a state of, so that it can be gone back to across
/// edits.
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
  /// Of a simulation that is there, with its supervisor if it has one.
  static LiveWorld of(Simulation simulation) { return LiveWorld(std::move(simulation)); }
  ~LiveWorld();
  LiveWorld(LiveWorld&&) noexcept;
  LiveWorld& operator=(LiveWorld&&) noexcept;

  // By name; the error says which names are like it.
  [[nodiscard]] Result<BodyHandle> body(std::string_view name) const;
  [[nodiscard]] Result<JointHandle> joint(std::string_view name) const;
  [[nodiscard]] Result<CableHandle> cable(std::string_view name) const;
  // By the index in the model's list, or in that of the cables, which must be in it.
  [[nodiscard]] BodyHandle body_at(int index) const;
  [[nodiscard]] JointHandle joint_at(int index) const;
  [[nodiscard]] CableHandle cable_at(int index) const;

  /// What it is defined by; null if the handle refers to nothing.
  [[nodiscard]] const JointDef* definition(JointHandle joint) const;
  // All there are, in the order of their handles.
  [[nodiscard]] std::vector<BodyHandle> bodies() const;
  [[nodiscard]] std::vector<JointHandle> joints() const;
  [[nodiscard]] std::vector<CableHandle> cables() const;

  /// As Simulation::step(), with what happened. `before_substep` is called after controllers and
  /// triggers, and may set controls. From within a step or an edit there is no step: it is told as
  /// stopped.
  [[nodiscard]] LiveReport step(const StopRequest& stop = {},
                                const std::function<void()>& before_substep = {});

  /// From now on steps are checked as those of `sheave run` are (cable/run_check.h); restoring,
  /// placing and editing begin a new balance of energy.
  void check_run();
  /// What that has found so far; empty without check_run().
  [[nodiscard]] Certificate run_certificate() const;

  // Readers.
  [[nodiscard]] double time() const { return state().time; }
  [[nodiscard]] Result<std::string> name(BodyHandle body) const;
  [[nodiscard]] Result<std::string> name(JointHandle joint) const;
  [[nodiscard]] Result<std::string> name(CableHandle cable) const;
  [[nodiscard]] Result<BodyPose> pose(BodyHandle body) const;
  /// Of the body-frame point `local` [m], in the world.
  [[nodiscard]] Result<Vector3> point(BodyHandle body, const Vector3& local) const;
  /// Mean over the last substep [N], >= 0; of a span as listed, 0 where the cable passes a link by.
  [[nodiscard]] Result<double> tension(CableHandle cable, int span) const;
  /// Unstretched length of a span, and of what lies on a listed link [m].
  [[nodiscard]] Result<double> rest_length(CableHandle cable, int span) const;
  [[nodiscard]] Result<double> stored_length(CableHandle cable, int link) const;
  /// Whether something of the cable is between two holds; otherwise it lies or hangs loose. False
  /// if the handle refers to nothing.
  [[nodiscard]] bool pulls(CableHandle cable) const;
  /// All of it, loose ends too [m]; of one without a loose end this is what its report calls total
  /// length. Allocates.
  [[nodiscard]] Result<double> length(CableHandle cable) const;
  /// Length beyond the link that holds a loose end [m]; nothing if the end is not loose.
  [[nodiscard]] Result<std::optional<double>> loose_length(CableHandle cable, CableEnd end) const;
  /// What the joint did to its body_b in the last substep, as JointReport tells it.
  [[nodiscard]] Result<Wrench> force(JointHandle joint) const;
  /// Of everything; takes time in proportion to what there is.
  [[nodiscard]] Energy energy() const { return simulation().world.energy(); }

  // Controls, as World and Simulation have them (engine/world.h, cable/simulation.h).
  [[nodiscard]] Errors set_gravity(const Vector3& gravity);
  void clear_gravity();
  /// Of a rotor with a drive to a speed [rad/s], an angle [rad], a torque [N m].
  [[nodiscard]] Errors set_speed(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors set_angle(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors set_torque(BodyHandle body, const DriveTarget& target);
  [[nodiscard]] Errors clear_drive(BodyHandle body);
  [[nodiscard]] Errors set_force(BodyHandle body, const PointForce& force);
  [[nodiscard]] Errors clear_force(BodyHandle body);
  [[nodiscard]] Errors set_motion(BodyHandle body, const MotionTarget& target);
  [[nodiscard]] Errors clear_motion(BodyHandle body, std::optional<double> over = {});
  /// Of the drive of a joint's coordinate, by its index in JointDef::coordinates().
  [[nodiscard]] Errors set_drive(JointHandle joint, const DriveTarget& target, int coordinate = 0);
  [[nodiscard]] Errors set_drive_limit(JointHandle joint, double limit, int coordinate = 0);
  [[nodiscard]] Errors clear_drive(JointHandle joint, int coordinate = 0);
  [[nodiscard]] Errors release_joint(JointHandle joint);
  [[nodiscard]] Errors lock_joint(JointHandle joint);
  [[nodiscard]] Errors set_compliance(CableHandle cable, double compliance);
  [[nodiscard]] Errors clear_compliance(CableHandle cable);
  [[nodiscard]] Errors set_breaking_tension(CableHandle cable, double tension);
  [[nodiscard]] Errors clear_breaking_tension(CableHandle cable);
  [[nodiscard]] Errors set_wrap_friction(CableHandle cable, double friction);
  [[nodiscard]] Errors clear_wrap_friction(CableHandle cable);
  [[nodiscard]] Errors set_friction(CableHandle cable, int link, double friction);
  [[nodiscard]] Errors clear_friction(CableHandle cable, int link);
  [[nodiscard]] Errors set_feed_speed(CableHandle cable, int link, const DriveTarget& target);
  [[nodiscard]] Errors clear_feed_speed(CableHandle cable, int link);

  /// Several controls, all or none: what `set` has set and cleared is as it was if it returns
  /// faults.
  [[nodiscard]] Errors set_together(const std::function<Errors()>& set);

  /// Puts a free, planar or slider body that no joint holds elsewhere, with what is mounted on it;
  /// it keeps its velocity. The origin of its frame goes to `position` [m]. Cables follow: wheels
  /// take and give the arcs in between. Whether bodies then overlap nobody asks; the next step
  /// takes them apart.
  [[nodiscard]] Result<Placement> place(BodyHandle body, const Vector3& position,
                                        std::optional<Quaternion> orientation, Keep keep);

  /// Changes what the world is made of, all or nothing: cable/edit.h. Scenes' controllers and
  /// triggers find what they refer to by name; an edit that takes it away fails. Not from within a
  /// step or another edit, as place() and restore() are not.
  [[nodiscard]] Result<EditReport> edit(const std::function<void(Edit&)>& changes);

  /// The state, to hash, to keep and to go back to as long as nothing is edited.
  [[nodiscard]] const State& state() const { return simulation().world.state(); }
  [[nodiscard]] Errors restore(const State& state);
  /// The same across edits: handles of what there was then are good again.
  [[nodiscard]] LiveSnapshot snapshot() const;
  [[nodiscard]] Errors restore(const LiveSnapshot& snapshot);

  /// World::keep_in_place(): and as long as what it returns is held the state stays there across
  /// edits, too, as it was before them.
  [[nodiscard]] std::shared_ptr<const void> keep_in_place();
  /// What `set` sets, as in set_together(), for those who do not tell it by handles
  /// (scenes/control/control_point.h). It must do nothing else.
  [[nodiscard]] Errors set_in_simulation(const std::function<Errors(Simulation&)>& set);

  /// Everything else that can be asked of it: reports, certificates. An edit or restoring a
  /// snapshot makes another one. Bodies that have been removed stand in its model as static ones
  /// without a shape.
  [[nodiscard]] const Simulation& simulation() const;

 private:
  explicit LiveWorld(Simulation simulation);
  [[nodiscard]] Errors restore(std::shared_ptr<LiveRevision> revision, const State& state);
  [[nodiscard]] Errors set_drive_of(BodyHandle body, DriveKind kind, const DriveTarget& target);
  [[nodiscard]] std::string fault_of(BodyHandle body) const;
  [[nodiscard]] std::string fault_of(JointHandle joint) const;
  [[nodiscard]] std::string fault_of(CableHandle cable) const;
  /// Of a joint or cable that is there: its index in the simulation; of a cable of which nothing
  /// pulls -1.
  [[nodiscard]] int index_of(JointHandle joint) const;
  [[nodiscard]] int index_of(CableHandle cable) const;
  /// The fault of a cable that is not between holds.
  [[nodiscard]] std::string pull_fault(CableHandle cable) const;
  /// The fault of a span or link of that cable.
  [[nodiscard]] std::string span_fault(CableHandle cable, int span) const;
  /// Why the body cannot be put anywhere else, or there.
  [[nodiscard]] std::string place_fault(int body) const;
  [[nodiscard]] std::string place_fault(int body, const BodyState& there) const;
  void note_events(LiveReport& report) const;
  [[nodiscard]] bool is_broken(int joint) const;
  [[nodiscard]] Simulation& running();
  /// Why what there is cannot be exchanged now; empty if it can.
  [[nodiscard]] std::string busy_fault() const;

  std::shared_ptr<LiveRevision> revision_;
  std::uint32_t next_generation_ = 2;
  bool is_busy_ = false;  // in a step, or in an edit
  std::optional<RunCheck> check_;
  std::shared_ptr<const int> identity_;  // its address tells this world from others
};

}  // namespace sheave
