// Newton's law of restitution, v+ = -e v-, where v- is the normal velocity at the end of the
// substep that points of contact would have without any contact. If the law holds at all points
// with impulses m >= 0, the energy changes by
//   m . (v+ + v-) / 2 = (1 - e) m . v- / 2 <= 0,
// so no rebound creates energy, for any number of simultaneous impacts. (With the approach velocity
// at the start this would not hold, because bodies turn in a substep.)
//
// v- is reached at the depth c < 0 below the surface, under the acceleration a. The impact had
// v_i^2 = v-^2 - 2 a c and was the time 2 c / (v- + v_i) ago. Since then a has changed the rebound
// e v_i. `xpbd` stores the mean velocity of the substep, which is less by a h / 2.
//
// `rattle` leaves substeps with an impact to `xpbd`: multipliers along the gradients of the start
// would act on a turning body at points where it no longer is. Sweeps find the impulses, bring
// rebounding points to their velocity, keep pressed points from approaching, and include friction.
// Their sum with the positions' impulses l / h never pulls.
//
// These formulas have the acceleration by loads alone. Where rows of other features touch a body
// (a rope, a joint), its acceleration is another one, and changes with the impact: a rope goes slack.
// The world then ends a part of the substep of `rattle` at the impact (land()), so that no
// acceleration is needed: the velocities of the instant obey v+ = -e v-, all impulses of contacts
// and ropes are those of the instant, >= 0, and the theorem holds as above.
//
// Rigid joints and taut cables pass the impulse on at once (engine/contacts/held_rows.h): their rows
// have the velocity 0 in v- and in v+, so that their impulses do no work and the theorem holds.

#include "engine/contacts/rebound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/portable.h"
#include "engine/solvers/direct.h"
#include "engine/stages.h"

namespace sheave {
namespace {

constexpr int most_sweeps = 100;
/// Chains of joints pass an impulse on by one joint per sweep.
constexpr int most_sweeps_of_joints = 2000;
constexpr double settled = 1e-12;  // of the largest velocity
/// Speed of separation below which a point rests on another one, as a share of that of the impact.
constexpr double at_rest = 1e-9;

/// The velocity at the end of a substep minus its mean velocity.
double lag(const Substep& substep, const Contact& contact) {
  return contact.mean_velocities ? 0.5 * substep.h * contact.acceleration : 0.0;
}

/// The normal velocity at the end of the substep after an impact, from the velocity without it.
double rebound_from(const Substep& substep, const Contact& contact, double free_velocity) {
  const double a = contact.acceleration;
  const double h = substep.h;
  const double shift = lag(substep, contact);
  const double mean = free_velocity + shift - 0.5 * h * a;
  const double depth = -(std::max(contact.start_gap, 0.0) + h * mean);
  const double closing = -(free_velocity + shift);
  const double square = closing * closing + 2.0 * a * std::max(depth, 0.0);
  if (!(closing > 0.0) || !(square > 0.0)) return 0.0;
  const double impact = std::sqrt(square);
  const double since = std::clamp(2.0 * depth / (closing + impact), 0.0, h);
  return std::max(0.0, contact.restitution * impact + a * since);
}

}  // namespace

void Rebound::run(Substep& substep, std::span<Contact> contacts, std::span<double> multipliers,
                  std::span<const std::unique_ptr<ConstraintBatch>> features,
                  const ConstraintBatch& own) {
  if (std::none_of(contacts.begin(), contacts.end(),
                   [](const Contact& contact) { return contact.rebound > 0.0; })) {
    return;
  }
  substep.update_inertias();
  held_.collect(substep, features, own, false);
  collect(substep, contacts, multipliers);
  find_rebounds(substep, contacts, multipliers);
  sweep(substep, contacts, multipliers);
  held_.keep(features);
}

void Rebound::hold(Substep& substep) {
  double fastest = 0.0;
  for (int sweep = 0; sweep < most_sweeps_of_joints && !held_.empty(); ++sweep) {
    const double change = held_.sweep(substep);
    fastest = std::max(fastest, change);
    if (change <= settled * fastest) break;
  }
}

void Rebound::collect(const Substep& substep, std::span<const Contact> contacts,
                      std::span<const double> multipliers) {
  impacts_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    // Compliant contacts act by their springs throughout the substep, also during impacts.
    if (!(multipliers[3 * i] > 0.0) || contacts[i].compliance > 0.0) continue;
    add(substep, contacts, i);
  }
}

void Rebound::add(const Substep& substep, std::span<const Contact> contacts, std::size_t contact) {
  Impact& impact = impacts_.emplace_back();
  impact.contact = contact;
  impact.rows.resize(at(contacts[contact].rows));
  impact.responses.resize(impact.rows.size());
  for (std::size_t k = 0; k < impact.rows.size(); ++k) {
    contacts[contact].evaluate(substep, static_cast<int>(k), impact.rows[k]);
    respond(impact.rows[k], substep.moving, impact.responses[k]);
  }
}

void Rebound::keep_passing(Substep& substep, std::span<Contact> contacts,
                           std::span<const std::unique_ptr<ConstraintBatch>> features,
                           const ConstraintBatch& own) {
  const std::span<const char> held = held_.bodies(substep, features, own);
  const auto is_held = [&](int body) {
    const int mount = substep.bodies[body].mount;
    return held[at(body)] != 0 || (mount >= 0 && held[at(mount)] != 0);
  };
  for (Contact& contact : contacts) {
    contact.passes = contact.passes && (is_held(contact.body_a) || is_held(contact.body_b));
    if (contact.passes) contact.rebound = 0.0;
  }
}

void Rebound::land(Substep& substep, std::span<const Contact> contacts,
                   std::span<double> multipliers, double slow,
                   std::span<const std::unique_ptr<ConstraintBatch>> features, std::size_t place) {
  substep.update_inertias();
  held_.collect(substep, features, *features[place], true);
  impacts_.clear();
  double fastest = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (!contact.lands) continue;
    add(substep, contacts, i);
    Impact& impact = impacts_.back();
    const double velocity = velocity_along(substep, impact.rows[0]);
    const bool rebounds = -velocity > slow * std::abs(contact.acceleration);
    impact.wanted = rebounds ? -contact.restitution * velocity : 0.0;
    fastest = std::max(fastest, std::abs(velocity));
  }
  const double touching = DirectSolver::closed * substep.bodies.scale();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (contact.passes || contact.compliance > 0.0) continue;
    if (!(multipliers[3 * i] > 0.0) && contact.gap(substep) > touching) continue;
    add(substep, contacts, i);
    // A point that separates at v- > 0 takes no part: to stop it at 0 would do the work m v- / 2. If
    // the impact turns it round, that is the next impact.
    const double velocity = velocity_along(substep, impacts_.back().rows[0]);
    if (velocity > at_rest * fastest) impacts_.pop_back();
  }
  impulses_.assign(multipliers.size(), 0.0);
  sweep(substep, contacts, impulses_);
  std::vector<double>& late = substep.late_forces[place];
  for (std::size_t i = 0; i < multipliers.size(); ++i) {
    multipliers[i] += impulses_[i];
    late[i] += impulses_[i] / (substep.h * substep.h);
  }
  held_.keep(features);
  held_.keep_late(substep);
}

void Rebound::find_rebounds(Substep& substep, std::span<Contact> contacts,
                            std::span<const double> multipliers) {
  kept_ = substep.next.bodies;
  for (const Impact& impact : impacts_) {
    for (std::size_t k = 0; k < impact.rows.size(); ++k) {
      const double impulse = multipliers[3 * impact.contact + k] / substep.h;
      push(substep, impact.rows[k], impact.responses[k], -impulse);
    }
  }
  hold(substep);
  held_.restore();
  follow_carriers(substep);
  for (const Impact& impact : impacts_) {
    Contact& contact = contacts[impact.contact];
    if (!(contact.rebound > 0.0)) continue;
    contact.rebound = rebound_from(substep, contact, velocity_along(substep, impact.rows[0]));
  }
  substep.next.bodies = kept_;
  for (Impact& impact : impacts_) {
    const Contact& contact = contacts[impact.contact];
    impact.wanted = contact.rebound > 0.0 ? std::max(0.0, contact.rebound - lag(substep, contact))
                                          : std::min(0.0, velocity_along(substep, impact.rows[0]));
  }
}

double Rebound::rub(Substep& substep, const Impact& impact, double limit, double* multipliers) {
  // The impulse that would stop the slip, along one or both tangents, limited in its norm.
  double w = 0.0;
  for (std::size_t k = 1; k < impact.rows.size(); ++k) {
    w = std::max(w, impact.responses[k].inverse_mass);
  }
  if (!(w > 0.0)) return 0.0;
  std::array<double, 2> wanted{};
  for (std::size_t k = 1; k < impact.rows.size(); ++k) {
    wanted[k - 1] = multipliers[k - 1] - substep.h * velocity_along(substep, impact.rows[k]) / w;
  }
  const double size = portable::hypot(wanted[0], wanted[1]);
  const double share = size > limit ? limit / size : 1.0;
  double change = 0.0;
  for (std::size_t k = 1; k < impact.rows.size(); ++k) {
    const double impulse = (share * wanted[k - 1] - multipliers[k - 1]) / substep.h;
    multipliers[k - 1] = share * wanted[k - 1];
    push(substep, impact.rows[k], impact.responses[k], impulse);
    change = std::max(change, std::abs(impulse) * w);
  }
  return change;
}

void Rebound::sweep(Substep& substep, std::span<const Contact> contacts,
                    std::span<double> multipliers) {
  const double h = substep.h;
  const int most = held_.empty() ? most_sweeps : most_sweeps_of_joints;
  double stopped = 0.0;  // largest change of the first sweep, beside rows of other features
  for (int sweep = 0; sweep < most; ++sweep) {
    double largest = stopped;
    double change = held_.sweep(substep);
    for (const Impact& impact : impacts_) {
      double* of_contact = &multipliers[3 * impact.contact];
      largest = std::max(largest, std::abs(impact.wanted));
      const double w = impact.responses[0].inverse_mass;
      if (w > 0.0) {
        const double off = impact.wanted - velocity_along(substep, impact.rows[0]);
        const double next = std::max(of_contact[0] + h * off / w, 0.0);
        const double impulse = (next - of_contact[0]) / h;
        of_contact[0] = next;
        push(substep, impact.rows[0], impact.responses[0], impulse);
        change = std::max(change, std::abs(impulse) * w);
      }
      const double limit = contacts[impact.contact].friction * of_contact[0];
      change = std::max(change, rub(substep, impact, limit, of_contact + 1));
    }
    if (change <= settled * largest) break;
    if (sweep == 0 && !held_.empty()) stopped = change;
  }
  follow_carriers(substep);
}

}  // namespace sheave
