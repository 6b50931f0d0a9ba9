#pragma once
// Events whose time a run resolves only to within a substep. The watch observes every substep,
// because an effect that lasts two substeps and ends within a step leaves no trace in the frames.
//
// An event is sudden if a delay of the event delays everything after it: a cable is cut, a joint
// breaks, an impact. An impact changes a body's velocity within one substep by at least 1/20 of the
// largest speed that the body has had and by at least four times the change in each of the three
// substeps before. (Forces change velocities evenly, by about the same amount in successive
// substeps. In a vibration of less than 1/3 rad per substep one change may be small by chance, but
// not the one before it.)
//
// A corner in the table of a drive is no such event: its time is known, and the drive's integral
// contains it. A cut by its time, by a trigger or by the tension of an elastic cable ends its substep
// (engine/instants.h). An acceleration that begins then lasts, so a change that the next substep
// repeats to a quarter is no impact.

#include <array>
#include <vector>

#include "measure/trajectory.h"

namespace sheave::measure {

/// Events at certain times, which a run finds to within a substep.
struct RunChanges {
  std::size_t events = 0;    ///< of cables' links, cuts, broken joints
  std::size_t slack = 0;     ///< spans that became slack or taut
  std::size_t contacts = 0;  ///< changes of the number of points at which bodies touch
  std::size_t sudden = 0;    ///< sudden events among them, and other impacts

  [[nodiscard]] std::size_t count() const { return events + slack + contacts; }
};

class EventWatch {
 public:
  /// For a run that begins with the state of `start`. `corners`: prescribed_corners() of its scene.
  EventWatch(const Simulation& start, std::vector<TrackedBody> bodies, std::vector<double> corners);

  /// To be called after every substep, and optionally in between.
  void observe(const Simulation& run);
  [[nodiscard]] const RunChanges& changes() const { return changes_; }

 private:
  /// Changes of a body's velocity.
  struct Motion {
    Vector3 velocity = Vector3::Zero();          ///< [m/s]
    Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s]
    double fastest = 0.0;                        ///< [m/s] at its surface
    std::array<double, 3> last{};                ///< changes in the last three substeps [m/s]
    double suspect = 0.0;  ///< change that the next substep has to judge [m/s]; 0: none
  };
  void look_at_cables(const Simulation& run);
  void look_at_joints(const World& world);
  /// Whether an impact has occurred on any body.
  bool look_at_motions(const World& world);
  /// Whether a table has a corner in the last two substeps. A substep with a corner near its end
  /// shows little of the new acceleration; the one after it shows all.
  [[nodiscard]] bool follows_corner() const;

  std::vector<TrackedBody> bodies_;
  std::vector<Motion> motions_;
  std::vector<double> corners_;  // and instants of cuts [s], increasing
  std::vector<bool> taut_;
  std::size_t touching_ = 0;
  std::size_t cable_events_;
  std::size_t broken_ = 0;
  double time_;
  std::array<double, 2> begins_;  // of the last two substeps [s], the older one first
  std::size_t substeps_ = 0;
  RunChanges changes_;
};

}  // namespace sheave::measure
