// An impact within a substep. The gap starts at c with the rate w and the acceleration a of free
// bodies; it closes after
//   T = 2 c / (|w| + |w_i|)  with  w_i^2 = w^2 - 2 a c,
// and with restitution e it is, at the end of the substep h,
//   target = e |w_i| (h - T) + a (h - T)^2 / 2,   and grows at  e |w_i| + a (h - T).
// So a ball loses nothing of its height by where in a substep it meets the floor. `xpbd` keeps the
// mean velocity of a substep for the velocity of a body, so its w is that plus a h / 2. That
// settles positions; for velocities the approach is taken from the end (rebound.cpp). Bodies that
// touch at the end of a substep, and approach, bounce in the next one: `rattle`, which has the
// velocities of the end, must not stop them before. Bodies that meet at less than 2 |a| h do not
// bounce: they would for ever.
//
// Tangents. What slides has friction against its sliding and none across it, so it has one row,
// along its velocity at the start. (A second one would hold it to that direction.) What is slow
// enough to stop, or sticks, has two, which bound the norm of the force (engine/friction_rows.h). They begin
// with the direction of the force that the whole manifold holds, along which it will slip.
//
// A compliant contact is a spring 1 / a with a damper b = 2 z / sqrt(a w) beside it that together
// never pull: with the yield w of the point a mass 1 / w on it has the damping ratio z. It leaves it
// at e times the speed of meeting, with cos c = z,
//   e = exp(-(z / sin c) atan2(sin 2c, cos 2c)),
// where the force of spring and damper is 0; z is that of the restitution e, but no more than 1, which
// is critical and leaves e^-2 of the speed. `xpbd` has the damper as any other (engine/row.h).
// `rattle` has it in two parts, so that a substep h of any length shrinks the area in phase space by
// as much as it should, e^(-2 z omega h) with omega^2 = w / a, and the swing with it. The midpoint rule
// with a damper b1 = s h / 2a shrinks it by
//   D = (1 + k (1 - s) / 4) / (1 + k (1 + s) / 4),  k = omega^2 h^2,
// and the rest is taken from the velocity at the end. s is such that D is half of the whole, in
// logarithms, but no more than 1, which is implicit Euler's spring. A damper at the end alone would
// leave a spring that is much faster than the substep, which the midpoint rule turns over each time,
// for ever; one within the rule alone its velocity.
//
// A rigid contact that overlaps at the start is opened by a fiftieth per substep only, because the
// velocity that opening it at once would leave behind is energy that nobody has put in. Where it
// bounces it does so at once, from where it is, c = 0 above, and the way of its rebound opens it.

#include "engine/contacts/contact.h"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr double opened_share = 0.02;
constexpr double slow_impact = 2.0;  // of what gravity does in a substep
/// Share of a row's own yield by which solvers of all rows soften it: between the corners of a box,
/// which four rows hold where three would do, it shares the load. It lets contacts sink by this
/// share of what the load would move the body by in a substep if nothing held it.
constexpr double softened_share = 1e-9;
/// It is made larger where that would be less than `least_sink` of the scene's size, a thousand
/// times what rounding leaves of a gap: below it rounding would share the load, another way in each
/// round, and friction at corners that carry little would follow it about without an end.
constexpr double least_sink = 1e-11;
constexpr double most_softened = 1e-6;
/// The same for friction, which is hyperstatic far more often: a taut rope over a wheel sticks at
/// many points to what moves as one. With less, rounding decides which of them slip, and the search
/// for them goes on and on (373 changes per substep for a rope of 100 segments, 61 with this, 10
/// with a hundred times as much); with more, a box on a slope creeps by more than 1e-9 m/s.
constexpr double softened_friction = 1e-7;
/// A point whose friction is all that it may be slides only if it moves: beside points that hold it
/// does not, but for their softness, by which it may move so many times as far as by its own. That
/// is 1e-5 of the way that its friction takes in a substep from what slides.
constexpr double let_go = 100.0;

/// Rotation of a body since the start of the substep [rad]; a mounted rotor has its own about its
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

/// w of the row along the first tangent [1/kg].
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
  const double slowest = slow_impact * std::abs(acceleration) * h;
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

/// `yield` [1/kg] is that of the row along the normal.
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
    // Up to this speed friction may bring the point to rest within the substep.
    choose_tangents(sliding.norm() > 0.0 ? sliding : free_acceleration, contact);
    const double pressing =
        std::max(pressure * tangent_yield(substep, contact), free_acceleration.norm());
    const double stoppable = h * material.friction * pressing;
    const bool slow = sliding.norm() <= stoppable;
    if (is_new) contact.stuck = slow;
    contact.rows = slow && !contact.plane_axis ? 3 : 2;
    // A velocity much below that is mostly rounding.
    if (contact.stuck || sliding.norm() <= 0.01 * stoppable) {
      choose_tangents(held.squaredNorm() > 0.0 ? Vector3(-held) : free_acceleration, contact);
    }
    contact.friction = contact.stuck ? material.static_friction : material.friction;
    contact.sliding_friction = material.friction;
  }
  contact.target = 0.0;
  if (material.compliance == 0.0) {
    if (contact.start_gap < 0.0) contact.target = (1.0 - opened_share) * contact.start_gap;
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
    double share = softened_friction;
    if (i == 0) {
      const double pushed = std::max(pressure * response.inverse_mass, free_acceleration.norm());
      share = std::clamp(least_sink * substep.bodies.scale() / (h * (std::abs(rate) + h * pushed)),
                         softened_share, most_softened);
    }
    contact.softness[at(i)] = share * response.inverse_mass;
    if (i > 0) continue;
    // A compliance shares the load by itself; softness beside it would be off its law.
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
