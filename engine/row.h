#pragma once
// A constraint is a set of scalar rows, and solvers know nothing else.
//
// A row is C(x) with C = 0 (bilateral) or C >= 0 (unilateral), its gradient per touched body, and
// bounds on its multiplier. With substep h, compliance a~ = a / h^2 and the accumulated multiplier
// l, one step of XPBD (Macklin et al. 2016, eq. 18; damping eq. 26) is
//
//   dl = (-C - a~ l - g C') / ((1 + g) w + a~),   w = grad C  W  grad C^T,   g = a b / h,
//   C' = grad C (x - x_start), or C of a one-sided row that was free at the start,
//   l <- l + dl, clamped to the bounds;  x <- x + W grad C^T dl  with what is left of dl.
//
// l has the unit of C times kg (m kg for lengths); the generalised force of the row is l / h^2,
// along +grad C. So a cable, which pulls, has C = rest length - length and l in [0, inf), and its
// tension [N] is l / h^2.

#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/vector.h"

namespace sheave {

/// A body during a substep: the only body data that constraint solving touches.
struct MovingBody {
  Vector3 position = Vector3::Zero();  ///< of the centre of mass [m]
  /// Own frame to world frame. Of a body that does not track it (a rotor on a fixed axle, which
  /// most rows never ask for its orientation) at the start of the substep; Substep::orientation()
  /// then computes the current one.
  Quaternion orientation = Quaternion::Identity();
  /// Rotation since the start of the substep [rad], as the sum of all rotation vectors applied. It
  /// is not wrapped: a wheel may turn several times in one substep.
  Vector3 turn = Vector3::Zero();
  /// What it turns about, if that is one axis alone: the normal of a planar body, the axle of a
  /// rotor (of a mounted one as it was when its inverse inertia was taken). Unit vector, world
  /// frame.
  Vector3 axis = Vector3::Zero();
  /// What its inverse mass and inertia are along each of its degrees of freedom [1/kg], [1/(kg
  /// m2)]. Of a free body with unequal moments of inertia only `inverse_inertia` tells.
  double linear_yield = 0.0;
  double angular_yield = 0.0;
  Matrix3 inverse_mass = Matrix3::Zero();     ///< [1/kg], world frame
  Matrix3 inverse_inertia = Matrix3::Zero();  ///< [1/(kg m2)], world frame
  bool translates = false;                    ///< inverse_mass is not zero
  bool rotates = false;                       ///< inverse_inertia is not zero
  bool prescribed = false;                    ///< moves as a function of time, whatever pulls at it
  bool tracks_orientation = true;             ///< `orientation` follows every correction
  Vector3 start_position = Vector3::Zero();   ///< position at the start of the substep [m]
  Quaternion free_orientation = Quaternion::Identity();  ///< `orientation` of the free motion
  Vector3 free_turn = Vector3::Zero();                   ///< `turn` of the free motion [rad]

  /// Corrects the rotation by a rotation vector [rad]. The orientation is that of the free motion
  /// turned by the sum c of all corrections, exp(c) q*, and not by one after the other: velocities
  /// follow from that sum, and rotations do not commute, so that sweeps which turn a slender body
  /// to and fro about several axes would leave a sum, and with it a velocity, where there is no
  /// motion. That feeds on itself.
  [[gnu::always_inline]] void rotate(const Vector3& correction) {
    turn += correction;
    if (tracks_orientation) orientation = turned(free_orientation, turn - free_turn);
  }
};

/// Gradient of a row with respect to one body.
struct RowTerm {
  int body = 0;                       ///< index into the bodies of the substep
  Vector3 linear = Vector3::Zero();   ///< dC / d position
  Vector3 angular = Vector3::Zero();  ///< dC / d rotation vector, world frame
  /// Of a force n at the arm r from the body's centre: r . n, which the gradient does not tell [m].
  /// Only of curved rows.
  double reach = 0.0;
};

/// One scalar constraint, linearised at the current positions.
struct Row {
  static constexpr int max_terms = 4;  ///< two ends, each on a rotor mounted on a carrier
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  double value = 0.0;         ///< C [m or rad]
  double rate = 0.0;          ///< change of C with time at rest: a feed [m/s or rad/s]
  double compliance = 0.0;    ///< a [m/N or rad/(N m)], >= 0
  double damping = 0.0;       ///< b [N s/m or N m s/rad], >= 0; acts only with compliance > 0
  double lower = -unbounded;  ///< bounds of the multiplier: force x h^2
  double upper = unbounded;
  int term_count = 0;
  std::array<RowTerm, max_terms> terms;
  // Only solvers of all rows at once need these.
  /// Added to the row's yield w [1/kg], >= 0: shares a load among rows of which fewer would do.
  /// Unlike a compliance it is no spring; the multiplier l leaves the row off by softness x l.
  double softness = 0.0;
  /// Of a row with compliance whose damper `rattle` lets act on the velocities at the end of the
  /// substep: the share of its rate that the damper takes if nothing else does, 0 ... 1.
  double settling = 0.0;
  /// What slips and what holds is judged by its force: where it is redundant, rows do not go back
  /// to the least forces that will do, but stay near the last round's
  /// (engine/solvers/row_sharing.cpp).
  bool judged = false;
  /// A row that closes faster than this at the end of a substep of `rattle` rebounds in the next
  /// one [m/s]: its velocity is not stopped.
  double rebound_speed = unbounded;
  /// Of a row of friction, whose bounds are +- this times the multiplier of the row `pressed_by`
  /// places before it [1, or m if the row is an angle].
  double friction = 0.0;
  int pressed_by = 0;
  /// The same of a second row, whose multiplier is added to that of the first; 0: there is none.
  int pressed_also = 0;
  /// Friction in several directions: of the first of its rows their number, 2 or 3, of the others 0.
  /// They follow each other, touch the same bodies in the same order, are of directions that are
  /// perpendicular to each other, and have the same bounds, which are those of the norm of their
  /// multipliers: friction_rows.h.
  int shares = 0;
  int index = 0;        ///< of its multiplier among those of its feature
  bool active = false;  ///< whether its multiplier was off its bounds in the last substep
  /// Whether it shares one unknown with the row before it, which may do the same: their values are
  /// added, and the multiplier of each is its `weight` times the unknown. Bounds are those of the
  /// first.
  bool tied = false;
  /// Of a damped row that shares an unknown: its value at the start of the substep, from which the
  /// way of its own damper counts (engine/solvers/row_system.h).
  double past = 0.0;
  /// Whether its gradient turns with its bodies as engine/solvers/curvature.h says. If it does so
  /// and does not tell, rounds are more.
  bool curved = false;
  /// Of a curved row between two points: 1 / their distance, by which its direction turns [1/m]; 0
  /// if it never does.
  double turning = 0.0;
  /// Whether its value changes by its gradient, and by how that turns as `curved` tells, and by
  /// nothing else.
  bool told = false;
  /// Whether no body that could yield to it takes part, and its multiplier, which pulls and would
  /// do nothing, is kept at 0.
  bool idle = false;
  /// What a unit of C moves, about [m]: 1 m of lengths, the size of the bodies of angles. Compares
  /// what rows of either kind are off by.
  double lever = 1.0;
  double weight = 1.0;        ///< > 0
  double start_weight = 1.0;  ///< the same at the start of the substep; `rattle` needs it
  /// Null, or what this is a copy of (engine/row_list.h): the same bodies, gradient and weights as
  /// any other copy of the same edition, and these bodies have the same inverse masses.
  const Row* source = nullptr;
  std::uint32_t edition = 0;

  /// Makes the row empty: no terms, rigid, bilateral, value 0.
  void clear() {
    index = pressed_by = pressed_also = shares = 0;
    source = nullptr;
    friction = 0.0;
    active = tied = curved = told = idle = false;
    turning = 0.0;
    weight = start_weight = lever = 1.0;
    softness = settling = 0.0;
    judged = false;
    rebound_speed = unbounded;
    value = rate = compliance = damping = past = 0.0;
    lower = -unbounded;
    upper = unbounded;
    term_count = 0;
  }
  /// Adds to the gradient of `body`. Contributions to the same body are summed, because w needs
  /// the body's whole gradient (a cable that touches one body twice).
  [[gnu::always_inline]] void add(int body, const Vector3& linear, const Vector3& angular,
                                  double reach = 0.0) {
    for (int i = 0; i < term_count; ++i) {
      RowTerm& term = terms[static_cast<std::size_t>(i)];
      if (term.body != body) continue;
      term.linear += linear;
      term.angular += angular;
      term.reach += reach;
      return;
    }
    assert(term_count < max_terms);
    terms[static_cast<std::size_t>(term_count++)] = {body, linear, angular, reach};
  }
  /// Whether it is one-sided and on its free side.
  [[nodiscard]] bool is_free() const {
    return (lower == 0.0 && value > 0.0) || (upper == 0.0 && value < 0.0);
  }
  [[nodiscard]] std::span<const RowTerm> active_terms() const {
    return {terms.data(), static_cast<std::size_t>(term_count)};
  }
};

/// W grad C^T of one row, body by body: how its bodies respond to a unit multiplier.
struct RowResponse {
  std::array<Vector3, Row::max_terms> linear;   ///< [m per unit]
  std::array<Vector3, Row::max_terms> angular;  ///< [rad per unit]
  std::array<bool, Row::max_terms> turns{};     ///< whether `angular` can be other than 0
  double inverse_mass = 0.0;  ///< w = grad C W grad C^T [1/kg]: how easily the row yields
};

/// The response of `row` at the bodies' current inverse masses.
[[gnu::always_inline]] inline void respond(const Row& row, std::span<const MovingBody> bodies,
                                           RowResponse& response) {
  double w = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.term_count); ++i) {
    const RowTerm& term = row.terms[i];
    const MovingBody& body = bodies[static_cast<std::size_t>(term.body)];
    if (body.translates) {
      response.linear[i] = times(body.inverse_mass, term.linear);
      w += dot(term.linear, response.linear[i]);
    }
    // A load that hangs by its centre of mass is common.
    response.turns[i] = body.rotates && !is_zero(term.angular);
    if (response.turns[i]) {
      response.angular[i] = times(body.inverse_inertia, term.angular);
      w += dot(term.angular, response.angular[i]);
    } else {
      response.angular[i] = Vector3::Zero();
    }
  }
  response.inverse_mass = w;
}

/// grad C (x - x_start): change of the row's value over the substep so far, to first order.
[[nodiscard]] inline double substep_change(const Row& row, std::span<const MovingBody> bodies) {
  double change = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    const MovingBody& body = bodies[static_cast<std::size_t>(term.body)];
    change += dot(term.linear, body.position - body.start_position) + dot(term.angular, body.turn);
  }
  return change;
}

/// What of it the row's damper sees: one-sided rows that were free have none before they close, so
/// that none of them acts while it is free.
[[nodiscard]] inline double damped_change(const Row& row, std::span<const MovingBody> bodies) {
  const double change = substep_change(row, bodies);
  const double start = row.value - change;
  const bool was_free = (row.lower == 0.0 && start > 0.0) || (row.upper == 0.0 && start < 0.0);
  return was_free ? row.value : change;
}

/// x <- x + W grad C^T increment.
[[gnu::always_inline]] inline void apply_multiplier(const Row& row, const RowResponse& response,
                                                    double increment,
                                                    std::span<MovingBody> bodies) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.term_count); ++i) {
    MovingBody& body = bodies[static_cast<std::size_t>(row.terms[i].body)];
    if (body.translates) body.position = sum(body.position, increment, response.linear[i]);
    if (response.turns[i]) body.rotate(increment * response.angular[i]);
  }
}

/// One XPBD step of one row with substep `h` [s]; updates the bodies and the accumulated
/// `multiplier`. Returns the magnitude of the row's error before the step, as far as its bounds
/// allowed to correct it [m or rad].
inline double solve_row(const Row& row, double h, double& multiplier,
                        std::span<MovingBody> bodies) {
  const double scaled_compliance = row.compliance / (h * h);
  RowResponse response;
  respond(row, bodies, response);
  double w = response.inverse_mass;
  double error = row.value + scaled_compliance * multiplier;
  if (row.damping > 0.0) {
    const double gamma = row.compliance * row.damping / h;
    error += gamma * damped_change(row, bodies);
    w *= 1.0 + gamma;
  }
  const double denominator = w + scaled_compliance;
  // Nothing that could move; a spring between driven bodies has its force all the same, and so has
  // what is given, against what holds.
  if (!(denominator > 0.0)) {
    if (row.lower == row.upper) multiplier = row.lower;
    return 0.0;
  }
  double next = multiplier - error / denominator;
  if (next < row.lower) next = row.lower;
  if (next > row.upper) next = row.upper;
  const double increment = next - multiplier;
  if (increment == 0.0) return 0.0;
  multiplier = next;
  apply_multiplier(row, response, increment, bodies);
  return std::abs(increment) * denominator;
}

}  // namespace sheave
