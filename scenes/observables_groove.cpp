#include "scenes/observables_groove.h"

#include "cable/links/spool.h"
#include "engine/index.h"

namespace sheave {

std::vector<int> grooved_links(const CableReport& cable) {
  std::vector<int> drums;
  for (int i = 0; i < static_cast<int>(cable.links.size()); ++i) {
    if (cable.links[at(i)].groove) drums.push_back(i);
  }
  return drums;
}

std::vector<int> grooved_links(const CableDef& cable) {
  std::vector<int> drums;
  for (int i = 0; i < static_cast<int>(cable.links.size()); ++i) {
    const auto* drum = dynamic_cast<const SpoolLink*>(cable.links[at(i)].get());
    if (drum != nullptr && drum->has_groove()) drums.push_back(i);
  }
  return drums;
}

double groove_quantity(const LinkReport& link, int quantity) {
  if (quantity == 2) return link.groove->layer;
  return quantity == 0 ? link.groove->axial_position : link.groove->fleet_angle;
}

}  // namespace sheave
