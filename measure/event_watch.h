#pragma once
// What happens in a run at moments that its step finds to within a substep, looked at substep by
// substep: what acts in two substeps of a step and is over at its end leaves nothing in the frames.
//
// An event is sudden if all that comes after it comes later as it does: a cable that is cut, a joint
// that breaks, an impact. An impact is one that changes a body's velocity within one substep by a
// twentieth of the largest speed that the body has had and by four times what any of the three
// substeps before has changed it by. (Forces change velocities evenly: by as much in one substep as
// in the next. In a vibration of less than a third of a radian per substep, where one change is
// small by chance, the one before that is not.)

#include <array>
#include <vector>

#include "measure/trajectory.h"

namespace sheave::measure {

/// Things that happen at a moment, which a step finds to within itself.
struct RunChanges {
  std::size_t events = 0;    ///< of cables' links, cuts, broken joints
  std::size_t slack = 0;     ///< spans that went slack or taut
  std::size_t contacts = 0;  ///< the number of points at which bodies touch changed
  std::size_t sudden = 0;    ///< those among them that are sudden, and other impacts

  [[nodiscard]] std::size_t count() const { return events + slack + contacts; }
};

class EventWatch {
 public:
  /// For a run that begins with the state that `start` has.
  EventWatch(const Simulation& start, std::vector<TrackedBody> bodies);

  /// To be called after every substep, and at will between.
  void observe(const Simulation& run);
  [[nodiscard]] const RunChanges& changes() const { return changes_; }

 private:
  /// How a body's velocity changes.
  struct Motion {
    Vector3 velocity = Vector3::Zero();          ///< [m/s]
    Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s]
    double fastest = 0.0;                        ///< [m/s] at its surface
    std::array<double, 3> last{};                ///< changes in the last three substeps [m/s]
  };
  void look_at_cables(const Simulation& run);
  void look_at_joints(const World& world);
  /// Whether any body has been hit.
  bool look_at_motions(const World& world);

  std::vector<TrackedBody> bodies_;
  std::vector<Motion> motions_;
  std::vector<bool> taut_;
  std::size_t touching_ = 0;
  std::size_t cable_events_;
  std::size_t broken_ = 0;
  double time_;
  std::size_t substeps_ = 0;
  RunChanges changes_;
};

}  // namespace sheave::measure
