#pragma once
// A problem in MuJoCo, in the formulation that is cheapest there and right.
//
// Each weight is a body on a slide joint and each wheel one on a hinge joint, all children of the
// world, so that the mass matrix is diagonal. A span is a fixed tendon: a linear function of two
// joint coordinates, s_(i+1) - s_i with s = r q for wheels, limited from above by 0. So it pulls
// and cannot push, turns the wheels, and its Jacobian is constant. (Spatial tendons slide over
// wheels without turning them; equality constraints would push as well.) There are no geometries,
// and everything that the problem does not need is switched off.

#include <memory>
#include <string>
#include <vector>

#include "bench/peers/machine.h"

namespace sheave::peers {

/// What MuJoCo leaves to the user's choice and the result or its cost depends on.
struct MujocoSettings {
  std::string solver = "Newton";     ///< PGS, CG, Newton
  std::string jacobian = "auto";     ///< dense, sparse, auto
  std::string integrator = "Euler";  ///< Euler, implicit, RK4
  int iterations = 100;              ///< of the solver at most
  double tolerance = 1e-8;           ///< at which it ends
  double impedance = 0.9999;  ///< solimp: 0.9 ... 0.9999, its largest; the rest of a limit is soft
  /// Reference of a limit that is violated: a time constant in steps (2 is the smallest that MuJoCo
  /// calls safe), or 0: one that removes the violation within a step (stiffness 1/dt^2, damping
  /// 1/dt).
  double time_constant = 2.0;
  bool warm_start = true;

  /// In one line.
  [[nodiscard]] std::string text() const;
};

/// The problem in MuJoCo's own format.
[[nodiscard]] std::string mujoco_xml(const Problem& problem, const MujocoSettings& settings);

[[nodiscard]] Result<std::shared_ptr<Machine>> mujoco_machine(const Problem& problem,
                                                              const MujocoSettings& settings);
/// "MuJoCo 2.2.2"
[[nodiscard]] std::string mujoco_version();

/// All combinations worth trying.
[[nodiscard]] std::vector<MujocoSettings> mujoco_settings();

/// One setting with what it came to in a trial.
struct MujocoTrial {
  MujocoSettings settings;
  MachineError error;
  double seconds = 0.0;  ///< per frame, best of three
};
/// Tries all of them; the fastest first.
[[nodiscard]] Result<std::vector<MujocoTrial>> mujoco_trials(const Problem& problem);
/// The fastest of the settings that are right, and the fastest of those whose positions are right
/// like the best ones', within a factor of two, if that is another.
[[nodiscard]] std::vector<MujocoTrial> best_trials(const std::vector<MujocoTrial>& trials);

/// Many worlds of one problem; threads may step different ones at the same time.
class MujocoWorlds {
 public:
  /// Errors are those of mujoco_machine().
  static Result<std::unique_ptr<MujocoWorlds>> create(const Problem& problem,
                                                      const MujocoSettings& settings,
                                                      std::size_t count);
  virtual ~MujocoWorlds() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  virtual void restart(std::size_t world) = 0;
  /// So many steps of one of them; false if its state means nothing any more.
  virtual bool step(std::size_t world, int steps) = 0;
  /// As Machine::read().
  virtual void read(std::size_t world, std::vector<double>& positions,
                    std::vector<double>& rates) const = 0;

 protected:
  MujocoWorlds() = default;
  MujocoWorlds(const MujocoWorlds&) = default;
  MujocoWorlds& operator=(const MujocoWorlds&) = default;
};

}  // namespace sheave::peers
