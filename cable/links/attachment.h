#pragma once

#include <optional>

#include "cable/link.h"

namespace sheave {

/// A cable end, or a point between its ends, fixed to a point of a body.
class AttachmentLink final : public LinkDef {
 public:
  Vector3 point = Vector3::Zero();  ///< [m], body frame
  /// Speed at which cable comes out of the point (< 0: goes into it) [m/s]; only at an end of an
  /// open cable. The feed stops when the span has no rest length left to take in. A control can
  /// change the speed only if the link is defined with one; 0 counts.
  std::optional<double> feed_speed;

  static constexpr std::string_view type_name = "attachment";
  static constexpr std::string_view type_meaning = "the cable is fixed to a point of a body";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
