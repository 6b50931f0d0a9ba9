#include "cable/links/attachment.h"

#include "cable/link_geometry.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> AttachmentLink::field_table() {
  static const std::array table{
      field<&AttachmentLink::point>("point", "m", any_number(), optional,
                                    "where the cable is fixed, body frame (default its origin)"),
      field<&AttachmentLink::feed_speed>("feed_speed", "m/s", any_number(), optional,
                                         "cable that comes out of the point (negative: goes in); "
                                         "at an end of the cable; 0: at a speed that is set later"),
  };
  return table;
}

Result<LinkGeometry> AttachmentLink::compile(const BodySet& bodies,
                                             const std::string& /*path*/) const {
  LinkGeometry link;
  link.body = link.carrier = bodies.index(body);
  link.mounted = bodies[link.body].mount >= 0;
  link.center = point - bodies[link.body].center_of_mass;
  link.given_stored_length = 0.0;
  link.feeds = feed_speed.has_value();
  link.feed_speed = link.feed_end_speed = feed_speed.value_or(0.0);
  return link;
}

}  // namespace sheave
