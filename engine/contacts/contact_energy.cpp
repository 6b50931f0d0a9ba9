#include "engine/contacts/contact_energy.h"

#include <algorithm>
#include <optional>

#include "engine/contacts/contact_state.h"
#include "engine/contacts/crowd.h"
#include "engine/contacts/planar_contact.h"

namespace sheave {
namespace {

/// The force of a compliant contact is a mean and includes the damper, so the energy follows from
/// the depth.
double energy_at(double gap, double compliance) {
  const double depth = std::max(-gap, 0.0);
  return compliance > 0.0 ? 0.5 * depth * depth / compliance : 0.0;
}

}  // namespace

double energy_of_records(const ContactFinder& finder, const FeatureState& own) {
  double energy = 0.0;
  for (std::size_t i = 0; i < contact_count(own); ++i) {
    const ContactRecord record = read_contact(own, i);
    energy += energy_at(record.gap, finder.material(record.forms).compliance);
  }
  return energy;
}

double energy_of_overlaps(const ContactFinder& finder, const BodySet& bodies, const State& state,
                          double h) {
  if (!finder.is_compliant()) return 0.0;
  ContactFinder own = finder;
  const Substep start(bodies, state, h, 1);
  Crowd crowd;
  crowd.begin(bodies.count());
  double energy = 0.0;
  own.find(start, [&](const FormPair& pair, Manifold& manifold) {
    const int body_a = own.forms()[at(pair.a)].body;
    const int body_b = own.forms()[at(pair.b)].body;
    crowd.add(start, body_a, body_b);
    const std::optional<Vector3> plane = plane_of_motion(bodies, body_a, body_b);
    if (plane) merge_behind(*plane, own.smaller_spread(pair), manifold);
    for (const ContactPoint& point : manifold.points) {
      energy += energy_at(point.gap, own.material(pair).compliance);
    }
    return !crowd.too_many();
  });
  return crowd.too_many() ? 0.0 : energy;
}

}  // namespace sheave
