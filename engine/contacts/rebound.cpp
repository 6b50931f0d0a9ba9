#include "engine/contacts/rebound.h"

#include <algorithm>

#include "engine/stages.h"

namespace sheave {
namespace {

constexpr int most_sweeps = 100;

double velocity_along(const Substep& substep, const Row& row) {
  double velocity = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    const BodyState& body = substep.next.bodies[at(term.body)];
    velocity += dot(term.linear, body.velocity) + dot(term.angular, body.angular_velocity);
  }
  return velocity;
}

void push(Substep& substep, const Row& row, const RowResponse& response, double impulse) {
  for (std::size_t t = 0; t < at(row.term_count); ++t) {
    const MovingBody& moving = substep.moving[at(row.terms[t].body)];
    BodyState& body = substep.next.bodies[at(row.terms[t].body)];
    if (moving.translates) body.velocity += impulse * response.linear[t];
    if (moving.rotates) body.angular_velocity += impulse * response.angular[t];
  }
}

}  // namespace

void Rebound::run(Substep& substep, std::span<const Contact> contacts,
                  std::span<double> multipliers) {
  if (substep.load_share != 1.0) return;  // `rattle` solves for velocities itself
  if (std::none_of(contacts.begin(), contacts.end(),
                   [](const Contact& contact) { return contact.rebound > 0.0; })) {
    return;
  }
  impacts_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!(multipliers[3 * i] > 0.0)) continue;
    Impact& impact = impacts_.emplace_back();
    impact.contact = i;
    impact.rows.resize(at(contacts[i].rows));
    impact.responses.resize(impact.rows.size());
    for (std::size_t k = 0; k < impact.rows.size(); ++k) {
      contacts[i].evaluate(substep, static_cast<int>(k), impact.rows[k]);
      respond(impact.rows[k], substep.moving, impact.responses[k]);
    }
    impact.wanted = contacts[i].rebound > 0.0
                        ? contacts[i].rebound_stored
                        : std::min(0.0, velocity_along(substep, impact.rows[0]));
  }
  const double h = substep.h;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest = 0.0;
    double change = 0.0;
    for (const Impact& impact : impacts_) {
      double* of_contact = &multipliers[3 * impact.contact];
      for (std::size_t k = 0; k < impact.rows.size(); ++k) {
        const double w = impact.responses[k].inverse_mass;
        if (!(w > 0.0)) continue;
        const double wanted = k == 0 ? impact.wanted : 0.0;
        double next = of_contact[k] + h * (wanted - velocity_along(substep, impact.rows[k])) / w;
        const double limit = contacts[impact.contact].friction * of_contact[0];
        next = k == 0 ? std::max(next, 0.0) : std::clamp(next, -limit, limit);
        const double impulse = (next - of_contact[k]) / h;
        of_contact[k] = next;
        push(substep, impact.rows[k], impact.responses[k], impulse);
        change = std::max(change, std::abs(impulse) * w);
        largest = std::max(largest, std::abs(wanted));
      }
    }
    if (change <= 1e-12 * largest) break;
  }
  follow_carriers(substep);
}

}  // namespace sheave
