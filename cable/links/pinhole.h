#pragma once

#include "cable/link.h"

namespace sheave {

/// The cable slides through a point fixed to a body: an eyelet, a tendon's sheath, a small ring.
class PinholeLink final : public LinkDef {
 public:
  Vector3 point = Vector3::Zero();  ///< [m], body frame
  /// Capstan coefficient, >= 0: the tensions on both sides differ by at most the factor e^(friction
  /// x angle), where the angle is that between the directions of the two spans.
  double friction = 0.0;
  /// Directions in which cable slides through. A hole with one direction holds any tension in the
  /// other one: a ratchet.
  Passage passes = Passage::both;

  static constexpr std::string_view type_name = "pinhole";
  static constexpr std::string_view type_meaning =
      "the cable slides through a point of a body, freely or with friction";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
