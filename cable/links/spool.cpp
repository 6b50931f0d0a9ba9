#include "cable/links/spool.h"

#include "cable/links/wheel.h"

namespace sheave {

std::span<const Field> SpoolLink::field_table() {
  static const std::array table{
      choice_field<&SpoolLink::winding>(
          "winding", winding_names, required,
          "which way the cable runs round it, seen against the plane's normal"),
      field<&SpoolLink::center>(
          "center", "m", any_number(), optional,
          "centre, body frame; default: that of the body's first wheel-like shape"),
      field<&SpoolLink::normal>(
          "normal", "", any_number(), optional,
          "normal of the cable's plane, body frame; default: that shape's z axis"),
      field<&SpoolLink::radius>("radius", "m", above(0.0), optional,
                                "default: that shape's radius"),
      field<&SpoolLink::stored_length>("stored_length", "m", at_least(0.0), required,
                                       "cable wound on the drum at time 0"),
      field<&SpoolLink::layer_pitch>("layer_pitch", "m", at_least(0.0), optional,
                                     "growth of the drum's radius with every turn on it"),
  };
  return table;
}

Result<LinkGeometry> SpoolLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place_wheel({body, winding, center, normal, radius}, bodies, path);
  if (!link) return link;
  if (link->outline && layer_pitch > 0.0) {
    return Error{path + "/layer_pitch", "only a round drum can be wound in layers"};
  }
  link->hybrid = !link->outline;  // the end is fixed to the drum
  link->ends_here = true;
  link->given_stored_length = stored_length;
  link->layer_pitch = layer_pitch;
  return link;
}

}  // namespace sheave
