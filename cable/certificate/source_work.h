#pragma once
// The work of sources of energy: drives, moved bodies, torques and feeds.
//
// A source does no more work in a substep of length h than |force| x speed x h, with the largest
// speed of its point of action: that of the start, that of the end, and the mean. The forces are
// those that the state reports:
//
//   torque of a body         the torque of the model or of the drive's table x spin
//   drive of a mounted rotor its multiplier x the spins of rotor and carrier
//   drive of a joint         its multiplier x the relative speed of the two bodies at the joint; a
//                            compliant drive: its multiplier x the rates of coordinate and target
//   feed                     the largest tension of the cable x the speed of the feed
//   prescribed body          per link of a cable on it or on its rotors: the largest tension of the
//                            cable x the number of spans there x the speed of the point of the body
//                            that is farthest out; plus the change of the body's own kinetic energy
//
// The bound is exact for a winch whose cable ends on the drum, and for a torque. The forces of
// joints and contacts on a prescribed body are not bounded here. The work of such a body is unknown
// while the body moves, and 0 while the body stands still.

#include <string>
#include <vector>

#include "cable/simulation.h"

namespace sheave::certify {

class SourceWork {
 public:
  explicit SourceWork(const Simulation& simulation);

  /// Whether the machine has any source.
  [[nodiscard]] bool any() const;
  /// To be called after each substep.
  void observe(const Simulation& simulation);

  struct Work {
    double most = 0.0;  ///< bound of the work in the step [J]
    bool known = true;  ///< false: there is no bound
  };
  /// Bound for the substeps since the last call, which are those of a step.
  Work take(const Simulation& simulation, const StepStatistics& statistics);

 private:
  /// The links of a cable on a prescribed body.
  struct Hold {
    int cable = 0;
    double spans = 0.0;  ///< number of spans that meet the body there
    double reach = 0.0;  ///< largest distance of the cable from the body's centre [m]
  };
  struct Prescribed {
    int body = 0;
    bool jointed = false;
    bool collides = false;
    std::vector<Hold> holds;
  };
  struct JointDrive {
    int joint = 0;
    int coordinate = 0;
    std::size_t feature = 0;
    std::size_t row = 0;  ///< of the drive's force in the state of the feature
    int body_a = 0;
    int body_b = 0;
    bool angle = false;
    bool compliant = false;
    double size = 0.0;   ///< sum of the sizes of both bodies [m]
    double value = 0.0;  ///< at the end of the last substep, as the next two
    double rate = 0.0;
    double target = 0.0;
  };
  struct Feed {
    int cable = 0;
    int link = 0;   ///< in the list of the cable
    int index = 0;  ///< among the links of all cables
  };

  void find_bodies(const Simulation& simulation);
  void find_holds(const Simulation& simulation);
  void find_joint_drives(const Simulation& simulation);
  void add_joint_drives(const Simulation& simulation, const LastSubstep& last);
  void add_compliant_drives(const Simulation& simulation, double h);
  void add_prescribed(const Simulation& simulation, const LastSubstep& last);
  void add_torques(const Simulation& simulation, const LastSubstep& last);
  void add_feeds(const Simulation& simulation, const LastSubstep& last);

  std::vector<Prescribed> prescribed_;
  std::vector<int> twisted_;  ///< bodies with a torque of the model or of a drive
  std::vector<int> motors_;   ///< mounted rotors with a drive, in the order of their feature
  std::vector<JointDrive> joint_drives_;
  std::vector<Feed> feeds_;
  double seen_ = 0.0;  ///< time of the observed substeps [s]
  Work work_;
};

}  // namespace sheave::certify
