#pragma once
// A constraint is a set of scalar rows, the only form of constraint that solvers know.
//
// A row is C(x) with C = 0 (bilateral) or C >= 0 (unilateral), its gradient per touched body, and
// bounds on its multiplier. With substep h, compliance a~ = a / h^2 and the accumulated multiplier
// l, one step of XPBD (Macklin et al. 2016, eq. 18; damping eq. 26) is
//
//   dl = (-C - a~ l - g C') / ((1 + g) w + a~),   w = grad C  W  grad C^T,   g = a b / h,
//   C' = grad C (x - x_start), or C for a unilateral row that was free at the start,
//   l <- l + dl, clamped to the bounds;  x <- x + W grad C^T dl  with the clamped dl.
//
// l has the unit of C times kg (m kg for lengths). The generalised force of the row is l / h^2,
// along +grad C. A cable pulls: its row is C = rest length - length with l in [0, inf), and the
// tension [N] is l / h^2.

#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/vector.h"

namespace sheave {

/// A body during a substep. Constraint solving touches no other data of bodies.
struct MovingBody {
  Vector3 position = Vector3::Zero();  ///< of the centre of mass [m]
  /// Own frame to world frame. A body that does not track its orientation (a rotor on a fixed axle,
  /// because few rows need the orientation of one) has here that of the start of the substep;
  /// Substep::orientation() computes the present one.
  Quaternion orientation = Quaternion::Identity();
  /// Rotation since the start of the substep [rad], as the sum of all rotation vectors applied,
  /// with whole turns: a wheel may turn several times in one substep.
  Vector3 turn = Vector3::Zero();
  /// The rotation axis of a body that has only one: the normal of a planar body, the axle of a
  /// rotor (for a mounted rotor as of the last update of its inverse inertia). Unit vector, world
  /// frame.
  Vector3 axis = Vector3::Zero();
  /// Inverse mass and inertia along each of the body's degrees of freedom [1/kg], [1/(kg m2)]. A
  /// free body with unequal moments of inertia has only `inverse_inertia`.
  double linear_yield = 0.0;
  double angular_yield = 0.0;
  Matrix3 inverse_mass = Matrix3::Zero();     ///< [1/kg], world frame
  Matrix3 inverse_inertia = Matrix3::Zero();  ///< [1/(kg m2)], world frame
  bool translates = false;                    ///< inverse_mass is not zero
  bool rotates = false;                       ///< inverse_inertia is not zero
  bool prescribed = false;                   ///< moves as a function of time; no force changes that
  bool tracks_orientation = true;            ///< `orientation` follows every correction
  Vector3 start_position = Vector3::Zero();  ///< position at the start of the substep [m]
  Vector3 free_position = Vector3::Zero();   ///< position of the motion without constraints [m]
  /// `orientation` of the motion without constraints
  Quaternion free_orientation = Quaternion::Identity();
  Vector3 free_turn = Vector3::Zero();  ///< `turn` of the motion without constraints [rad]

  /// Corrects the rotation by a rotation vector [rad]. The orientation is that of the free motion
  /// turned by the sum c of all corrections, exp(c) q*, not by the corrections one after the other.
  /// Velocities follow from the sum c, and rotations do not commute. Sweeps that turn a slender
  /// body to and fro about several axes would leave a sum, and so a velocity, without a rotation.
  /// The velocity would grow from substep to substep.
  [[gnu::always_inline]] void rotate(const Vector3& correction) { rotate_to(turn + correction); }
  /// Sets the rotation since the start of the substep [rad], whatever it was before.
  [[gnu::always_inline]] void rotate_to(const Vector3& whole) {
    turn = whole;
    if (tracks_orientation) orientation = turned(free_orientation, turn - free_turn);
  }
};

/// Gradient of a row with respect to one body.
struct RowTerm {
  int body = 0;                       ///< index into the bodies of the substep
  Vector3 linear = Vector3::Zero();   ///< dC / d position
  Vector3 angular = Vector3::Zero();  ///< dC / d rotation vector, world frame
  /// For a force n at the arm r from the body's centre: r . n [m], which the gradient does not
  /// contain. Only for curved rows.
  double reach = 0.0;
};

struct Row;

/// The numbers of a row besides its gradient. Members whose default is 0 come first, because every
/// row of every round begins with the defaults: a few wide stores set them.
struct RowSettings {
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  double value = 0.0;       ///< C [m or rad]
  double rate = 0.0;        ///< partial derivative of C by time: a feed [m/s or rad/s]
  double compliance = 0.0;  ///< a [m/N or rad/(N m)], >= 0
  double damping = 0.0;     ///< b [N s/m or N m s/rad], >= 0; acts only with compliance > 0
  // The following members, but for `term_count`, `lower` and `upper`, serve solvers of all rows at
  // once.
  /// Regularisation, added to the row's effective inverse mass w [1/kg], >= 0: shares a load among
  /// redundant rows. A softness stores no energy, unlike a compliance; the row's residual is
  /// softness x l.
  double softness = 0.0;
  /// Share, 0 ... 1, of the row's rate that the damper removes if no other force acts, for a
  /// compliant row whose damper `rattle` applies to the velocities at the end of the substep.
  double settling = 0.0;
  /// For a friction row, whose bounds are +- `friction` times the multiplier of the row
  /// `pressed_by` places before it [1, or m if the row is an angle].
  double friction = 0.0;
  /// The value of a damped row from which its damper measures: that at the start of the substep, if
  /// the row shares an unknown (engine/solvers/row_system.h) or `has_past`.
  double past = 0.0;
  /// For a curved row between two points: 1 / distance of the points, by which its direction turns
  /// [1/m]; 0 if the direction is constant.
  double turning = 0.0;
  /// The row of which this one is a copy (engine/row_list.h), or null. All copies of one edition
  /// have the same bodies, gradient and weights, and their bodies have the same inverse masses.
  const Row* source = nullptr;
  std::uint32_t edition = 0;
  int term_count = 0;  ///< number of touched bodies
  int index = 0;       ///< index of the multiplier among those of the row's feature
  int pressed_by = 0;
  /// Places back to a second pressing row, whose multiplier adds to that of the first; 0: there is
  /// none.
  int pressed_also = 0;
  /// For friction in several directions: the number of its rows, 2 or 3, in the first of them, and
  /// 0 in the others. The rows are adjacent, touch the same bodies in the same order, have
  /// perpendicular directions and share their bounds, which limit the norm of the multipliers:
  /// friction_rows.h.
  int shares = 0;
  bool active = false;  ///< whether the multiplier was off its bounds in the last substep
  /// Whether the row shares one unknown with the row before it (several rows can form a chain). The
  /// values of the rows are added, and the multiplier of each row is its `weight` times the
  /// unknown. The bounds of the first row hold.
  bool tied = false;
  /// Whether the row's force decides which links stick or slip. If such a row is redundant, its
  /// load stays near that of the last round, and is not reduced to the least sufficient force
  /// (engine/solvers/row_sharing.cpp).
  bool judged = false;
  /// Whether the gradient turns with the bodies according to engine/solvers/curvature.h. A row
  /// whose gradient turns while this is false costs additional rounds.
  bool curved = false;
  /// Whether the gradient, and its turning according to `curved`, are the only causes of changes of
  /// the row's value. For a free body this leaves out half the product of its correction since the
  /// prediction and its next rotation, because rotations in space do not commute
  /// (MovingBody::rotate()).
  bool told = false;
  /// Whether the gradient and the force per multiplier are approximations: only the row's value,
  /// and the sum of all forces, are exact at the linearisation. Newton's method converges anyway;
  /// whoever needs derivatives takes differences (statics/refined_rows.h).
  bool approximate = false;
  /// Whether the damper acts on value - `past`, and not on the motion along the gradient: cable that
  /// passes an end brings a strain of its own.
  bool has_past = false;
  /// Whether no touched body can yield to the row, which only pulls. The multiplier of such a row
  /// would have no effect and is kept at 0.
  bool idle = false;
  /// Whether the row is the inertia of a mass 1 / softness: its force is minus the rate of the
  /// momentum along the row. An impact changes this momentum, too.
  bool inertial = false;
  /// Whether the row is the normal row of a contact. If it was open at the start of a substep of
  /// `rattle`, the contact acts along the gradients of the end.
  bool contact = false;
  double lower = -unbounded;  ///< bounds of the multiplier: force x h^2
  double upper = unbounded;
  /// If the row closes faster than this at the end of a substep of `rattle`, it rebounds in the
  /// next substep [m/s]; the closing velocity is therefore kept.
  double rebound_speed = unbounded;
  /// Length that a unit of C stands for [m]: 1 for lengths, about the size of the bodies for
  /// angles. Makes residuals of both kinds comparable.
  double lever = 1.0;
  double weight = 1.0;        ///< > 0
  double start_weight = 1.0;  ///< weight at the start of the substep; used by `rattle`
};

/// One scalar constraint, linearised at the current positions.
struct Row : RowSettings {
  static constexpr int max_terms = 4;  ///< two ends, each on a rotor mounted on a carrier
  std::array<RowTerm, max_terms> terms;

  /// Makes the row empty: no terms, rigid, bilateral, value 0.
  void clear() { static_cast<RowSettings&>(*this) = RowSettings{}; }
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
  /// Whether the row is unilateral and on its free side.
  [[nodiscard]] bool is_free() const {
    return (lower == 0.0 && value > 0.0) || (upper == 0.0 && value < 0.0);
  }
  [[nodiscard]] std::span<const RowTerm> active_terms() const {
    return {terms.data(), static_cast<std::size_t>(term_count)};
  }
};

/// W grad C^T of one row, body by body: the motion of its bodies per unit multiplier.
struct RowResponse {
  std::array<Vector3, Row::max_terms> linear;   ///< [m per unit]
  std::array<Vector3, Row::max_terms> angular;  ///< [rad per unit]
  std::array<bool, Row::max_terms> turns{};     ///< whether `angular` can differ from 0
  double inverse_mass = 0.0;  ///< w = grad C W grad C^T [1/kg]: effective inverse mass
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
    // A load that hangs by its centre of mass is common and needs no angular part.
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

/// grad C (x - x_start): change of the row's value in the substep so far, to first order.
[[nodiscard]] inline double substep_change(const Row& row, std::span<const MovingBody> bodies) {
  double change = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    const MovingBody& body = bodies[static_cast<std::size_t>(term.body)];
    change += dot(term.linear, body.position - body.start_position) + dot(term.angular, body.turn);
  }
  return change;
}

/// The part of substep_change() on which the row's damper acts. A unilateral row that was free at
/// the start counts from its closing, so no damper acts on a free row.
[[nodiscard]] inline double damped_change(const Row& row, std::span<const MovingBody> bodies) {
  if (row.has_past) return row.value - row.past;
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
/// `multiplier`. Returns the magnitude of the row's residual before the step, as far as the bounds
/// allowed its correction [m or rad].
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
  // No body can move. A spring between driven bodies keeps its force, and so does a row with a
  // prescribed force between immovable bodies.
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
