#pragma once
// Common part of the links that run along a body: the section of the body with the cable's plane,
// and the winding.

#include <optional>

#include "cable/link.h"

namespace sheave {

/// A link on a wheel or along an outline. Derived link types define how the cable moves there.
class WheelLink : public LinkDef {
 public:
  /// At the end of a cable: as if the cable continued beyond it. Exactly one of `winding` and `side`
  /// is needed; left is counter-clockwise.
  std::optional<Winding> winding;
  std::optional<Side> side;
  /// Centre [m], body frame; default: the centre of the body's first wheel-like shape, or of its
  /// first shape.
  std::optional<Vector3> center;
  /// Normal of the cable's plane, body frame, any length except 0; default: the z axis of that
  /// shape.
  std::optional<Vector3> normal;
  /// Radius [m], > 0; default: the radius of that shape. Without a wheel-like shape the link is an
  /// outline.
  std::optional<double> radius;

 protected:
  /// A circle if a radius is given or the body has a wheel-like shape whose section is a circle;
  /// otherwise the hull of the section of all its shapes. Body and carrier are the body itself,
  /// also if it is a mounted rotor. Errors have the prefix `path`.
  [[nodiscard]] Result<LinkGeometry> place(const BodySet& bodies, const std::string& path) const;
};

/// The first rows of the field table of `Link`, which derives from WheelLink.
template <class Link>
[[nodiscard]] constexpr std::array<Field, 5> wheel_fields() {
  return {
      choice_field<&WheelLink::winding, Link>("winding", winding_names, optional,
                                              "which way the cable runs round the wheel, seen "
                                              "against the plane's normal; or give side"),
      choice_field<&WheelLink::side, Link>(
          "side", side_names, optional,
          "instead of winding: the side of the cable's way on which the wheel lies, seen against "
          "the normal (left: counter-clockwise), or the side on which the cable is shortest"),
      field<&WheelLink::center, Link>("center", "m", any_number(), optional,
                                      "centre of the wheel, body frame; default: the centre of the "
                                      "body's first wheel-like shape, or of its first shape"),
      field<&WheelLink::normal, Link>("normal", "", any_number(), optional,
                                      "normal of the cable's plane, body frame; default: that "
                                      "shape's z axis"),
      field<&WheelLink::radius, Link>(
          "radius", "m", above(0.0), optional,
          "of a circular wheel; default: that shape's radius, or without a wheel-like shape "
          "the hull of the section of all the body's shapes with the plane"),
  };
}

/// If the wheel's centre lies on the axle of a rotor, fixes centre and plane to the carrier of the
/// axle, another body or the world. The step then need not follow the rotor's own angle.
void carry_by_axle(const BodySet& bodies, LinkGeometry& link);

}  // namespace sheave
