#include "cable/links/spool.h"

#include "cable/link_geometry.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> SpoolLink::field_table() {
  static const std::array table = joined(
      wheel_fields<SpoolLink>(),
      std::array{
          field<&SpoolLink::stored_length>("stored_length", "m", at_least(0.0), required,
                                           "cable wound on the drum at time 0"),
          field<&SpoolLink::layer_pitch>("layer_pitch", "m", at_least(0.0), optional,
                                         "growth of the drum's radius with every turn on it"),
      });
  return table;
}

Result<LinkGeometry> SpoolLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place(bodies, path);
  if (!link) return link;
  if (link->outline && layer_pitch > 0.0) {
    return Error{path + "/layer_pitch", "only a round drum can be wound in layers"};
  }
  if (!link->outline) link->hold_end();  // the end is fixed to the drum
  link->ends_here = true;
  link->given_stored_length = stored_length;
  link->layer_pitch = layer_pitch;
  return link;
}

}  // namespace sheave
