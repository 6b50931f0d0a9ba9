#pragma once
// The rows and loads of a simulation in one pose, at rest and without passing time.
//
// With displacements q along the degrees of freedom (engine/dynamics/coordinates.h) from the pose
// of a state, each unknown force l satisfies
//
//   loads + P^T l = 0           P: the gradients along which the unknown acts, rows times weights
//   C + A l = 0                 if the row is active, with its compliance A
//
// A displacement dq changes C + A l by J dq with l fixed, where J are the rows' own gradients. For
// joints, contacts and cables with a constant compliance A does not change. For a cable with a
// material (cable/cable_material.cpp) J contains the change of A. There, cable that a wheel gives
// to a span is assumed to have the strain of that span. In a vibrating machine that holds after the
// first oscillation, because cable that comes off a wheel (last in, first out) has come onto it
// from that span.
//
// The rows are those that the solvers of a step get from the features, in a substep of length 0:
// driven bodies stay in place, dampers have no force, dry friction holds.

#include <array>
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

/// Length of the substep in which rows are evaluated [s]: so short that drives and feeds move nothing,
/// and long enough for multipliers, force x h^2, to be usable numbers.
inline constexpr double no_time = 1e-9;

/// One unknown force: that of a row, or of several rows that share a tension.
struct ForceUnknown {
  /// One of the rows that share the unknown.
  struct Part {
    int index = 0;            ///< index of its multiplier in the feature
    double weight = 1.0;      ///< its force / the unknown
    double compliance = 0.0;  ///< of this row alone [m/N or rad/(N m)]
    double damping = 0.0;     ///< of this row alone [N s/m or N m s/rad]
  };
  std::size_t feature = 0;
  std::vector<Part> parts;
  double value = 0.0;       ///< C [m or rad]
  double compliance = 0.0;  ///< A [m/N or rad/(N m)]
  /// Force per rate of C in slow motions [N s/m or N m s/rad]; in others rows that share the unknown
  /// relax (statics/relaxation.h).
  double damping = 0.0;
  bool approximate = false;  ///< Row::approximate of one of its rows
  double lower = 0.0;        ///< bounds of the force [N or N m]
  double upper = 0.0;
  double friction = 0.0;  ///< bounds are +- this times the sum of the `pressing` forces
  /// Another unknown whose row presses this one, and the force of that row per unknown.
  struct Pressing {
    int unknown = -1;  ///< -1: none
    double weight = 0.0;
  };
  std::array<Pressing, 2> pressing;
  int shares = 0;  ///< for the first of several rows with a common bound of friction: their number
  bool damper = false;  ///< depends on the velocity only

  [[nodiscard]] bool bilateral() const {
    return lower == -Row::unbounded && upper == Row::unbounded;
  }
  [[nodiscard]] bool given() const { return lower == upper; }
  [[nodiscard]] bool dry_friction() const { return lower == -upper && !bilateral() && !given(); }
  [[nodiscard]] bool is_pressed() const { return pressing[0].unknown >= 0; }
  /// Largest force of friction [N or N m] with these forces of all unknowns.
  [[nodiscard]] double largest_friction(const VectorX& forces) const;
};

/// The rows and loads in one pose.
struct ConfigurationRows {
  VectorX loads;  ///< per degree of freedom [N or N m]
  std::vector<ForceUnknown> unknowns;
  /// J = d(C + A l)/dq with l fixed, at the pose of the state: unknowns x degrees of freedom. (For
  /// a cable with `axial_stiffness`, C and A both change with the cable that a wheel takes or
  /// gives; only their sum has the gradient along which the forces act.)
  MatrixX gradients;
  MatrixX actions;        ///< P: J with weights
  bool weighted = false;  ///< J and P differ because cable slides with friction
  /// The part of the stiffness that rows with approximate derivatives have, after refine_rows();
  /// empty without such rows [N/m, N m].
  MatrixX refined_stiffness;
  double refined_error = 0.0;  ///< error of an entry / largest entry of `refined_stiffness`
  /// The same for motions that do not stretch the ropes of these rows.
  double refined_rounding = 0.0;
};

/// The state of the simulation, in which ropes remember the strains that they have there: vibrations
/// about it are along the lines on which ropes turn (cable/rope_memory.h).
[[nodiscard]] State remembered_state(const Simulation& simulation);

/// The configuration uses the features of `simulation` as scratch; simulation and state must
/// outlive it.
class Configuration {
 public:
  /// `load`: factor of all loads: gravity, forces, torques.
  Configuration(Simulation& simulation, const State& state, double load);

  [[nodiscard]] int freedoms() const { return freedoms_; }
  /// Displaces the bodies from the pose of the state.
  void place(const VectorX& displacement);
  /// The rows in the present pose.
  [[nodiscard]] ConfigurationRows rows();
  /// The rows of one feature in the present pose, without sums over rows that share an unknown.
  struct SingleRows {
    std::vector<char> exists;  ///< per multiplier of the feature: whether it has a row
    VectorX values;            ///< C [m or rad]; 0 without a row
    MatrixX gradients;         ///< multipliers x degrees of freedom; 0 without a row
    /// Rate of C that the motion of prescribed bodies in the state causes [m/s or rad/s].
    VectorX drift;
  };
  [[nodiscard]] SingleRows single_rows(std::size_t feature);
  /// The equations of rest with given unknowns of rows(), in the present pose.
  struct Balance {
    VectorX forces;     ///< loads + P^T l, per degree of freedom
    VectorX residuals;  ///< C + A l, per unknown; [m or rad]
  };
  [[nodiscard]] Balance balance_at(const VectorX& unknowns);
  /// The unknowns for given row forces, and the reverse.
  [[nodiscard]] static VectorX unknowns_of(const ConfigurationRows& rows, const RowForces& forces);
  [[nodiscard]] RowForces forces_of(const ConfigurationRows& rows, const VectorX& unknowns) const;
  /// Row forces that are all zero.
  [[nodiscard]] RowForces no_forces() const;
  /// Linearises at these forces the rows whose laws are not linear.
  void assume(const RowForces& forces) const;
  /// Lets features update their discrete choices (e.g. slipping links) with these forces. Returns
  /// whether any has changed.
  bool revise(const RowForces& forces);
  /// Forces of the rows of all features except `except` on each body, and on the world, which comes
  /// last [N].
  [[nodiscard]] std::vector<Vector3> forces_on_bodies(const RowForces& forces, std::size_t except);
  /// The state in this pose with these forces, at rest. The machine is never in the intermediate
  /// poses of a search, so no cable leaves a wheel, breaks or is used up, unless `lets_go`.
  [[nodiscard]] State finish(const RowForces& forces, bool lets_go = false);

  [[nodiscard]] MatrixX mass() const;       ///< with ropes with inertia [kg, kg m2]
  [[nodiscard]] MatrixX body_drag() const;  ///< [N s/m, N m s]
  /// Components along the degrees of freedom of a force [N] and a torque [N m] on a body (about its
  /// centre of mass).
  [[nodiscard]] VectorX along(int body, const Vector3& force, const Vector3& torque) const;
  /// Change of each unknown's C + A l per rotation of a prescribed rotor, in the present pose, with
  /// the unknowns l fixed [m/rad].
  [[nodiscard]] VectorX by_drive(int body);
  /// Gives the bodies of a state these velocities along the degrees of freedom.
  void set_velocities(const VectorX& rates, State& state) const;
  /// Gives ropes with inertia the forces of these accelerations along the degrees of freedom, at rest
  /// in the present pose, for reports.
  void set_rope_forces(const VectorX& accelerations, State& state) const;
  /// Largest translation by a displacement [m], and largest rotation of bodies not on an axle
  /// [rad].
  struct Reach {
    double translation = 0.0;
    double turn = 0.0;
    double spin = 0.0;  ///< of rotors [rad]
  };
  [[nodiscard]] Reach reach(const VectorX& displacement) const;
  /// Largest motion by a displacement of a point at the distance `arm` [m] from the centre of mass
  /// of a body, or of its mount [m].
  [[nodiscard]] double moved(int body, double arm, const VectorX& displacement) const;

 private:
  void linearise();
  /// The gradient of a row by displacements along the degrees of freedom.
  [[nodiscard]] VectorX along_freedoms(const Row& row) const;
  /// Writes the gradients and actions of rows(), with the unknown of each row.
  void project_rows(const std::vector<int>& unknown_of, ConfigurationRows& result) const;
  /// Adds the mass of ropes with inertia.
  void add_ropes(MatrixX& mass) const;
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
  std::vector<std::vector<double>> doubled_;  ///< compliances in a substep of twice the length
};

}  // namespace sheave
