#pragma once
// The bow of scenes/paper/bow.json once more, without the engine: its limbs as two chains of rods
// in generalised coordinates, integrated by Runge and Kutta's method. It shares numbers with the
// scene, and nothing else.
//
// Coordinates: the angle a_i of every rod from the upright, positive towards the archer (away from
// -x sine), upper limb first; then x, y of the string's middle (the serving); then x of the arrow's
// nock. With rods of length s, masses m_i and moments I_i about their middles, a limb has the
// kinetic energy 1/2 sum_jk c_jk cos(a_j - a_k) a_j' a_k' with
//   c_jk = s^2 (m_max(j,k) / 2 + what is beyond it)  for j != k,   c_jj = s^2 (m_j / 4 + what is beyond j) + I_j,
// and moves by  sum_k c_jk (cos(a_j - a_k) a_k'' + sin(a_j - a_k) a_k'^2) = -dV/da_j - losses.

#include <vector>

#include <Eigen/Core>

#include "scenes/scene.h"

namespace sheave::test {

class BowModel {
 public:
  /// Reads lengths, masses, stiffnesses, losses and the string from the scene.
  explicit BowModel(const Scene& scene);

  struct Draw {
    double force = 0.0;          ///< with which the string pulls the serving towards the target [N]
    double energy = 0.0;         ///< of limbs, string and gravity [J]
    double upper_tension = 0.0;  ///< of the string's halves [N]
    double lower_tension = 0.0;
  };
  /// In balance with the serving held at x [m]; continues from the draw before, so go in small
  /// steps.
  Draw hold(double x);

  struct Shot {
    double exit_speed = 0.0;       ///< of the arrow when it has left the string for good [m/s]
    double time = 0.0;             ///< from the release until then [s]
    double largest_tension = 0.0;  ///< of the string, later too [N]
    double losses = 0.0;           ///< to damping in limbs and string until the end [J]
    double energy_error = 0.0;     ///< of the balance of energy at the end [J]
  };
  /// Lets go from the draw held last and follows bow and arrow for `duration` with steps of `step`
  /// [s].
  [[nodiscard]] Shot loose(double duration, double step) const;

  /// x of the serving in the scene at time 0, the braced bow [m].
  [[nodiscard]] double braced_x() const { return braced_x_; }

 private:
  enum class Nock { pushed, held, free };
  struct String {
    double tension = 0.0, damping_tension = 0.0, length = 0.0;
    Eigen::Vector2d pull = Eigen::Vector2d::Zero();  // unit vector from serving to tip
  };
  using Vector = Eigen::VectorXd;

  [[nodiscard]] Eigen::Vector2d tip(const Vector& q, int limb) const;
  [[nodiscard]] Eigen::Vector2d tip_velocity(const Vector& q, const Vector& v, int limb) const;
  [[nodiscard]] String string(const Vector& q, const Vector& v, int limb) const;
  [[nodiscard]] Vector force(const Vector& q, const Vector& v, double arrow_weight) const;
  [[nodiscard]] Vector held_force(const Vector& q) const;
  /// What the string carries of an arrow without a rest: a rod on one hinge starts to fall with the
  /// centre's acceleration 3/4 g, so a quarter of its weight, and a quarter of its mass moves with
  /// the string.
  [[nodiscard]] double flying_weight() const { return 0.25 * gravity_ * arrow_; }
  [[nodiscard]] Vector acceleration(const Vector& q, const Vector& v, Nock nock) const;
  [[nodiscard]] double grip(const Vector& q) const;
  [[nodiscard]] double energy(const Vector& q, const Vector& v) const;
  [[nodiscard]] double loss_rate(const Vector& q, const Vector& v) const;
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Vector& q, int limb) const;
  void runge_kutta(Vector& q, Vector& v, Nock nock, double h) const;

  int rods_ = 0;                                              // per limb
  double rod_ = 0.0;                                          // length of a rod [m]
  double root_ = 0.0;                                         // height of the first hinge [m]
  double gravity_ = 0.0;                                      // [m/s2]
  std::vector<double> mass_, inertia_, stiffness_, damping_;  // per rod or hinge of one limb
  double string_length_ = 0.0, string_stiffness_ = 0.0, string_damping_ = 0.0;  // of one half
  double serving_ = 0.0, arrow_ = 0.0;                                          // masses [kg]
  double grip_compliance_ = 0.0, grip_strength_ = 0.0;
  double braced_x_ = 0.0, fingers_y_ = 0.0, cord_ = 0.0;  // cord between fingers and serving [m]
  double rest_x_ = 0.0, arrow_middle_ = 0.0;  // arrow's centre of mass before the serving [m]
  Vector q_;
};

}  // namespace sheave::test
