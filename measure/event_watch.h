#pragma once
// Events whose time a run resolves only to within a substep. The watch observes every substep,
// because an effect that lasts two substeps and ends within a step leaves no trace in the frames.
//
// An event is sudden if a delay of the event delays everything after it: a break whose instant is not
// known, a cable that is used up, an impact. An impact changes a body's velocity within one substep by at least 1/20 of the
// largest speed that the body has had and by at least four times the change in each of the three
// substeps before. (Forces change velocities evenly, by about the same amount in successive
// substeps. In a vibration of less than 1/3 rad per substep one change may be small by chance, but
// not the one before it.)
//
// An acceleration that begins lasts, so a change that the next substep repeats to a quarter is no
// impact: a corner in a table, a drive that starts, a cut. An impact that ends its substep
// (engine/instants.h) is not late, and neither is a joint that breaks, or a cable that is cut by its time,
// by a trigger or by a tension. The tension of a rigid cable and the force of a joint are those of
// short trial motions. Where none of them has a solution, the break is at the end of a substep and
// sudden (StepStatistics::unknown_forces).
//
// Dry friction of a contact that lets go is sudden, too: the sliding begins late. Friction that stops a
// body leaves no speed, so a late stop displaces the body once. With the jump A of the acceleration
// and the substep H, no point of the grid of substeps is further from the stop than H / 2, and the
// displacement is at most A (H / 2)^2 / 2.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "measure/trajectory.h"

namespace sheave::measure {

/// Events at certain times, which a run finds to within a substep.
struct RunChanges {
  std::size_t events = 0;    ///< of cables' links, cuts, broken joints
  std::size_t slack = 0;     ///< spans that became slack or taut
  std::size_t contacts = 0;  ///< changes of the number of points at which bodies touch
  std::size_t stops = 0;     ///< pairs of touching bodies that friction has stopped
  std::size_t sudden = 0;    ///< sudden events among them, and other impacts

  [[nodiscard]] std::size_t count() const { return events + slack + contacts + stops; }
};

class EventWatch {
 public:
  /// For a run that begins with the state of `start`.
  EventWatch(const Simulation& start, std::vector<TrackedBody> bodies);

  /// To be called after every substep, and optionally in between.
  void observe(const Simulation& run);
  /// To be called after every step, behind observe(), with the statistics of the step.
  void end_step(const StepStatistics& statistics);
  [[nodiscard]] const RunChanges& changes() const { return changes_; }
  /// A displacement and a rotation that may hide within a substep.
  struct Hidden {
    double moved = 0.0;   ///< [m]
    double turned = 0.0;  ///< [rad]
  };
  /// Of each body, by the stops so far: how far the body is off if its stops come with the grid of
  /// substeps.
  [[nodiscard]] const std::vector<Hidden>& hidden_by_stops() const { return hidden_; }

 private:
  /// Changes of a body's velocity.
  struct Motion {
    Vector3 velocity = Vector3::Zero();          ///< [m/s]
    Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s]
    double fastest = 0.0;                        ///< [m/s] at its surface
    std::array<double, 3> last{};                ///< changes in the last three substeps [m/s]
    /// Changes in this substep and the three before, the newest first [m/s], [rad/s].
    std::vector<Vector3> changes = std::vector<Vector3>(4, Vector3::Zero());
    std::vector<Vector3> turn_changes = std::vector<Vector3>(4, Vector3::Zero());
    double suspect = 0.0;  ///< change that the next substep has to judge [m/s]; 0: none
  };
  void look_at_cables(const Simulation& run);
  void look_at_joints(const World& world);
  /// Finds pairs of bodies whose friction has let go or holds again since the last substep. Whether any
  /// has let go.
  bool look_at_friction(const World& world);
  /// Adds the displacements that a stop in the last substep may hide; `length`: of a substep [s].
  void add_hidden(double length);
  /// Whether an impact has occurred on any body.
  bool look_at_motions(const World& world);

  std::vector<TrackedBody> bodies_;
  std::vector<Motion> motions_;
  std::vector<bool> taut_;
  std::map<std::pair<int, int>, bool> holds_;  // touching pairs: whether a point of theirs sticks
  bool stopped_ = false;                       // some pair, in the last substep
  std::vector<Hidden> hidden_;
  std::size_t touching_ = 0;
  std::size_t cable_events_;
  std::size_t broken_ = 0;
  std::size_t hits_ = 0;            // impacts in this step
  std::size_t located_before_ = 0;  // instants of the step before that no impact has shown
  std::size_t by_forces_ = 0;       // breaks in this step by forces of rigid rows
  double time_;
  std::array<double, 2> begins_;  // of the last two substeps [s], the older one first
  std::size_t substeps_ = 0;
  RunChanges changes_;
};

}  // namespace sheave::measure
