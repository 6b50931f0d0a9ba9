#pragma once
// The rows and loads of a simulation at a pose, while nothing moves and no time passes.
//
// With displacements q along the degrees of freedom (engine/dynamics/coordinates.h) from the pose
// of a state, each unknown l of a force gives
//
//   loads + P^T l = 0           P: the gradients along which the unknown acts, rows times weights
//   C + A l = 0                 where the row acts, with its compliance A
//
// and a displacement dq changes C + A l by J dq with l fixed, where J are the rows' own gradients:
// of joints, contacts and cables with a constant compliance A does not change, and of a cable of a
// material (cable/cable_material.cpp) the change of A is in J. There what a wheel gives a span is
// taken to have the strain of that span. A machine that vibrates has seen to that after its first
// swing there and back, for what comes off a wheel last in, first out, has come onto it from there.
//
// Rows are those that the solvers of the step ask features for, in a substep of no time: what has
// been driven stays where it is, dampers do nothing, dry friction holds.

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "cable/simulation.h"
#include "engine/row_list.h"
#include "engine/substep.h"

namespace sheave {

using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

/// Forces of all features [N or N m], by the index of the row's multiplier.
using RowForces = std::vector<std::vector<double>>;

/// One unknown: a row, or several that share a tension.
struct ForceUnknown {
  /// One of the rows that share it.
  struct Part {
    int index = 0;        ///< of its multiplier among those of the feature
    double weight = 1.0;  ///< its force is this times the unknown
  };
  std::size_t feature = 0;
  std::vector<Part> parts;
  double value = 0.0;       ///< C [m or rad]
  double compliance = 0.0;  ///< A [m/N or rad/(N m)]
  double damping = 0.0;     ///< force per rate of C [N s/m or N m s/rad]
  double lower = 0.0;       ///< bounds of the force [N or N m]
  double upper = 0.0;
  double friction = 0.0;  ///< bounds are +- this times the force of `pressed_by`
  int pressed_by = -1;    ///< another unknown
  int shares = 0;         ///< of the first of several that bound one friction: how many
  bool damper = false;    ///< acts on speed alone

  [[nodiscard]] bool bilateral() const {
    return lower == -Row::unbounded && upper == Row::unbounded;
  }
  [[nodiscard]] bool given() const { return lower == upper; }
  [[nodiscard]] bool dry_friction() const { return lower == -upper && !bilateral() && !given(); }
};

/// All of it at one pose.
struct ConfigurationRows {
  VectorX loads;  ///< per degree of freedom [N or N m]
  std::vector<ForceUnknown> unknowns;
  /// J = d(C + A l)/dq with l fixed, from where the pose is that of the state: unknowns x degrees of
  /// freedom. (Of a cable of a material with `axial_stiffness` C and A both change with what a wheel
  /// takes and gives; only their sum has the gradient that the forces act along.)
  MatrixX gradients;
  MatrixX actions;        ///< P: the same with weights
  bool weighted = false;  ///< J and P differ: cable slides with friction
};

/// Of `simulation`, whose features it uses as scratch; both must outlive it.
class Configuration {
 public:
  /// `load` scales all loads: gravity, forces, torques.
  Configuration(Simulation& simulation, const State& state, double load);

  [[nodiscard]] int freedoms() const { return freedoms_; }
  /// Displaces the bodies from the state's pose.
  void place(const VectorX& displacement);
  /// What acts there. `forces` tell which friction slides.
  [[nodiscard]] ConfigurationRows rows();
  /// Loads and the forces `unknowns` of rows(), P^T l, at the place of now.
  [[nodiscard]] VectorX forces_at(const VectorX& unknowns);
  /// The unknowns that row forces stand for, and back.
  [[nodiscard]] static VectorX unknowns_of(const ConfigurationRows& rows, const RowForces& forces);
  [[nodiscard]] RowForces forces_of(const ConfigurationRows& rows, const VectorX& unknowns) const;
  /// No forces.
  [[nodiscard]] RowForces no_forces() const;
  /// Lets features choose what rows do not tell, with these forces; whether anything has changed.
  bool revise(const RowForces& forces);
  /// What the rows of all features but `except` do to bodies, and to the world, which comes last
  /// [N].
  [[nodiscard]] std::vector<Vector3> forces_on_bodies(const RowForces& forces, std::size_t except);
  /// The state of this pose with these forces, at rest. A pose on the way of a search is none that
  /// the machine is ever in: no cable leaves a wheel, breaks or is used up there, unless `lets_go`.
  [[nodiscard]] State finish(const RowForces& forces, bool lets_go = false);

  [[nodiscard]] MatrixX mass() const;       ///< [kg, kg m2]
  [[nodiscard]] MatrixX body_drag() const;  ///< [N s/m, N m s]
  /// What a force [N] and a torque [N m] on a body (about its centre of mass) are along the degrees
  /// of freedom.
  [[nodiscard]] VectorX along(int body, const Vector3& force, const Vector3& torque) const;
  /// Change of each unknown's C + A l per turn of a prescribed rotor, at the place of now, with the
  /// unknowns l fixed [m/rad].
  [[nodiscard]] VectorX by_drive(int body);
  /// Gives the bodies of a state these velocities along the degrees of freedom.
  void set_velocities(const VectorX& rates, State& state) const;
  /// How far a displacement moves anything [m], and turns what is not on an axle [rad].
  struct Reach {
    double translation = 0.0;
    double turn = 0.0;
    double spin = 0.0;  ///< of rotors [rad]
  };
  [[nodiscard]] Reach reach(const VectorX& displacement) const;
  /// How far a displacement moves what is `arm` [m] away from the centre of mass of a body, or of
  /// that which it is mounted on, at most [m].
  [[nodiscard]] double moved(int body, double arm, const VectorX& displacement) const;

 private:
  void linearise();
  void find_dampers();
  void begin();
  [[nodiscard]] VectorX loads();
  [[nodiscard]] bool is_damper(std::size_t feature, const Row& row) const;

  Simulation& simulation_;
  const State& state_;
  double load_;
  int freedoms_;
  Substep substep_;
  RowList rows_;
  std::vector<int> feature_rows_;
  std::vector<std::vector<int>> unknown_at_;  ///< of rows(): per feature and multiplier; -1: none
  std::vector<std::vector<double>> doubled_;  ///< compliances in a substep twice as long
};

}  // namespace sheave
