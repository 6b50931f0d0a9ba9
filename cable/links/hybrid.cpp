#include "cable/links/hybrid.h"

#include "cable/links/wheel.h"

namespace sheave {

std::span<const Field> HybridLink::field_table() {
  static const std::array table{
      choice_field<&HybridLink::winding>(
          "winding", winding_names, required,
          "which way the cable runs round it, seen against the plane's normal"),
      field<&HybridLink::center>(
          "center", "m", any_number(), optional,
          "centre, body frame; default: that of the body's first wheel-like shape"),
      field<&HybridLink::normal>(
          "normal", "", any_number(), optional,
          "normal of the cable's plane, body frame; default: that shape's z axis"),
      field<&HybridLink::radius>("radius", "m", above(0.0), optional,
                                 "default: that shape's radius"),
      field<&HybridLink::stored_length>("stored_length", "m", at_least(0.0), required,
                                        "cable wound on the wheel at time 0"),
  };
  return table;
}

Result<LinkGeometry> HybridLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place_wheel({body, winding, center, normal, radius}, bodies, path);
  if (!link) return link;
  if (link->outline) {
    return Error{path + "/body", "a hybrid link needs a circular wheel; give it a \"radius\""};
  }
  link->ends_here = true;
  link->hybrid = true;
  link->given_stored_length = stored_length;
  return link;
}

}  // namespace sheave
