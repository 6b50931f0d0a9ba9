#include "cable/links/rolling.h"

#include "cable/links/wheel.h"

namespace sheave {

std::span<const Field> RollingLink::field_table() {
  static const std::array table{
      choice_field<&RollingLink::winding>(
          "winding", winding_names, required,
          "which way the cable runs round the wheel, seen against the plane's normal"),
      field<&RollingLink::center>("center", "m", any_number(), optional,
                                  "centre of the wheel, body frame; default: the centre of the "
                                  "body's first wheel-like shape, or of its first shape"),
      field<&RollingLink::normal>("normal", "", any_number(), optional,
                                  "normal of the cable's plane, body frame; default: that shape's "
                                  "z axis"),
      field<&RollingLink::radius>(
          "radius", "m", above(0.0), optional,
          "of a circular wheel; default: that shape's radius, or without a wheel-like shape "
          "the hull of the section of all the body's shapes with the plane"),
      field<&RollingLink::stored_length>(
          "stored_length", "m", at_least(0.0), optional,
          "cable wound on the wheel at time 0; required at the end of an open cable, elsewhere it "
          "follows from the tangents"),
      field<&RollingLink::friction>("friction", "", at_least(0.0), optional,
                                    "capstan coefficient: the cable slips when the ratio of the "
                                    "tensions passes e^(friction x wrap angle); default: no slip"),
      field<&RollingLink::lifted>("lifted", "", {}, optional,
                                  "whether the cable passes the wheel by at time 0; it is wound on "
                                  "when it comes to touch it"),
      field<&RollingLink::turns>("turns", "", between(0, 1000), optional,
                                 "whole turns in addition to the arc between the tangents"),
  };
  return table;
}

Result<LinkGeometry> RollingLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place_wheel({body, winding, center, normal, radius}, bodies, path);
  if (!link) return link;
  carry_by_axle(bodies, *link);
  link->given_stored_length = stored_length.value_or(std::numeric_limits<double>::quiet_NaN());
  link->extra_turns = turns;
  link->starts_lifted = lifted;
  link->friction = friction.value_or(std::numeric_limits<double>::quiet_NaN());
  return link;
}

}  // namespace sheave
