#include "cable/links/hybrid.h"

#include "cable/link_geometry.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> HybridLink::field_table() {
  static const std::array table =
      joined(wheel_fields<HybridLink>(),
             std::array{
                 field<&HybridLink::stored_length>("stored_length", "m", at_least(0.0), required,
                                                   "cable wound on the wheel at time 0"),
             });
  return table;
}

Result<LinkGeometry> HybridLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place(bodies, path);
  if (!link) return link;
  if (link->outline) {
    return Error{path + "/body", "a hybrid link needs a circular wheel; give it a \"radius\""};
  }
  link->ends_here = true;
  link->hold_end();
  link->given_stored_length = stored_length;
  return link;
}

}  // namespace sheave
