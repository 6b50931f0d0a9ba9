// Drums with a groove at time 0: the cables and links that they can have.

#include "cable/cable_compiler.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Why a link cannot be beside a drum with a groove; empty if it can. The place of the rope on these
/// bodies would have to follow the groove within the substep.
std::string_view beside_groove_fault(const LinkGeometry& link) {
  if (link.outline) return "has an outline with corners, give it a \"radius\"";
  if (link.geodesic) return "is a smooth body, use a \"rolling\" link";
  if (link.opening) return "is an opening, use a \"pinhole\"";
  return {};
}

}  // namespace

void CableCompiler::check_grooves(const CableDef& def) {
  const std::size_t count = links_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!links_[i].groove) continue;
    const std::string field = "/links/" + std::to_string(i);
    const std::string drum = link_name(static_cast<int>(i)) + ", a drum with a groove";
    // A drum is an end of the cable.
    int other = static_cast<int>(i);
    do {
      other += i == 0 ? 1 : -1;
    } while (at(other) > 0 && at(other) + 1 < count && links_[at(other)].starts_lifted);
    const std::string_view fault = beside_groove_fault(links_[at(other)]);
    if (!fault.empty()) {
      fail(field,
           drum + ", cannot be next to " + link_name(other) + ", which " + std::string(fault));
    }
    if (has_sheath()) {
      fail(field, drum +
                      ": a cable in a sheath is wound in one plane; leave lead and "
                      "turns_per_layer out");
    }
    if (def.tangent_update == TangentUpdate::substep) {
      fail("/tangent_update",
           "the rope of " + drum + ", follows the bodies; leave tangent_update out");
    }
    if (def.most_wraps > 0 && any_wrappable()) {
      fail("/most_wraps", "the cable of " + drum +
                              ", does not come to touch wrappable bodies; set most_wraps to 0");
    }
  }
}

}  // namespace sheave
