#pragma once
// One point of contact during a substep, and its rows.
//
// With core points p_a, p_b fixed to the bodies, the normal n and tangents t fixed for the substep,
// and the slip s that has accumulated while the point sticks, from rounding and softness,
//
//   normal    C = n . (p_a - p_b) - r_a - r_b - target >= 0,       l_n in [0, inf)
//   friction  C = t . (s + d_a - d_b) = 0,                         |l_t| <= mu l_n, norm of both
//             d = change of p + turn x arm,  arm_a = -r_a n,  arm_b = r_b n
//
// d is the path of the surface at the contact. The turn enters as a rotation vector, not as the
// chord of the point, so a ball rolls on its circumference exactly. Gradients are n and t at p_a -
// r_a n and p_b + r_b n; the position along n does not change them. The multipliers are forces
// times h^2.

#include <array>
#include <optional>

#include "engine/contacts/contact_finder.h"
#include "engine/followed_pressure.h"

namespace sheave {

/// Vectors are in the world frame and lengths in m, unless said otherwise.
struct Contact {
  // Settings of the substep.
  FormPair forms;
  int body_a = 0;
  int body_b = 0;
  Vector3 normal = Vector3::UnitY();
  std::array<Vector3, 2> tangents;
  Vector3 own_a = Vector3::Zero();  ///< core points in the bodies' own frames
  Vector3 own_b = Vector3::Zero();
  Vector3 start_a = Vector3::Zero();  ///< core points at the start of the substep
  Vector3 start_b = Vector3::Zero();
  double radius_a = 0.0;
  double radius_b = 0.0;
  double start_gap = 0.0;
  /// Unit normal of the plane to which both bodies are restricted (planar_contact.h)
  std::optional<Vector3> plane_axis;
  Vector3 slipped = Vector3::Zero();  ///< s
  double friction = 0.0;              ///< present coefficient of friction
  /// A point at its bound slides if it moves by more than so many times yielding()
  double let_go = 0.0;
  double sliding_friction = 0.0;  ///< coefficient once the point slides
  double compliance = 0.0;        ///< [m/N]
  double damping = 0.0;           ///< Row::damping [N s/m]
  double settling = 0.0;          ///< Row::settling
  double target = 0.0;            ///< required gap at the end of the substep
  /// Normal velocity after an impact in this substep [m/s]; 0: no impact. Corrected once velocities
  /// are known (rebound.h).
  double rebound = 0.0;
  /// Approach speed above which an impact at the end of the substep is left to the next one [m/s]
  /// (Row::rebound_speed).
  double rebound_speed = Row::unbounded;
  /// Whether velocities are means over the last substep, as with `xpbd`, or those of its end.
  bool mean_velocities = true;
  double restitution = 0.0;
  double acceleration = 0.0;  ///< of the gap, for bodies without constraints [m/s2]
  /// Whether an impact ends the substep: the point then has no rows, and its gap at the end tells
  /// whether the impact has come.
  bool passes = false;
  bool lands = false;                ///< the impact is at the end of this substep
  double closing = 0.0;              ///< speed of approach at the start, if the point passes [m/s]
  std::array<double, 3> softness{};  ///< Row::softness of each row [1/kg]
  // Results of the last substep: forces [N] along the normal and the tangents, and whether the
  // point stuck.
  std::array<double, 3> last_force{};
  bool stuck = true;
  // Results of the solver in this substep.
  double pressed = 0.0;       ///< the l_n that bounds friction
  FollowedPressure pressure;  ///< gives `pressed` from round to round
  double last_change = 0.0;   ///< change of l_n against `pressed` in the last round; 0: none yet
  bool slips = false;
  /// Whether the point slid in the motion of the substep, before impacts changed the velocities
  bool slid = false;

  int rows = 1;  ///< the normal, and friction along the first or both tangents

  [[nodiscard]] double gap(const Substep& substep) const;
  /// The slip s + d_a - d_b.
  [[nodiscard]] Vector3 slip(const Substep& substep) const;
  /// The slip's part along the directions of the friction rows; friction does not act across them.
  [[nodiscard]] Vector3 held_slip(const Substep& substep) const { return held(slip(substep)); }
  /// Whether the surfaces have moved past each other in the substep by more than the softness of
  /// friction allows.
  [[nodiscard]] bool moves(const Substep& substep) const;
  /// The same test for their velocities at the end of the substep.
  [[nodiscard]] bool moves_on(const Substep& substep) const;
  /// The displacement that Row::softness allows at the bound of friction [m].
  [[nodiscard]] double yielding(const Substep& substep) const;
  /// Sets row `index`: 0 is the normal, 1 and 2 are friction along the tangents.
  void evaluate(const Substep& substep, int index, Row& row) const;

 private:
  [[nodiscard]] Vector3 held(const Vector3& all) const;
};

/// Velocity [m/s] of the body's surface at a world point at the start of the substep.
[[nodiscard]] Vector3 start_velocity(const Substep& substep, int body, const Vector3& point);

/// Rate at which the gap changes at the start of the substep [m/s].
[[nodiscard]] double start_rate(const Substep& substep, const Contact& contact);

/// A contact rebounds if its speed is above this multiple of the speed that loads add in a substep.
inline constexpr double slow_impact = 2.0;

/// Lengths of time of a step's settings [s].
struct ContactTimes {
  double substep = 0.0;
  double slop = 0.0;  ///< instant_slop()
  bool all = false;   ///< impacts without restitution, too
};

/// Whether an impact of the contact may be left to the end of a part of the substep; sets the
/// members for it. `pull`: acceleration of A relative to B without constraints [m/s2]. A contact
/// that approaches more slowly than its acceleration makes it in a substep does not rebound.
[[nodiscard]] bool can_pass(const Substep& substep, const ContactMaterial& material,
                            const Vector3& pull, const ContactTimes& times, Contact& contact);

/// Chooses the tangents and the coefficient of friction, and plans impacts. The other members must
/// be set. `held` is the friction on A and `pressure` the normal force [N] of the whole manifold in
/// the last substep.
void prepare_contact(const Substep& substep, const ContactMaterial& material,
                     const Vector3& free_acceleration, const Vector3& held, double pressure,
                     bool is_new, Contact& contact);

}  // namespace sheave
