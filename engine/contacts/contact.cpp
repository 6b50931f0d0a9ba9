// An impact within a substep. The gap starts at c with the rate w and the acceleration a of bodies
// without constraints. The gap closes after
//   T = 2 c / (|w| + |w_i|)  with  w_i^2 = w^2 - 2 a c.
// With restitution e, the gap at the end of the substep h is
//   target = e |w_i| (h - T) + a (h - T)^2 / 2,   and grows at  e |w_i| + a (h - T).
// The height to which a ball rebounds therefore does not depend on when in a substep it meets the
// floor. With `xpbd` a body's velocity is the mean over a substep, so w is that velocity plus a h /
// 2. These formulas determine positions; for velocities the approach at the end is used
// (rebound.cpp). Bodies that touch at the end of a substep, and approach, rebound in the next one;
// `rattle`, which has the velocities of the end, must not stop them before. Bodies that meet at
// less than 2 |a| h do not rebound; otherwise their rebounds would never end.
//
// Tangents. Friction of a sliding point acts against the slip and not across it, so the point has
// one row, along its velocity at the start. (A second row would keep the slip in that direction.) A
// point that sticks, or is slow enough to stop, has two rows, which bound the norm of the force
// (engine/friction_rows.h). The first is along the static friction of the whole manifold, the
// direction in which slip will begin.
//
// A compliant contact is a spring of compliance a with a damper b = 2 z / sqrt(a w) in parallel;
// the sum of their forces never pulls. With the effective inverse mass w of the point, the damping
// ratio is z. The body leaves at e times the speed of arrival, at the time when the force of spring
// and damper is 0. With cos c = z,
//   e = exp(-(z / sin c) atan2(sin 2c, cos 2c)).
// z follows from the restitution e, but is at most 1, which is critical and leaves e^-2 of the
// speed. `xpbd` treats the damper as any other (engine/row.h). `rattle` divides the damper in two,
// so that a substep h of any length reduces the area in phase space by the exact factor e^(-2 z
// omega h) with omega^2 = w / a, and with it the amplitude. The midpoint rule with a damper b1 = s
// h / 2a reduces the area by
//   D = (1 + k (1 - s) / 4) / (1 + k (1 + s) / 4),  k = omega^2 h^2,
// and a factor on the velocity at the end does the rest. s is chosen such that log D is half of the
// whole, but at most 1, which is the spring of implicit Euler. With a damper at the end alone, a
// spring that is much faster than the substep would oscillate for ever, because the midpoint rule
// reverses it in each substep. With a damper within the rule alone, its velocity would not decay.
//
// A rigid contact that overlaps at the start opens by 2 % of the overlap per substep only. Opening
// all of it at once would leave a velocity, and so energy from nowhere. A contact that rebounds
// does so from its present position (c = 0 above), and the rebound opens it.

#include "engine/contacts/contact.h"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr double opened_share = 0.02;
/// An approach by less than this share of the scene's size per substep is rounding, and no impact.
/// (Without it, balls that hang side by side would rebound in every substep, which `rattle` would
/// leave to `xpbd`.)
constexpr double least_approach = 1e-12;
/// Softness of a normal row relative to the row's effective inverse mass, for solvers of all rows.
/// The softness shares the load between the corners of a box, which four rows hold where three are
/// sufficient. Contacts sink by this share of the displacement that the load would cause in a
/// substep without the contact.
constexpr double softened_share = 1e-9;
/// The softness is increased where contacts would sink less than `least_sink` times the scene's
/// size, a thousand times the rounding error of a gap. With less, rounding would share the load,
/// differently in each round. Friction at corners that carry little would then change from round to
/// round without end.
constexpr double least_sink = 1e-11;
constexpr double most_softened = 1e-6;
/// Softness of friction rows, which are redundant far more often than normal rows: a taut rope over
/// a wheel sticks at many points to one rigid body. With less, rounding decides which of them slip,
/// and the search for the active set becomes long (373 changes per substep for a rope of 100
/// segments, 61 with this value, 10 with a hundred times as much). With more, a box on a slope
/// creeps by more than 1e-9 m/s.
constexpr double softened_friction = 1e-7;
/// The softness is increased where a point at its bound would give by less than `least_give` times
/// the scene's size, thousands of times the rounding error of a slip. With less, rounding divides
/// the friction between the points of a body that stands, and the division drifts from substep to
/// substep until some points are at their bounds although the body needs less.
constexpr double least_give = 1e-12;
constexpr double most_softened_friction = 1e-3;
/// A point at its friction bound slides only if it moves. A point beside others that stick may only
/// move by their softness, which can be `most_beside` times its own. The threshold is 1e-5 of the
/// displacement by which friction slows a sliding point in a substep. Where the softness is
/// increased, the threshold is at most `most_held` of that displacement, or `least_beside` softnesses.
constexpr double most_beside = 100.0;
constexpr double least_beside = 3.0;
constexpr double most_held = 3e-3;

/// Rotation of a body since the start of the substep [rad]; a mounted rotor adds its own about its
/// axle.
Vector3 turn_of(const Substep& substep, int body) {
  const int mount = substep.bodies[body].mount;
  const Vector3& own = substep.moving[at(body)].turn;
  if (mount < 0) return own;
  const MovingBody& carrier = substep.moving[at(mount)];
  const Vector3 axis = carrier.orientation * substep.bodies[body].axis;
  return carrier.turn + axis * dot(axis, own - carrier.turn);
}

void choose_tangents(const Vector3& sliding, Contact& contact) {
  const Vector3 along = sliding - contact.normal * dot(contact.normal, sliding);
  if (contact.plane_axis) {
    const Vector3 tangent = cross(*contact.plane_axis, contact.normal);
    contact.tangents[0] = dot(tangent, along) < 0.0 ? Vector3(-tangent) : tangent;
    contact.tangents[1] = *contact.plane_axis;
    return;
  }
  const double length = along.norm();
  contact.tangents[0] =
      length > 1e-9 * sliding.norm() ? Vector3(along / length) : any_perpendicular(contact.normal);
  contact.tangents[1] = cross(contact.normal, contact.tangents[0]);
}

/// Softness of a friction row relative to its effective inverse mass. `slowed`: the acceleration by
/// which friction slows the point [m/s2].
double friction_softness(const Substep& substep, double slowed) {
  const double way = substep.h * substep.h * slowed;
  if (!(way > 0.0)) return softened_friction;
  return std::clamp(least_give * substep.bodies.scale() / way, softened_friction,
                    most_softened_friction);
}

/// Effective inverse mass w of the row along the first tangent [1/kg].
double tangent_yield(const Substep& substep, const Contact& contact) {
  Row row;
  RowResponse response;
  contact.evaluate(substep, 1, row);
  respond(row, substep.moving, response);
  return response.inverse_mass;
}

void meet(const Substep& substep, double restitution, double rate, double acceleration,
          Contact& contact) {
  const double h = substep.h;
  const double slowest = std::max(slow_impact * std::abs(acceleration) * h,
                                  least_approach * substep.bodies.scale() / h);
  contact.rebound_speed = slowest;
  const double shift = contact.mean_velocities ? 0.5 * h * acceleration : 0.0;
  const double closing = -(rate + shift);
  const double gap = std::max(contact.start_gap, 0.0);
  const double square = closing * closing - 2.0 * acceleration * gap;
  if (!(closing > 0.0) || !(square > 0.0)) return;
  const double impact = std::sqrt(square);
  const double left = h - 2.0 * gap / (closing + impact);
  if (!(left > 0.0) || impact <= slowest) return;
  const double way = left * (restitution * impact + 0.5 * acceleration * left);
  const double rebound = restitution * impact + acceleration * left;
  if (!(way >= 0.0) || !(rebound > 0.0)) return;
  contact.target =
      contact.start_gap < 0.0 ? std::max(contact.target, contact.start_gap + way) : way;
  contact.rebound = rebound;
  contact.rebound_speed = Row::unbounded;
  contact.restitution = restitution;
  contact.acceleration = acceleration;
}

/// Sets the damper of a contact; `yield` is the effective inverse mass along the normal [1/kg].
void damp(const Substep& substep, const ContactMaterial& material, double yield, Contact& contact) {
  contact.damping = contact.settling = 0.0;
  const double ratio = material.damping_ratio;
  if (!(material.compliance > 0.0) || !(yield > 0.0) || !(ratio > 0.0)) return;
  if (substep.load_share == 1.0) {
    contact.damping = 2.0 * ratio / std::sqrt(material.compliance * yield);
    return;
  }
  const double h = substep.h;
  const double quarter = 0.25 * h * h * yield / material.compliance;  // k / 4
  const double half = 2.0 * ratio * std::sqrt(quarter);               // z omega h
  const double kept = portable::exp(-half);
  const double share =
      std::min(1.0, -portable::expm1(-half) * (1.0 + quarter) / (quarter * (1.0 + kept)));
  const double area = (1.0 + quarter * (1.0 - share)) / (1.0 + quarter * (1.0 + share));
  contact.damping = 0.5 * share * h / material.compliance;
  contact.settling = std::max(0.0, 1.0 - kept * kept / area);
}

}  // namespace

Vector3 start_velocity(const Substep& substep, int body, const Vector3& point) {
  const BodyState& state = substep.start.bodies[at(body)];
  return state.velocity + cross(state.angular_velocity, point - state.position);
}

double start_rate(const Substep& substep, const Contact& contact) {
  const Vector3 surface_a = contact.start_a - contact.radius_a * contact.normal;
  const Vector3 surface_b = contact.start_b + contact.radius_b * contact.normal;
  return dot(contact.normal, start_velocity(substep, contact.body_a, surface_a) -
                                 start_velocity(substep, contact.body_b, surface_b));
}

bool can_pass(const Substep& substep, const ContactMaterial& material, const Vector3& pull,
              const ContactTimes& times, Contact& contact) {
  if (!(material.restitution > 0.0 || times.all) || material.compliance > 0.0) return false;
  const double acceleration = dot(contact.normal, pull);
  const double closing = -start_rate(substep, contact);
  constexpr double least_way = 1e-9;  // of the scene's size
  if (!(closing > std::abs(acceleration) * times.substep) ||
      !(closing * times.substep > least_way * substep.bodies.scale()) ||
      !(contact.start_gap >= -2.0 * times.slop * closing)) {
    return false;
  }
  contact.passes = true;
  contact.closing = closing;
  contact.acceleration = acceleration;
  contact.restitution = material.restitution;
  return true;
}

void prepare_contact(const Substep& substep, const ContactMaterial& material,
                     const Vector3& free_acceleration, const Vector3& held, double pressure,
                     bool is_new, Contact& contact) {
  const double h = substep.h;
  const Vector3 surface_a = contact.start_a - contact.radius_a * contact.normal;
  const Vector3 surface_b = contact.start_b + contact.radius_b * contact.normal;
  const Vector3 velocity = start_velocity(substep, contact.body_a, surface_a) -
                           start_velocity(substep, contact.body_b, surface_b);
  const double rate = dot(contact.normal, velocity);
  const Vector3 sliding = velocity - rate * contact.normal;
  contact.compliance = material.compliance;
  if (material.friction > 0.0 || material.static_friction > 0.0) {
    // Friction can stop the point within the substep up to this speed.
    choose_tangents(sliding.norm() > 0.0 ? sliding : free_acceleration, contact);
    const double pressing =
        std::max(pressure * tangent_yield(substep, contact), free_acceleration.norm());
    const double stoppable = h * material.friction * pressing;
    const bool slow = sliding.norm() <= stoppable;
    if (is_new) contact.stuck = slow;
    // A search for equilibrium passes poses between which nothing slides.
    if (substep.at_rest) contact.stuck = true;
    contact.rows = slow && !contact.plane_axis ? 3 : 2;
    // A velocity far below this speed consists mainly of rounding errors.
    if (contact.stuck || sliding.norm() <= 0.01 * stoppable) {
      choose_tangents(held.squaredNorm() > 0.0 ? Vector3(-held) : free_acceleration, contact);
    }
    contact.friction = contact.stuck ? material.static_friction : material.friction;
    contact.sliding_friction = material.friction;
  }
  contact.target = 0.0;
  if (material.compliance == 0.0) {
    // A search for equilibrium begins each iteration where the last one has ended.
    if (contact.start_gap < 0.0 && !substep.at_rest) {
      contact.target = (1.0 - opened_share) * contact.start_gap;
    }
    if (material.restitution > 0.0) {
      meet(substep, material.restitution, rate, dot(contact.normal, free_acceleration), contact);
    }
  }
  Row row;
  RowResponse response;
  for (int i = 0; i < contact.rows; ++i) {
    row.clear();
    contact.evaluate(substep, i, row);
    respond(row, substep.moving, response);
    const double pushed = std::max(pressure * response.inverse_mass, free_acceleration.norm());
    const double share =
        i == 0
            ? std::clamp(least_sink * substep.bodies.scale() / (h * (std::abs(rate) + h * pushed)),
                         softened_share, most_softened)
            : friction_softness(substep, contact.friction * pushed);
    contact.softness[at(i)] = share * response.inverse_mass;
    if (i > 0) {
      contact.let_go = std::clamp(most_held / share, least_beside, most_beside);
      continue;
    }
    // A compliance shares the load by itself, so only the missing part is added as softness.
    const double own = material.compliance / (h * h);
    contact.softness[0] = std::max(contact.softness[0] - own, 0.0);
    damp(substep, material, response.inverse_mass, contact);
  }
}

double Contact::gap(const Substep& substep) const {
  return dot(normal, substep.point(body_a, own_a) - substep.point(body_b, own_b)) - radius_a -
         radius_b;
}

Vector3 Contact::slip(const Substep& substep) const {
  const Vector3 path_a =
      substep.point(body_a, own_a) - start_a - radius_a * cross(turn_of(substep, body_a), normal);
  const Vector3 path_b =
      substep.point(body_b, own_b) - start_b + radius_b * cross(turn_of(substep, body_b), normal);
  return slipped + path_a - path_b;
}

Vector3 Contact::held(const Vector3& all) const {
  if (rows == 2) return tangents[0] * dot(tangents[0], all);
  return all - normal * dot(normal, all);
}

double Contact::yielding(const Substep& substep) const {
  const double bound = substep.load_share * friction * pressed;
  return std::max(softness[1], softness[2]) * bound;
}

bool Contact::moves(const Substep& substep) const {
  return held(slip(substep) - slipped).norm() > let_go * yielding(substep);
}

bool Contact::moves_on(const Substep& substep) const {
  const auto velocity = [&](int body, const Vector3& point) {
    const BodyState& state = substep.next.bodies[at(body)];
    return Vector3(state.velocity + cross(state.angular_velocity, point - state.position));
  };
  const Vector3 surface_a = substep.point(body_a, own_a) - radius_a * normal;
  const Vector3 surface_b = substep.point(body_b, own_b) + radius_b * normal;
  const Vector3 sliding = velocity(body_a, surface_a) - velocity(body_b, surface_b);
  return substep.h * held(sliding).norm() > let_go * yielding(substep);
}

void Contact::evaluate(const Substep& substep, int index, Row& row) const {
  const Vector3 surface_a = substep.point(body_a, own_a) - radius_a * normal;
  const Vector3 surface_b = substep.point(body_b, own_b) + radius_b * normal;
  row.softness = softness[at(index)];
  if (index == 0) {
    row.value = dot(normal, surface_a - surface_b) - target;
    row.compliance = compliance;
    row.damping = damping;
    row.settling = settling;
    row.lower = 0.0;
    row.contact = true;
    row.rebound_speed = rebound_speed;
    substep.add_force(row, body_a, surface_a, normal);
    substep.add_force(row, body_b, surface_b, -normal);
    return;
  }
  const Vector3& tangent = tangents[at(index - 1)];
  row.value = dot(tangent, slip(substep));
  row.friction = friction;
  row.pressed_by = index;
  if (index == 1 && rows == 3) row.shares = 2;
  row.upper = friction * pressed;
  row.lower = -row.upper;
  substep.add_force(row, body_a, surface_a, tangent);
  substep.add_force(row, body_b, surface_b, -tangent);
}

}  // namespace sheave
