#include "cable/links/pinhole.h"

#include "cable/link_geometry.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> PinholeLink::field_table() {
  static const std::array table{
      field<&PinholeLink::point>("point", "m", any_number(), optional,
                                 "where the hole is, body frame (default its origin)"),
      field<&PinholeLink::friction>("friction", "", at_least(0.0), optional,
                                    "capstan coefficient: the tensions on both sides differ by at "
                                    "most e^(friction x angle of deflection)"),
      choice_field<&PinholeLink::passes>(
          "passes", passage_names, optional,
          "directions in which cable slides through: forward is from the cable's first link to its "
          "last; with one direction the hole is a ratchet, which holds any tension in the other"),
  };
  return table;
}

Result<LinkGeometry> PinholeLink::compile(const BodySet& bodies,
                                          const std::string& /*path*/) const {
  Result<LinkGeometry> made{LinkGeometry{}};
  LinkGeometry& link = *made;
  link.body = link.carrier = bodies.index(body);
  link.mounted = bodies[link.body].mount >= 0;
  link.center = point - bodies[link.body].center_of_mass;
  link.given_stored_length = 0.0;
  link.slides = true;
  link.friction = friction;
  link.blocked = blocked_way(passes);
  return made;
}

}  // namespace sheave
