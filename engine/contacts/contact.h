#pragma once
// One point of contact during a substep, and its rows.
//
// With core points p_a, p_b fixed to the bodies, the normal n and tangents t fixed for the substep,
// and s what friction has let slip at most by rounding since the point began to stick,
//
//   normal    C = n . (p_a - p_b) - r_a - r_b - target >= 0,       l_n in [0, inf)
//   friction  C = t . (s + d_a - d_b) = 0,                         |l_t| <= mu l_n, the norm of both
//             d = change of p + turn x arm,  arm_a = -r_a n,  arm_b = r_b n
//
// d is the path of the surface at the contact. The turn enters with the rotation vector, not with
// the chord of the point, so a ball rolls on its circumference exactly. Gradients are n and t at
// p_a - r_a n and p_b + r_b n; along n the place makes no difference. The multipliers are forces x
// h^2.

#include <array>
#include <optional>

#include "engine/contacts/contact_finder.h"
#include "engine/followed_pressure.h"

namespace sheave {

/// World frame unless said otherwise; lengths in m.
struct Contact {
  // Settings of the substep.
  FormPair forms;
  int body_a = 0;
  int body_b = 0;
  Vector3 normal = Vector3::UnitY();
  std::array<Vector3, 2> tangents;
  Vector3 own_a = Vector3::Zero();  ///< core points in the own frames of the bodies
  Vector3 own_b = Vector3::Zero();
  Vector3 start_a = Vector3::Zero();  ///< core points at the start of the substep
  Vector3 start_b = Vector3::Zero();
  double radius_a = 0.0;
  double radius_b = 0.0;
  double start_gap = 0.0;
  std::optional<Vector3>
      plane_axis;  ///< unit normal of the only plane they move in (planar_contact.h)
  Vector3 slipped = Vector3::Zero();  ///< s
  double friction = 0.0;              ///< coefficient that counts now
  double sliding_friction = 0.0;      ///< what it becomes when the point begins to slide
  double compliance = 0.0;            ///< [m/N]
  double damping = 0.0;               ///< Row::damping [N s/m]
  double settling = 0.0;              ///< Row::settling
  double target = 0.0;                ///< gap at the end of the substep
  /// Normal velocity after an impact in this substep [m/s]; 0: none. Refined when velocities are
  /// known (rebound.h).
  double rebound = 0.0;
  /// Approach above which the end of the substep leaves an impact to the next one [m/s]
  /// (Row::rebound_speed).
  double rebound_speed = Row::unbounded;
  /// Whether velocities are means of the substep before, as those of `xpbd` are, or of the moment.
  bool mean_velocities = true;
  double restitution = 0.0;
  double acceleration = 0.0;         ///< of the gap, for free bodies [m/s2]
  std::array<double, 3> softness{};  ///< Row::softness of each row [1/kg]
  // What the last substep knows: forces [N] along the normal and the tangents, and whether friction
  // held.
  std::array<double, 3> last_force{};
  bool stuck = true;
  // What the solver has found so far.
  double pressed = 0.0;       ///< l_n that bounds friction
  FollowedPressure pressure;  ///< what `pressed` becomes from round to round
  double last_change = 0.0;   ///< of l_n against that, in the last round; 0: none yet
  bool slips = false;
  bool slid = false;  ///< on the way of the substep, whatever velocities have been given since

  int rows = 1;  ///< the normal, and friction along the first or both tangents

  [[nodiscard]] double gap(const Substep& substep) const;
  /// s + d_a - d_b
  [[nodiscard]] Vector3 slip(const Substep& substep) const;
  /// Its part in the directions in which friction acts: it holds nothing across them.
  [[nodiscard]] Vector3 held_slip(const Substep& substep) const { return held(slip(substep)); }
  /// Whether the surfaces have moved past each other in the substep by more than friction that
  /// holds lets them.
  [[nodiscard]] bool moves(const Substep& substep) const;
  /// The same of their velocities at the end of the substep.
  [[nodiscard]] bool moves_on(const Substep& substep) const;
  /// What friction that holds all that it may yields to it by Row::softness [m].
  [[nodiscard]] double yielding(const Substep& substep) const;
  /// Row 0 is the normal, 1 and 2 are friction along the tangents.
  void evaluate(const Substep& substep, int index, Row& row) const;

 private:
  [[nodiscard]] Vector3 held(const Vector3& all) const;
};

/// Velocity [m/s] of the body's surface at a world point at the start of the substep.
[[nodiscard]] Vector3 start_velocity(const Substep& substep, int body, const Vector3& point);

/// `held` and `pressure` are the friction on A and the normal force [N] of the whole manifold in
/// the last substep. Chooses tangents, coefficient of friction and what an impact does; the rest of
/// the contact is set.
void prepare_contact(const Substep& substep, const ContactMaterial& material,
                     const Vector3& free_acceleration, const Vector3& held, double pressure,
                     bool is_new, Contact& contact);

}  // namespace sheave
